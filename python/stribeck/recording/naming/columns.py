"""Which column of a file is the time, the velocity, the torque, and in which unit."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from stribeck.base.errors import RecordingError, joint_called, listed, nearest, option
from stribeck.base.units import SI, Unit, parse_unit
from stribeck.recording.naming.names import (
    BESIDE,
    CHANNELS,
    ParsedName,
    any_index,
    file_unit,
    parse_name,
    parse_names,
    wide_groups,
)

__all__ = ["Choice", "choose_columns"]

#: Channels that are not looked for when another one takes their place.
_INSTEAD = {
    "torque": ("friction_torque",),
    "current": ("torque", "friction_torque"),
}


@dataclass(frozen=True)
class Choice:
    """The column chosen for a channel.

    Attributes
    ----------
    unit
        None: no unit was named, the SI unit is taken.
    unit_from
        What named the unit: an option, the suffix of the column's name, or nothing ("name", "map").
    """

    channel: str
    source: str
    unit: Unit | None
    unit_from: Literal["map", "option", "suffix", "name"]


def choose_columns(
    path: str,
    names: Sequence[str],
    *,
    derived: Sequence[str],
    maps: Mapping[str, str],
    units: Mapping[str, str],
    index: str | None,
    wanted: Collection[str] = tuple(CHANNELS),
) -> tuple[dict[str, Choice], list[str]]:
    """Choose a column for every channel that a file has.

    Parameters
    ----------
    names, derived
        Columns of the file with the derived ones; the derived ones.
    maps, units
        What was given: channel -> column, column -> unit.
    index
        The joint of a wide file (``q_1`` ... ``q_6``) that was named.
    wanted
        Channels to look for.

    Returns
    -------
    tuple
        Channel -> choice, and notes on what was decided.

    Raises
    ------
    RecordingError
        An option names no column or a wrong unit, or several columns fit one channel.
    """
    _check_given(path, names, maps, units)
    search = _Search(path, names, maps, units, index)
    mapped = {channel for channel, column in maps.items() if column != "none" or "none" in names}
    for channel in (name for name in CHANNELS if name in wanted):
        if channel in maps:
            if channel in mapped:
                search.take(channel, maps[channel], mapped=True)
        elif channel in derived:
            search.take(channel, channel)
        elif channel == "friction_torque" and "torque" in mapped:
            continue  # the torque that a user names is the one to fit
        elif not any(c in mapped or c in search.chosen for c in _INSTEAD.get(channel, ())):
            search.find(channel)
    return search.chosen, search.notes


def _check_given(
    path: str, names: Sequence[str], maps: Mapping[str, str], units: Mapping[str, str]
) -> None:
    """Refuse options that name a channel or column that does not exist."""
    known = set(names)
    for channel, column in maps.items():
        given = option("map", f"{channel}={column}")
        if channel not in CHANNELS:
            hint = nearest(channel, CHANNELS) or f"; those are {', '.join(CHANNELS)}"
            raise RecordingError(
                f"{path}: {given}: '{channel}' is not a channel that stribeck knows{hint}"
            )
        if column not in known and column != "none":
            hint = nearest(column, names) or f"; the file has {listed(names)}"
            raise RecordingError(f"{path}: {given}: there is no column '{column}'{hint}")
    for column, unit in units.items():
        if column not in known and column not in CHANNELS:
            hint = nearest(column, names) or f"; the file has {listed(names)}"
            raise RecordingError(
                f"{path}: {option('unit', f'{column}={unit}')}: there is no column '{column}'{hint}"
            )


class _Search:
    """The columns chosen so far."""

    def __init__(
        self,
        path: str,
        names: Sequence[str],
        maps: Mapping[str, str],
        units: Mapping[str, str],
        index: str | None,
    ) -> None:
        self.path = path
        self.maps = maps
        self.units = units
        self.index = index
        stated = {"position", "velocity"} & {*maps}
        self.parsed = [parse_name(name) for name in names] if stated else parse_names(names)
        self.wide = wide_groups(names)
        self.joint = index if index is not None else _mapped_joint(maps)
        self.chosen: dict[str, Choice] = {}
        self.notes: list[str] = []

    def take(self, channel: str, column: str, *, mapped: bool = False) -> None:
        """Choose a column; a unit that was given and is not that of its name is noted."""
        chosen = _choice(self.path, channel, column, self.units, mapped=mapped)
        self.chosen[channel] = chosen
        named = _named_unit(column, CHANNELS[channel])
        if chosen.unit_from == "option" and chosen.unit and named and not _same(chosen.unit, named):
            self.notes.append(
                f"'{column}' is read in {chosen.unit.name}, as given, though its name says "
                f"{named.name}"
            )

    def find(self, channel: str) -> None:
        """Choose the column whose name fits the channel best, if there is one."""
        candidates = [p for p in self.parsed if p.channel == channel]
        if channel in BESIDE:
            self._find_beside(channel, candidates)
            return
        plain = [p for p in candidates if p.index is None]
        if not plain and channel in self.wide:
            plain = self._of_joint(channel)
        elif not plain and len(candidates) == 1 and not self._is_of_another(candidates[0]):
            plain = candidates
        if not plain:
            return
        rank = min(p.rank for p in plain)
        best = [p for p in plain if p.rank == rank]
        if len(best) > 1 and channel in ("torque", "load_torque", "friction_torque"):
            physical = [p for p in best if p.unit and p.unit.dimension in ("torque", "force")]
            if len(physical) == 1:
                left = ", ".join(p.name for p in best if p is not physical[0])
                self.notes.append(f"{channel} is read from '{physical[0].name}'; {left} not used")
                best = physical
        if len(best) > 1:
            same = [p.name for p in best]
            raise RecordingError(
                f"{self.path}: {listed(same)} could each be the {channel}: choose with "
                f"{option('map', f'{channel}={same[0]}')}"
            )
        self.take(channel, best[0].name)
        if rank > 2 and best[0].index is None:
            self.notes.append(f"{channel} is read from '{best[0].name}', by part of its name")

    def _is_of_another(self, column: ParsedName) -> bool:
        """Whether a column is of another joint than the one that was named in a wide file."""
        return bool(self.wide) and self.joint is not None and column.index != self.joint

    def _find_beside(self, channel: str, candidates: Sequence[ParsedName]) -> None:
        """The one column of a reference or motor channel, or that of the joint that was named.

        Every other analysis works without it, so several columns are no error.
        """
        named = [p for p in candidates if p.index is not None and p.index == self.joint]
        found = named or ([] if self.wide else candidates)
        if len(found) == 1:
            self.take(channel, found[0].name)

    def _of_joint(self, channel: str) -> list[ParsedName]:
        """The column of one joint of a wide file."""
        columns = self.wide[channel]
        if self.joint is not None and self.joint in columns:
            source = columns[self.joint]
            self.notes.append(f"{channel} is read from '{source}', the joint that was named")
            return [parse_name(source)]
        if self.index is not None:
            raise RecordingError(
                f"{self.path}: there is no joint '{self.index}' in {listed(columns.values())}: "
                f"name one of {listed(columns)}"
            )
        if "velocity" in self.maps and channel in ("position", "acceleration"):
            return []
        raise RecordingError(_wide_sentence(self.path, self.wide))


def _mapped_joint(maps: Mapping[str, str]) -> str | None:
    """The joint of a wide file that all mapped columns belong to."""
    named = {parse_name(c).index for c in maps.values()} | {any_index(c) for c in maps.values()}
    indices = {i for i in named if i is not None}
    return indices.pop() if len(indices) == 1 else None


def _choice(
    path: str, channel: str, column: str, units: Mapping[str, str], *, mapped: bool
) -> Choice:
    dimensions = CHANNELS[channel]
    if not dimensions:
        return Choice(channel, column, None, "map" if mapped else "name")
    given = units.get(column, units.get(channel))
    if given is not None:
        what = f"{path}: {option('unit', f'{column}={given}')}"
        unit = parse_unit(given, dimensions, what)
        return Choice(channel, column, unit, "option")
    named = _named_unit(column, dimensions)
    if named is not None:
        return Choice(channel, column, named, "suffix")
    if mapped and column not in CHANNELS:
        _refuse_other_quantity(path, channel, parse_name(column), file_unit(column))
    return Choice(channel, column, None, "name")


def _named_unit(column: str, dimensions: Sequence[str]) -> Unit | None:
    """The unit of one of these dimensions that the name of a column says."""
    units = (parse_name(column).unit, file_unit(column))
    return next((unit for unit in units if unit is not None and unit.dimension in dimensions), None)


def _same(one: Unit, other: Unit) -> bool:
    """Whether two units are one, in whatever spelling."""
    return replace(one, name=other.name) == other


def _refuse_other_quantity(
    path: str, channel: str, parsed: ParsedName, carried: Unit | None
) -> None:
    """Refuse a mapped column whose name says another quantity: most likely it is a mistake."""
    dimension = CHANNELS[channel][0]
    column = parsed.name
    map_option = option("map", f"{channel}={column}")
    unit_option = option("unit", f"{column}={SI[dimension].replace(' ', '')}")
    if parsed.channel == "current" and CHANNELS[channel] == CHANNELS["torque"]:
        raise RecordingError(
            f"{path}: {map_option}: the name says a current; map it with "
            f"{option('map', f'current={column}')} and give {option('torque_constant')}, or, if it "
            f"is a torque or force, its unit with {unit_option}"
        )
    if carried is not None and len(carried.name) > 1:
        raise RecordingError(
            f"{path}: {map_option}: the name says {carried.name}, a unit of {carried.dimension}; "
            f"give the column's unit with {unit_option}, or map another column"
        )


def _wide_sentence(path: str, wide: Mapping[str, Mapping[str, str]]) -> str:
    first_group = next(iter(wide.values()))
    first = next(iter(first_group))
    maps = [
        f"{channel}={columns.get(first, next(iter(columns.values())))}"
        for channel, columns in wide.items()
        if channel != "current" or "torque" not in wide
    ]
    if "torque" not in wide and "friction_torque" not in wide and "current" not in wide:
        maps.append("torque=COLUMN")
    advice = option("map", *maps)
    if "current" in wide and "torque" not in wide:
        advice += f" and {option('torque_constant')}"
    return (
        f"{path}: the file holds {len(first_group)} joints side by side "
        f"({listed(first_group.values())}): choose one with {option('joint', first)}, or by its "
        f"columns, e.g. {joint_called(first)} with {advice}"
    )
