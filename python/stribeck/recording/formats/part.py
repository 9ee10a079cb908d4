"""Tables of one file that have rows of their own, and which of them are read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.formats.door import Asked, Entered
from stribeck.recording.naming.names import parse_name

__all__ = ["Part", "Read", "chosen", "merged"]

#: How many names are listed.
_SHOWN = 6
#: Values further apart than this many usual steps of their clock are not interpolated.
_GAP = 5.0


@dataclass(frozen=True)
class Read:
    """What was read of a file.

    Attributes
    ----------
    table
        Its columns.
    notes
        What of the file is not in the table, or was changed.
    first_line
        Line of the first row, 0 where lines do not count rows.
    joints
        Name of a joint -> its index in the names of the columns.
    """

    table: pl.DataFrame
    notes: tuple[str, ...] = ()
    first_line: int = 0
    joints: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Part:
    """Columns of a file with the same rows.

    Attributes
    ----------
    name
        As sentences name it.
    table
        The columns.
    clock
        The column of its time, if it is known to be on the clock of all parts; never negative
        steps.
    joints
        As in `Read`.
    """

    name: str
    table: pl.DataFrame
    clock: str | None = None
    joints: Mapping[str, str] = field(default_factory=dict)

    @property
    def recorded(self) -> bool:
        """Whether its names say that it holds a motion over time."""
        channels = {parse_name(name).channel for name in self.table.columns}
        return "time" in channels and not channels.isdisjoint(("position", "velocity"))

    def shown(self) -> str:
        """Name, joints and size."""
        joints = f" of {', '.join(self.joints)}" if self.joints else ""
        return f"{self.name}{joints} ({self.table.height} rows)"


def merged(parts: Sequence[Part]) -> list[Part]:
    """The parts, those with the same times as one."""
    found: list[Part] = []
    for part in parts:
        for i, other in enumerate(found):
            if part.clock is None or other.clock is None:
                continue
            new = [c for c in part.table.columns if c != part.clock]
            clash = any(c in other.table.columns for c in new)
            if not clash and part.table[part.clock].equals(other.table[other.clock]):
                found[i] = replace(other, table=other.table.with_columns(part.table[new]))
                break
        else:
            found.append(part)
    return found


def chosen(file: Entered, parts: Sequence[Part], asked: Asked) -> Read:
    """The part that holds what was asked; columns of other parts are put on its clock.

    Without a question, the part with a clock and a motion is taken, then the one with most columns,
    then the longest; the others are named in a note.

    Raises
    ------
    RecordingError
        What was asked is in parts without a common clock, or several parts hold a motion.
    """
    if not parts:
        raise RecordingError(f"{file.name}: holds no arrays of numbers")
    # Several publishers share a topic: an arm and its gripper, for example.
    of_joint = [part for part in parts if asked.joint is not None and asked.joint in part.joints]
    if of_joint:
        parts = of_joint
    named = {i: asked.among(part.table.columns) for i, part in enumerate(parts)}
    holding = [i for i in named if named[i]]
    if not holding:
        main = _by_worth(file, parts)
        if not parts[main].recorded and all(part.clock is not None for part in parts):
            # Channels of several rates: each part has some of what a recording needs.
            named = {i: _channels(part) for i, part in enumerate(parts)}
            holding = [i for i in named if named[i]]
    if holding:
        main = _main(parts, named)
    whole, notes = parts[main].table, []
    for i in holding:
        if i != main:
            whole, note = _joined(file, whole, parts[main], parts[i], named[i])
            notes.append(note)
    left = [part for i, part in enumerate(parts) if i != main and i not in holding]
    notes += _left_out(left, parts[main])
    return Read(whole, tuple(notes), joints=dict(parts[main].joints))


def _main(parts: Sequence[Part], named: Mapping[int, Sequence[str]]) -> int:
    """The part whose rows are taken: with the torque that was asked for, else with a motion."""

    def worth(i: int) -> tuple[bool, bool, bool, int, int]:
        own = named[i]
        return _has_effort(own), bool(own) and parts[i].recorded, parts[i].recorded, len(own), -i

    return max(named, key=worth)


def _channels(part: Part) -> list[str]:
    """The columns whose names say what they hold, without the clock."""
    names = [c for c in part.table.columns if c != part.clock]
    return [c for c in names if parse_name(c).channel is not None]


def _has_effort(columns: Sequence[str]) -> bool:
    """Whether the torque is among the columns: it stays as recorded, so its rows are taken."""
    efforts = {"torque", "current", "friction_torque"}
    return any(parse_name(c).channel in efforts for c in columns)


def _by_worth(file: Entered, parts: Sequence[Part]) -> int:
    recorded = [i for i, part in enumerate(parts) if part.recorded and part.table.height > 1]
    if len(recorded) > 1:
        shown = ", ".join(parts[i].shown() for i in recorded[:_SHOWN])
        choices = " or ".join(_choice(parts, i) for i in recorded[:2])
        raise RecordingError(
            f"{file.name}: holds {len(recorded)} recordings with rows of their own: {shown}: "
            f"choose one with {choices}"
        )
    if recorded:
        return recorded[0]
    long = [i for i, part in enumerate(parts) if part.table.height > 1] or [*range(len(parts))]
    return max(long, key=lambda i: (parts[i].table.width, parts[i].table.height))


def _choice(parts: Sequence[Part], which: int) -> str:
    """The option that chooses a part, by a joint or a column that no other part has."""
    part, others = parts[which], [*parts[:which], *parts[which + 1 :]]
    own = [joint for joint in part.joints if all(joint not in o.joints for o in others)]
    if own:
        return option("joint", own[0])
    names = part.table.columns
    clock = next((c for c in names if parse_name(c).channel == "time"), None)
    if part.clock is None and clock is not None:
        return option("map", f"time={clock}")
    motion = next(c for c in names if parse_name(c).channel in ("velocity", "position"))
    return option("map", f"{parse_name(motion).channel}={motion}")


def _left_out(left: Sequence[Part], main: Part) -> list[str]:
    """A note on the columns of other parts, the longest first; single values are no columns."""
    sizes = {c: part.table.height for part in left for c in part.table.columns}
    sizes = {c: size for c, size in sizes.items() if size > 1}
    if not sizes:
        return []
    listed = sorted(sizes, key=lambda c: -sizes[c])
    shown = ", ".join(f"{c} ({sizes[c]})" for c in listed[:_SHOWN])
    more = f" and {len(listed) - _SHOWN} more" if len(listed) > _SHOWN else ""
    what = "1 array is" if len(listed) == 1 else f"{len(listed)} arrays are"
    note = f"{what} left out, not {main.table.height} long: {shown}{more}"
    if sizes[listed[0]] > main.table.height:
        first = parse_name(listed[0]).channel or "torque"
        note += f"; to read a longer one, name it, {option('map', f'{first}={listed[0]}')}"
    return [note]


def _joined(
    file: Entered, whole: pl.DataFrame, main: Part, other: Part, columns: Sequence[str]
) -> tuple[pl.DataFrame, str]:
    """The table with columns of another part at its own times."""
    if main.clock is None or other.clock is None:
        raise RecordingError(
            f"{file.name}: {columns[0]} has {other.table.height} rows, and what was asked of "
            f"{main.name} has {main.table.height}: name columns of the same length"
        )
    at, own = _seconds(main.table, main.clock), _seconds(other.table, other.clock)
    order = np.argsort(own, kind="stable")
    made = [_at_times(other.table[c], own[order], order, at) for c in columns if c != other.clock]
    note = f"{', '.join(columns)} ({other.table.height} rows) at the times of {main.name}"
    how = "decimal numbers are interpolated, others are the value before"
    return whole.with_columns(made), f"{note}: {how}"


def _seconds(table: pl.DataFrame, clock: str) -> Floats:
    return table[clock].cast(pl.Float64).to_numpy()


def _at_times(values: pl.Series, own: Floats, order: Ints, at: Floats) -> pl.Series:
    """A column at other times; empty before its first value, after its last and in its gaps."""
    after = np.clip(np.searchsorted(own, at, side="right"), 1, max(len(own) - 1, 1))
    usual = float(np.median(np.diff(own))) if len(own) > 1 else 0.0
    step = own[np.minimum(after, len(own) - 1)] - own[after - 1]
    empty = (at < own[0]) | (at > own[-1]) | (step > _GAP * usual)
    if not values.dtype.is_float():
        taken = values.gather(order[after - 1])
        return (
            pl.select(pl.when(pl.Series(~(at < own[0]))).then(taken)).to_series().alias(values.name)
        )
    made = np.interp(at, own, values.to_numpy()[order])
    made[empty] = np.nan
    return pl.Series(values.name, made)
