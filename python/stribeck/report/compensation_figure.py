"""The picture of a compensated joint."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from stribeck.report.figures import COLOURS, MEASURED, new_figure, style, title

if TYPE_CHECKING:
    from stribeck.motion.compensate.tracking import Tracking

#: Points drawn of each line.
MOST_POINTS = 4000


def tracking_figure(tracking: Tracking) -> Figure:
    """The desired position, the tracking errors, and friction with what cancels it, over time."""
    torque_unit, position_unit = tracking.joint.units
    count = tracking.desired_position.size
    rows = np.unique(np.linspace(0, count - 1, MOST_POINTS).astype(np.intp))
    time = tracking.step * rows
    figure = new_figure(9.0, 7.0)
    top, middle, bottom = figure.subplots(3, 1, sharex=True, height_ratios=(1, 2, 2))
    top.plot(time, tracking.desired_position[rows], color=MEASURED, lw=1.3)
    for k, motion in enumerate(tracking.motions):
        colour = COLOURS[k % len(COLOURS)]
        middle.plot(time, motion.error[rows], color=colour, lw=1.1, label=motion.name)
        if motion.compensator is not None:
            bottom.plot(time, motion.compensation[rows], color=colour, lw=1.1, label=motion.name)
    resisted = tracking.motions[-1].friction_torque[rows]
    bottom.plot(time, resisted, color=MEASURED, lw=0.8, label="friction")
    title(top, f"desired position ({position_unit})")
    title(middle, f"tracking error ({position_unit})")
    kind = "torque" if torque_unit == "N m" else "force"
    title(bottom, f"friction and compensation, {kind} ({torque_unit})")
    bottom.set_xlabel("time (s)")
    for axes in (top, middle, bottom):
        style(axes)
    for axes in (middle, bottom):
        axes.legend(loc="upper right", frameon=False, fontsize=9)
    return figure
