"""Where the torque was measured, and what it can show there."""

from __future__ import annotations

from stribeck.base.errors import option
from stribeck.recording.check import Check
from stribeck.recording.consistency.view import View
from stribeck.recording.torque_at import SHOWS

__all__ = ["check_torque_at"]


def check_torque_at(view: View) -> Check | None:
    """State where the torque was measured.

    Returns
    -------
    Check or None
        None where friction was measured directly, or the effort is a voltage or a share of one.
    """
    recording, choices = view.recording, view.prepared.choices
    if "friction_torque" in recording.columns or recording.torque_unit in ("V", "%"):
        return None
    where, choice = recording.torque_at, choices.get("torque")
    column = "torque" if choice is None else choice.source
    if where is None:
        return Check(
            "torque_at",
            True,
            f"cannot check where the torque ('{column}') was measured: a cell at the link sees no "
            "friction of the gear",
            f"state it with {option('torque_at', 'motor')}, command or link",
        )
    given = "" if view.prepared.settings.torque_at else ", by its name"
    named = {"motor": "at the motor", "command": "as a command", "link": "at the link"}[where]
    return Check("torque_at", True, f"the torque is taken {named}{given}: {SHOWS[where]}")
