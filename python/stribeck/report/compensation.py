"""Compensation in words and tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stribeck.motion.compensate.factor import Factor
    from stribeck.motion.compensate.teaching import Teaching
    from stribeck.motion.compensate.tracking import Tracking


def tracking_text(tracking: Tracking) -> str:
    """How far off the joint was, without compensation and with each."""
    _, unit = tracking.joint.units
    seconds = tracking.desired_position.size * tracking.step
    width = max(len("compensation"), *(len(motion.name) for motion in tracking.motions))
    lines = [
        f"A joint with the friction {tracking.friction.spec}, H-infinity PID, {seconds:g} s:",
        f"  {'compensation':<{width}}  alpha  from      RMSE ({unit})  largest ({unit})  RMSE by",
    ]
    for motion in tracking.motions:
        compensator = motion.compensator
        alpha, source, change = "-", "-", "-"
        if compensator is not None:
            alpha = f"{compensator.factor:5.3f}"
            source = "measured" if compensator.feedback else "desired"
            change = f"{-100.0 * tracking.reduction(motion):+.0f} %"
        lines.append(
            f"  {motion.name:<{width}}  {alpha:>5}  {source:<8}  "
            f"{motion.rmse:>{7 + len(unit)}.3g}  {motion.largest_error:>{10 + len(unit)}.3g}  "
            f"{change:>7}"
        )
    if tracking.observer is not None:
        lines.append(
            f"  with an observer of {tracking.observer:g} Hz for the friction that is left"
        )
    return "\n".join(lines)


def teaching_text(teaching: Teaching) -> str:
    """What the hand had to give."""
    unit, _ = teaching.joint.units
    width = max(len("compensation"), *(len(motion.name) for motion in teaching.motions))
    lines = [
        f"A hand guides a joint with the friction {teaching.friction.spec}:",
        f"  {'compensation':<{width}}  alpha  hand, RMS ({unit})  largest ({unit})  "
        f"exceeds friction",
    ]
    for motion in teaching.motions:
        alpha = "-" if motion.compensator is None else f"{motion.compensator.factor:5.3f}"
        rms, largest = teaching.interaction(motion)
        share = 100.0 * teaching.overcompensated(motion)
        lines.append(
            f"  {motion.name:<{width}}  {alpha:>5}  {rms:>{12 + len(unit)}.3g}  "
            f"{largest:>{10 + len(unit)}.3g}  {share:>7.2g} % of the time"
        )
    return "\n".join(lines)


def factor_text(factor: Factor) -> str:
    """The factor, and what stands in the way of a larger one."""
    sides = ", ".join(f"{name} {low:g} to {high:g}" for name, (low, high) in factor.box.items())
    lines = [
        f"Largest factor of {factor.compensator.spec} for {factor.friction.spec}: "
        f"{factor.value:.3f}, proved for {sides}."
    ]
    if factor.point is not None and factor.bound < 1.0:
        at = ", ".join(f"{name} {factor.point[name]:.4g}" for name in factor.box)
        lines.append(f"  More could exceed the friction at {at}.")
    if factor.exact:
        lines.append(f"  Taken as exact, as no error is known: {', '.join(factor.exact)}.")
    return "\n".join(lines)
