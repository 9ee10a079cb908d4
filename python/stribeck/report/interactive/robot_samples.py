"""The samples of all joints of a robot as one source, so that a selection marks every joint."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from bokeh.models import ColumnDataSource
from numpy.typing import NDArray

from stribeck.report.channels import clock, torque_name
from stribeck.report.interactive.base import Limits, shown_range
from stribeck.report.interactive.decimate import drawn_rows
from stribeck.report.numbers import unit_text

if TYPE_CHECKING:
    from stribeck.robot.result import RobotFit

Array = NDArray[np.float64]

#: Samples drawn: each has four numbers a joint.
MOST_OF_A_ROBOT = 6_000


@dataclass(frozen=True)
class JointLabels:
    """What the figures of one joint are called, with units."""

    name: str
    spec: str
    velocity: str
    friction: str
    residual: str


@dataclass(frozen=True)
class RobotSamples:
    """Friction of every joint, measured and modelled, that the figures of a robot share.

    Attributes
    ----------
    source : ColumnDataSource
        ``time`` and, of joint `k`, ``velocity_k``, ``friction_k``, ``modelled_k`` and
        ``residual_k``; NaN where the joint is not scored.
    limits : mapping of pairs
        Range of each column with which axes begin.
    """

    joints: tuple[JointLabels, ...]
    time_label: str
    source: ColumnDataSource
    limits: Mapping[str, Limits]


def robot_samples(found: RobotFit, most: int = MOST_OF_A_ROBOT) -> RobotSamples:
    """Friction of every joint: measured torque minus that of the rigid bodies, and the model.

    Parameters
    ----------
    most : int
        Largest number of samples that are drawn.
    """
    solved = found.solved
    motion = solved.balance.motion
    load = solved.balance.load(solved.values.base)
    columns: dict[str, Array] = {}
    labels: list[JointLabels] = []
    for k, joint in enumerate(found.joints):
        recording = motion.joints[k]
        scored = np.where(motion.scored[:, k], 0.0, np.nan)
        friction = recording.torque - load[:, k] + scored
        residual = solved.balance.residual(solved.values, k) + scored
        columns |= {
            f"velocity_{k}": recording.velocity + scored,
            f"friction_{k}": friction,
            f"modelled_{k}": friction - residual,
            f"residual_{k}": residual,
        }
        unit = unit_text(joint.model.torque_unit)
        labels.append(
            JointLabels(
                joint.joint,
                joint.model.spec,
                f"velocity [{unit_text(recording.columns['velocity'].unit)}]",
                f"friction {torque_name(joint.model.torque_unit)} [{unit}]",
                f"residual [{unit}]",
            )
        )
    made = clock(motion.joints[0])
    extremes = [columns[f"residual_{k}"] for k in range(len(labels))]
    rows = drawn_rows(extremes, 0, made.values.size, most)
    drawn: dict[str, NDArray[np.generic]] = {"time": made.values[rows]}
    drawn |= {name: values[rows].astype(np.float32) for name, values in columns.items()}
    limits = {name: shown_range([values]) for name, values in columns.items()}
    return RobotSamples(tuple(labels), made.label, ColumnDataSource(drawn), limits)
