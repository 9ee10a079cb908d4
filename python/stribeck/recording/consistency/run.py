"""Every check of a recording, and the refusal of one whose channels contradict each other."""

from __future__ import annotations

from collections.abc import Callable

from stribeck.recording.arrays import Ints
from stribeck.recording.check import Check
from stribeck.recording.consistency.acceleration import check_acceleration
from stribeck.recording.consistency.clock import check_clock
from stribeck.recording.consistency.current import check_current
from stribeck.recording.consistency.effort import check_torque_at
from stribeck.recording.consistency.joints import check_joints
from stribeck.recording.consistency.load import check_load
from stribeck.recording.consistency.others import check_others
from stribeck.recording.consistency.runs import between_runs
from stribeck.recording.consistency.temperature import check_temperature
from stribeck.recording.consistency.torque import check_torque
from stribeck.recording.consistency.turn import check_turn
from stribeck.recording.consistency.velocity import check_velocity
from stribeck.recording.consistency.view import View
from stribeck.recording.recording import Recording
from stribeck.recording.tables.prepared import Prepared

__all__ = ["checked"]

#: In the order in which they are told: a wrong unit of time explains a wrong velocity.
_CHECKS: tuple[Callable[[View], Check | None], ...] = (
    check_clock,
    check_joints,
    check_others,
    check_velocity,
    check_acceleration,
    check_load,
    check_torque,
    check_torque_at,
    check_current,
    check_temperature,
    check_turn,
)


def checked(recording: Recording, prepared: Prepared, rows: Ints) -> tuple[Check, ...]:
    """Compare the channels of a recording with each other.

    Parameters
    ----------
    rows
        Row of the table of each sample of the recording, [n]; its length does not matter for
        steady-state points.
    """
    view = View(recording, prepared, rows)
    made = (check(view) for check in _CHECKS)
    return (*(one for one in made if one is not None), *between_runs(recording))
