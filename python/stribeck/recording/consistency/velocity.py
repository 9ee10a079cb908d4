"""Whether the velocity is the derivative of the position."""

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

__all__ = ["check_velocity"]


def check_velocity(view: View) -> Check | None:
    """Compare increments of the position with the integral of the velocity.

    Returns
    -------
    Check or None
        None where one of them was not recorded.
    """
    found = view.velocity
    if found is None:
        return None
    pair = Pair("velocity", "position", found)
    if not found.resolved:
        said = "cannot check the velocity: the motion is near the resolution of the position"
        return Check("velocity", True, said)
    if not all(found.seen):
        still, other = ("position", "velocity") if found.seen[1] else ("velocity", "position")
        return Check(
            "velocity",
            False,
            f"the {other} ('{view.column(other)}') moves and the {still} ('{view.column(still)}') "
            "does not",
            other_column(view, pair) or _leave_out(still),
        )
    if not found.agrees:
        return Check(
            "velocity",
            False,
            f"the velocity ('{view.column('velocity')}') is not the derivative of the position "
            f"('{view.column('position')}'): they have {100.0 * found.common:.0f} % of variance in "
            "common",
            other_column(view, pair) or _leave_out("velocity"),
        )
    if found.phase > PHASE:
        side = "behind" if found.lag > 0.0 else "ahead of"
        late = f"the velocity is {abs(found.lag):.3g} s {side} the position"
        return Check(
            "velocity",
            False,
            f"{late}, more than a filter delays",
            _leave_out("velocity"),
        )
    if not pair.scaled_right:
        return _scaled(view, pair)
    if found.ratio < 0.0:
        return _reversed(view)
    return Check("velocity", True, agreement(pair))


def _scaled(view: View, pair: Pair) -> Check:
    ratio = pair.found.ratio
    sign = ", with the opposite sign" if ratio < 0.0 else ""
    return Check(
        "velocity",
        False,
        f"d(position)/dt is {ratio_text(ratio)} the velocity{sign}",
        scale_remedy(view, pair),
    )


def _reversed(view: View) -> Check:
    """The two have opposite signs; friction says which of them is wrong."""
    said = "the velocity has the opposite sign of d(position)/dt"
    friction = None if view.dissipation is None else view.dissipation.friction
    wrong = "position" if friction is not None and friction.sign > 0 else "velocity"
    if friction is not None and friction.sign:
        said += f"; the torque is that of friction if the {wrong} is reversed"
    return Check("velocity", False, said, f"give {view.derived(wrong, '-{}')}")


def _leave_out(channel: str) -> str:
    other = "position" if channel == "velocity" else "velocity"
    derived = ", which derives it from the position" if channel == "velocity" else ""
    return (
        f"name the column of this joint with {option('map', f'{channel}=COLUMN')}, or leave it out "
        f"with {option('map', f'{channel}=none')}{derived or f', which leaves the {other}'}"
    )
