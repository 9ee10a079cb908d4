"""An acceleration that was not recorded, from the position or the velocity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.recording.acceleration_filter import AccelerationFilter
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.joint.channels import Channels, Layout
from stribeck.recording.mend.blurred_acceleration import followed_filter
from stribeck.recording.motion.any_friction import AnyFriction
from stribeck.recording.motion.derived_motion import acceleration_cutoff
from stribeck.recording.recording import Column
from stribeck.recording.rows import SIGMAS

__all__ = ["Derivable", "accelerated"]


@dataclass(frozen=True)
class Derivable:
    """What an acceleration is derived from, arrays [n].

    Attributes
    ----------
    source, derivative
        The position, 2, or the velocity, 1.
    velocity, smooth
        The velocity, and that behind a low-pass.
    cutoff
        Of the low-pass, Hz; None: there is none.
    noise
        Standard deviation of the noise of the velocity.
    """

    source: Floats
    derivative: int
    velocity: Floats
    smooth: Floats
    cutoff: float | None
    noise: float


def accelerated(
    data: Channels, layout: Layout, segment: Ints, typical: float, known: Derivable
) -> tuple[AccelerationFilter, Floats]:
    """The acceleration [n] and its filter, the one that the torque follows; noted.

    Parameters
    ----------
    typical
        Median step, s.
    """
    time = data.values["time"]

    def behind(chosen: AccelerationFilter) -> Floats:
        return chosen.derived(time, segment, known.source, known.derivative, known.smooth)

    usual = acceleration_cutoff(time, known.velocity, segment, typical, known.cutoff)
    speed = np.abs(known.velocity)
    friction = AnyFriction(
        known.velocity,
        float(speed.max()),
        layout.joint_kind == "revolute",
        *(data.values.get(name) for name in ("position", "temperature", "load_torque")),
    )
    chosen = followed_filter(
        data,
        segment,
        AccelerationFilter(usual),
        known.noise,
        behind,
        friction,
        speed > SIGMAS * known.noise,
    )
    acceleration = behind(chosen)
    origin, unit = ("", "velocity", "position")[known.derivative], f"{layout.position_unit}/s2"
    data.columns["acceleration"] = Column.of("acceleration", origin, unit, True, acceleration)
    data.notes.append(f"acceleration derived from {origin}, {chosen.text()}")
    return chosen, acceleration
