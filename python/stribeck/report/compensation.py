"""Friction compensation: text and figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report.layout import joined, paragraph, table
from stribeck.report.names import numbered
from stribeck.report.numbers import DASH, listed, minus_signs
from stribeck.report.style import (
    COLOURS,
    GREY,
    MEASURED,
    legend_above,
    new_figure,
    strided,
    style,
    title,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stribeck.motion.compensate.factor import Factor
    from stribeck.motion.compensate.teaching import Teaching
    from stribeck.motion.compensate.tracking import Tracking


def tracking_text(tracking: Tracking) -> str:
    """The tracking error without compensation and with each."""
    _, unit = tracking.joint.units
    seconds = tracking.desired_position.size * tracking.step
    rows = [["compensation", "alpha", "from", f"RMSE [{unit}]", f"maximum [{unit}]", "change"]]
    names = numbered([motion.name for motion in tracking.motions])
    for name, motion in zip(names, tracking.motions, strict=True):
        compensator = motion.compensator
        alpha, source, change = DASH, DASH, DASH
        if compensator is not None:
            alpha = f"{compensator.factor:5.3f}"
            source = "measured" if compensator.feedback else "desired"
            change = minus_signs(f"{-100.0 * tracking.reduction(motion):+.0f} %")
        errors = [f"{motion.rmse:.3g}", f"{motion.largest_error:.3g}"]
        rows.append([name, alpha, source, *errors, change])
    observer = ""
    if tracking.observer is not None:
        observer = paragraph(
            f"With a disturbance observer of {tracking.observer:g} Hz for the remaining friction."
        )
    return joined(
        f"Tracking error of a joint with friction {tracking.friction.spec}, H-infinity PID, "
        f"{seconds:g} s:",
        table(rows, right=(1, 3, 4, 5)),
        observer,
    )


def teaching_text(teaching: Teaching) -> str:
    """The torque that the hand had to apply."""
    unit, _ = teaching.joint.units
    rows = [
        ["compensation", "alpha", f"hand, RMS [{unit}]", f"maximum [{unit}]", "overcompensated"]
    ]
    names = numbered([motion.name for motion in teaching.motions])
    for name, motion in zip(names, teaching.motions, strict=True):
        alpha = DASH if motion.compensator is None else f"{motion.compensator.factor:5.3f}"
        rms, largest = teaching.interaction(motion)
        share = 100.0 * teaching.overcompensated(motion)
        rows.append([name, alpha, f"{rms:.3g}", f"{largest:.3g}", f"{share:.2g} % of the motion"])
    return joined(
        f"A hand guides a joint with friction {teaching.friction.spec}:",
        table(rows, right=(1, 2, 3, 4)),
    )


def factor_text(factor: Factor) -> str:
    """The factor, and what prevents a larger one."""
    sides = ", ".join(f"{name} {low:g} to {high:g}" for name, (low, high) in factor.box.items())
    lines = [
        f"Largest compensation factor of {factor.compensator.spec} for {factor.friction.spec}: "
        f"{factor.value:.3f}, proved for {sides}."
    ]
    if factor.point is not None and factor.bound < 1.0:
        at = ", ".join(f"{name} {factor.point[name]:.4g}" for name in factor.box)
        lines.append(f"  A larger factor could exceed the friction at {at}.")
    if factor.exact:
        lines.append(f"  Assumed exact, since no standard error is known: {listed(factor.exact)}.")
    return "\n".join(lines)


def tracking_figure(tracking: Tracking) -> Figure:
    """The desired position, the tracking errors, and friction with its compensation, over time."""
    torque_unit, position_unit = tracking.joint.units
    rows = strided(tracking.desired_position.size)
    time = tracking.step * rows
    figure = new_figure(9.0, 7.0)
    top, middle, bottom = figure.subplots(3, 1, sharex=True, height_ratios=(1, 2, 2))
    top.plot(time, tracking.desired_position[rows], color=MEASURED, lw=1.3)
    # Wide and below: a compensation that equals the friction covers it.
    friction = tracking.motions[-1].friction_torque[rows]
    bottom.plot(time, friction, color=GREY, lw=3.0, label="friction")
    names = numbered([motion.name for motion in tracking.motions])
    for k, motion in enumerate(tracking.motions):
        colour = COLOURS[k % len(COLOURS)]
        middle.plot(time, motion.error[rows], color=colour, lw=1.1, label=names[k])
        if motion.compensator is not None:
            bottom.plot(time, motion.compensation[rows], color=colour, lw=1.1, label=names[k])
    title(top, f"Desired position [{position_unit}]")
    title(middle, f"Tracking error [{position_unit}]")
    title(bottom, f"Friction and compensation [{torque_unit}]")
    bottom.set_xlabel("time [s]")
    for axes in (top, middle, bottom):
        style(axes)
    for axes in (middle, bottom):
        legend_above(axes)
    return figure
