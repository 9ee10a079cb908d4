"""The figure of a robot: friction of every joint over its speed, measured and modelled."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from stribeck.report.numbers import unit_text
from stribeck.report.style import AFTER, MEASURED, dots, new_figure, style, thin, title

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stribeck.robot.result import RobotFit

#: Panels side by side.
COLUMNS = 3


def robot_figure(found: RobotFit) -> Figure:
    """Friction of every joint: measured torque minus that of the rigid bodies, and the model."""
    solved = found.solved
    balance, motion = solved.balance, solved.balance.motion
    load = balance.load(solved.values.base)
    rows = math.ceil(len(found.joints) / COLUMNS)
    figure = new_figure(11.0, 0.6 + 3.1 * rows)
    panels = figure.subplots(rows, COLUMNS, squeeze=False)
    for k, joint in enumerate(found.joints):
        axes, recording = panels.flat[k], motion.joints[k]
        style(axes)
        title(axes, f"joint {joint.joint}\n{joint.model.spec}")
        scored = thin(np.flatnonzero(motion.scored[:, k]))
        friction = recording.torque - load[:, k]
        modelled = friction - balance.residual(solved.values, k)
        speed = recording.velocity[scored]
        dots(axes, speed, friction[scored], MEASURED, "torque minus rigid bodies")
        dots(axes, speed, modelled[scored], AFTER, "friction of the model")
        axes.set_xlabel(f"velocity [{unit_text(recording.columns['velocity'].unit)}]")
        axes.set_ylabel(f"friction [{unit_text(joint.model.torque_unit)}]")
    for axes in panels.flat[len(found.joints) :]:
        axes.set_axis_off()
    legend = figure.legend(
        *panels.flat[0].get_legend_handles_labels(),
        loc="outside upper right",
        ncols=2,
        frameon=False,
        fontsize=9,
        markerscale=3.0,
    )
    for handle in legend.get_lines():
        handle.set_alpha(1.0)
    return figure
