"""A simulated motion, and its comparison with a measured one: text and figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report.channels import torque_name
from stribeck.report.numbers import listed, percent
from stribeck.report.style import (
    AFTER,
    BEFORE,
    MEASURED,
    legend_above,
    new_figure,
    strided,
    style,
    title,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stribeck.motion.simulate.result import Simulation
    from stribeck.motion.simulate.validation import Validation


def simulation_text(simulation: Simulation) -> str:
    """Position, speed, torque, error and energy of the motion."""
    torque, position = simulation.joint.units
    summary = simulation.to_dict()
    inertia = "kg m2" if position == "rad" else "kg"
    lines = [
        f"{summary['model']} on {simulation.joint.inertia:.4g} {inertia}: "
        f"{summary['seconds']:g} s in {summary['steps']} steps of {summary['step'] * 1e3:g} ms",
        f"  position        {summary['position']['min']:.4g} to "
        f"{summary['position']['max']:.4g} {position}, {summary['position']['end']:.4g} at the end",
        f"  maximum speed   {summary['largest_speed']:.4g} {position}/s, "
        f"at rest {100.0 * summary['share_at_rest']:.3g} % of the time",
        f"  motor torque    {summary['largest_torque']:.4g} {torque} at most",
    ]
    error = summary["tracking_error"]
    if error is not None:
        lines.append(
            f"  tracking error  {error['rms']:.4g} {position} RMS, {error['largest']:.4g} at most"
        )
    energy = simulation.energy
    lines.append(
        f"  energy          motor {energy['motor']:.4g} J, environment "
        f"{energy['environment']:.4g} J, dissipated by friction {energy['friction']:.4g} J "
        f"(balance: {energy['imbalance']:.1e} J)"
    )
    if simulation.left_out:
        lines.append(
            f"  left out        {listed(simulation.left_out)}: part of the measurement, not of "
            f"the motion"
        )
    return "\n".join(lines)


def validation_text(validation: Validation) -> str:
    """How far the simulated motion is from the measured one."""
    _, position = validation.joint.units
    how = "in closed loop" if validation.closed_loop else "driven by the measured torque only"
    summary = validation.to_dict()
    lines = [
        f"{summary['model']}, {how}, over {summary['rows']} samples:",
        f"  position error {summary['position_rmse']:.3g} {position} RMS "
        f"({percent(summary['position_relative_error'])} of the standard deviation of the "
        f"position), {summary['position_largest_error']:.3g} at most",
    ]
    if validation.closed_loop:
        lines.append(f"  torque error {percent(summary['torque_relative_error'])} of the torque")
    for growth in validation.growth:
        lines.append(
            f"  after {growth.seconds:>5g} s: error {growth.error:.3g} {position} for a "
            f"displacement of {growth.way:.3g} {position} (RMS of {growth.starts} starts)"
        )
    return "\n".join(lines)


def simulation_figure(simulation: Simulation) -> Figure:
    """Position, velocity, and motor and friction torque over time."""
    torque_unit, position_unit = simulation.joint.units
    rows = strided(simulation.torque.size)
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
    title(top, f"{simulation.model.spec}: position [{position_unit}]")
    title(middle, f"Velocity [{position_unit}/s]")
    title(bottom, f"{torque_name(torque_unit).capitalize()} [{torque_unit}]")
    bottom.set_xlabel("time [s]")
    for axes in (top, middle, bottom):
        style(axes)
    for axes in (top, bottom):
        legend_above(axes)
    return figure


def validation_figure(validation: Validation) -> Figure:
    """Measured and simulated position, their difference, and the torque or the error's growth."""
    torque_unit, position_unit = validation.joint.units
    rows = strided(validation.time.size)
    time = validation.time[rows]
    figure = new_figure(9.0, 7.0)
    top, middle, bottom = figure.subplots(3, 1)
    top.plot(time, validation.measured[rows], color=MEASURED, lw=2.2, label="measured")
    top.plot(time, validation.simulated[rows], color=BEFORE, lw=1.1, label="simulated")
    title(top, f"{validation.model.spec}: position [{position_unit}]")
    middle.plot(time, (validation.simulated - validation.measured)[rows], color=AFTER, lw=1.0)
    title(middle, f"Position error, simulated minus measured [{position_unit}]")
    top.sharex(middle)
    top.tick_params(labelbottom=False)
    middle.set_xlabel("time [s]")
    if validation.closed_loop:
        bottom.plot(time, validation.measured_torque[rows], color=MEASURED, lw=1.6)
        bottom.plot(time, validation.torque[rows], color=BEFORE, lw=0.8)
        title(bottom, f"Motor {torque_name(torque_unit)} [{torque_unit}]")
        bottom.set_xlabel("time [s]")
    else:
        seconds = [growth.seconds for growth in validation.growth]
        errors = [growth.error for growth in validation.growth]
        bottom.loglog(seconds, errors, "o-", color=AFTER)
        title(bottom, f"RMS position error against the time simulated [{position_unit}]")
        bottom.set_xlabel("time since the start [s]")
    for axes in (top, middle, bottom):
        style(axes)
    legend_above(top)
    return figure
