"""Whether the acceleration is the derivative of the velocity."""

from __future__ import annotations

from stribeck.base.errors import option
from stribeck.recording.check import Check
from stribeck.recording.consistency.remedy import (
    PHASE,
    Pair,
    agreement,
    other_column,
    ratio_text,
    scale_remedy,
)
from stribeck.recording.consistency.view import View

__all__ = ["check_acceleration"]


def check_acceleration(view: View) -> Check | None:
    """Compare increments of the velocity with the integral of the acceleration.

    Returns
    -------
    Check or None
        None where the acceleration was not recorded.
    """
    found = view.acceleration
    if found is None:
        return None
    pair = Pair("acceleration", "velocity", found)
    leave_out = f"leave it out with {option('map', 'acceleration=none')}, which derives it"
    if not found.resolved or (not found.seen[0] and found.common < 0.5):
        return Check(
            "acceleration", True, "cannot check the acceleration: the velocity hardly changes"
        )
    column = view.column("acceleration")
    if not found.seen[1]:
        said = f"the velocity changes and the acceleration ('{column}') does not"
        return Check("acceleration", False, said, leave_out)
    if not found.agrees:
        said = (
            f"the acceleration ('{column}') is not the derivative of the velocity: they have "
            f"{100.0 * found.common:.0f} % of variance in common"
        )
        return Check("acceleration", False, said, _other(view, pair, leave_out))
    if found.phase > PHASE:
        side = "behind" if found.lag > 0.0 else "ahead of"
        said = f"the acceleration is {abs(found.lag):.3g} s {side} the velocity"
        return Check("acceleration", False, said, leave_out)
    if found.ratio < 0.0 and pair.scaled_right:
        said = "the acceleration has the opposite sign of d(velocity)/dt"
        return Check("acceleration", False, said, _reversed(view))
    if not pair.scaled_right:
        sign = ", with the opposite sign" if found.ratio < 0.0 else ""
        said = f"d(velocity)/dt is {ratio_text(found.ratio)} the acceleration{sign}"
        return Check("acceleration", False, said, scale_remedy(view, pair))
    return Check("acceleration", True, agreement(pair))


def _other(view: View, pair: Pair, leave_out: str) -> str:
    mapped = other_column(view, pair)
    return leave_out if mapped is None else f"give {mapped}, or {leave_out}"


def _reversed(view: View) -> str:
    """The remedy for opposite signs: the velocity's, if it is opposite to the position too."""
    position = view.velocity
    if position is not None and position.agrees and position.ratio < 0.0:
        return f"give {view.derived('velocity', '-{}')}"
    return f"give {view.derived('acceleration', '-{}')}"
