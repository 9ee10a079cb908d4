"""The picture of a simulated motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from stribeck.report.figures import AFTER, BEFORE, MEASURED, new_figure, style, title

if TYPE_CHECKING:
    from stribeck.motion.simulate.result import Simulation
    from stribeck.motion.simulate.validation import Validation

#: Points drawn of each line.
MOST_POINTS = 4000


def simulation_figure(simulation: Simulation) -> Figure:
    """Position, velocity, and the torques that act, over time."""
    torque_unit, position_unit = simulation.joint.units
    rows = np.unique(np.linspace(0, simulation.torque.size - 1, MOST_POINTS).astype(np.intp))
    time = simulation.time[rows]
    figure = new_figure(9.0, 7.0)
    top, middle, bottom = figure.subplots(3, 1, sharex=True)
    if simulation.tracking_error is not None:
        top.plot(time, simulation.desired_position[rows], color=MEASURED, lw=1.0, label="desired")
        middle.plot(time, simulation.desired_velocity[rows], color=MEASURED, lw=1.0)
    top.plot(time, simulation.position[rows], color=AFTER, lw=1.3, label="simulated")
    middle.plot(time, simulation.velocity[rows], color=AFTER, lw=1.3)
    bottom.plot(time, simulation.torque[rows], color=MEASURED, lw=1.0, label="motor")
    bottom.plot(time, simulation.friction_torque[rows], color=BEFORE, lw=1.3, label="friction")
    title(top, f"{simulation.model.spec}: position ({position_unit})")
    title(middle, f"velocity ({position_unit}/s)")
    title(bottom, f"{_torque(torque_unit)} ({torque_unit})")
    bottom.set_xlabel("time (s)")
    for axes in (top, middle, bottom):
        style(axes)
    for axes in (top, bottom):
        axes.legend(loc="upper right", frameon=False, fontsize=9)
    return figure


def validation_figure(validation: Validation) -> Figure:
    """Measured and simulated position, their difference, and the torque or the error's growth."""
    torque_unit, position_unit = validation.joint.units
    rows = np.unique(np.linspace(0, validation.time.size - 1, MOST_POINTS).astype(np.intp))
    time = validation.time[rows]
    figure = new_figure(9.0, 7.0)
    top, middle, bottom = figure.subplots(3, 1)
    top.plot(time, validation.measured[rows], color=MEASURED, lw=2.2, label="measured")
    top.plot(time, validation.simulated[rows], color=BEFORE, lw=1.1, label="simulated")
    title(top, f"{validation.model.spec}: position ({position_unit})")
    middle.plot(time, (validation.simulated - validation.measured)[rows], color=AFTER, lw=1.0)
    title(middle, f"simulated - measured ({position_unit})")
    if validation.closed_loop:
        bottom.plot(time, validation.measured_torque[rows], color=MEASURED, lw=1.6)
        bottom.plot(time, validation.torque[rows], color=BEFORE, lw=0.8)
        title(
            bottom, f"motor torque ({torque_unit})" if torque_unit == "N m" else "motor force (N)"
        )
        bottom.set_xlabel("time (s)")
    else:
        seconds = [growth.seconds for growth in validation.growth]
        errors = [growth.error for growth in validation.growth]
        bottom.loglog(seconds, errors, "o-", color=AFTER)
        title(bottom, f"RMS error ({position_unit}) so long after a start")
        bottom.set_xlabel("time since the start (s)")
    for axes in (top, middle, bottom):
        style(axes)
    top.legend(loc="upper right", frameon=False, fontsize=9)
    return figure


def _torque(unit: str) -> str:
    return "torque" if unit == "N m" else "force"
