"""What every analysis needs of a table: time, a motion, and a torque."""

from __future__ import annotations

from collections import Counter

from stribeck.base.errors import RecordingError, listed, option
from stribeck.recording.naming.proposals import propose
from stribeck.recording.tables.prepared import Prepared

__all__ = ["require"]

#: Channels that a recording is made of first.
_FIRST = ("time", "position", "velocity", "torque", "current")


def require(prepared: Prepared) -> None:
    """Refuse a table that lacks what every analysis needs.

    Raises
    ------
    RecordingError
        No time, no motion or no torque.
    """
    path = prepared.source.path
    have = prepared.choices
    if "time" not in have and not prepared.settings.average:
        raise RecordingError(
            f"{path}: there is no time column; {_there(prepared)}: name it with "
            f"{option('map', 'time=COLUMN')}; for samples at a known rate, such as 1000 Hz, give "
            f"{option('derive', 'time=row/1000')}; if each row is a steady-state point, give "
            f"{option('average', 'row')}"
        )
    if "velocity" not in have and "position" not in have:
        raise RecordingError(
            f"{path}: there is neither a velocity nor a position column; {_there(prepared)}: name "
            f"one with {option('map', 'velocity=COLUMN')} or {option('map', 'position=COLUMN')}"
        )
    if "torque" in have or "friction_torque" in have:
        return
    if "current" not in have:
        raise RecordingError(
            f"{path}: there is no torque column; {_there(prepared)}: name it with "
            f"{option('map', 'torque=COLUMN')}, or compute one with "
            f"{option('derive', 'torque=FORMULA')}"
        )
    if not prepared.settings.knows_torque_constant:
        raise RecordingError(
            f"{path}: there is a current ('{have['current'].source}') but no torque: give "
            f"{option('torque_constant')} in N m/A (and {option('gear_ratio')}), or name the "
            f"torque with {option('map', 'torque=COLUMN')}"
        )


def _there(prepared: Prepared) -> str:
    """The columns of the file, and what their names propose for the channels that it lacks."""
    there = f"the file has {listed(prepared.table.columns)}"
    found = _proposed(prepared)
    if not found:
        return there
    return f"{there} (by their names perhaps {option('map', *found)})"


def _proposed(prepared: Prepared) -> list[str]:
    """The first channels that the table lacks, each with the only column that may hold it."""
    settings, have = prepared.settings, prepared.choices
    used = {choice.source for choice in have.values()}
    rows = propose(prepared.table.columns, used, settings.joint)
    count = Counter(row.channel for row in rows)
    columns = {row.channel: row.column for row in rows if count[row.channel] == 1}
    effort = {"torque", "current", "friction_torque"}
    lacked = [
        channel
        for channel in _FIRST
        if channel not in {*have, *settings.maps} and not (channel in effort and effort & {*have})
    ]
    if "torque" in columns and "torque" in lacked:
        lacked.remove("current")
    return [f"{channel}={columns[channel]}" for channel in lacked if channel in columns]
