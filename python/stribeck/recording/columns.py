"""Which column of a file is the time, the velocity, the torque ... and in which unit."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from stribeck.base.errors import RecordingError, nearest
from stribeck.recording.units import SI, Unit, find_unit, parse_unit

__all__ = [
    "CHANNELS",
    "Choice",
    "ParsedName",
    "choose_columns",
    "file_unit",
    "parse_name",
    "wide_groups",
]

_EFFORT = ("torque", "force", "voltage", "percent")

# Channel -> dimensions its unit may have.
CHANNELS: dict[str, tuple[str, ...]] = {
    "time": ("time",),
    "position": ("angle", "length"),
    "velocity": ("angular velocity", "linear velocity"),
    "acceleration": ("angular acceleration", "linear acceleration"),
    "torque": _EFFORT,
    "current": ("current",),
    "load_torque": _EFFORT,
    "external_torque": _EFFORT,
    "friction_torque": _EFFORT,
    "temperature": ("temperature",),
    "enabled": (),
    "joint": (),
    "run": (),
}

# Written without '_', lower case; see _key.
_ALIASES: dict[str, tuple[str, ...]] = {
    "time": ("time", "t", "timestamp", "seconds", "elapsed", "times"),
    "position": (
        "position",
        "pos",
        "q",
        "angle",
        "theta",
        "jointposition",
        "actualq",
        "qmeas",
        "qmeasured",
        "displacement",
        "jointangle",
    ),
    "velocity": (
        "velocity",
        "vel",
        "v",
        "qd",
        "dq",
        "qdot",
        "omega",
        "speed",
        "jointvelocity",
        "actualqd",
        "qdmeas",
        "thetadot",
        "dtheta",
        "qp",
    ),
    "acceleration": (
        "acceleration",
        "acc",
        "accel",
        "a",
        "qdd",
        "ddq",
        "qddot",
        "jointacceleration",
        "qpp",
    ),
    "torque": (
        "torque",
        "tau",
        "effort",
        "force",
        "motortorque",
        "taum",
        "tm",
        "jointtorque",
        "jointeffort",
        "taumeas",
        "actualtorque",
        "motorforce",
    ),
    "current": ("current", "i", "motorcurrent", "iq", "actualcurrent", "jointcurrent"),
    "load_torque": ("loadtorque", "tl", "tauload", "load", "tload", "loadforce"),
    "external_torque": ("externaltorque", "te", "tauext", "tauexternal"),
    "friction_torque": (
        "frictiontorque",
        "tf",
        "taufriction",
        "tfriction",
        "frictionforce",
        "friction",
    ),
    "temperature": ("temperature", "temp", "jointtemperature", "motortemperature"),
    "enabled": ("enabled", "torqueenable", "torqueenabled", "motorenabled", "driveenabled"),
    "joint": ("joint", "jointname", "jointid", "axis"),
    "run": ("run", "runid", "trial", "repetition"),
}
_CHANNEL_OF = {alias: channel for channel, aliases in _ALIASES.items() for alias in aliases}

# Channels not looked for when another one already says what they would.
_INSTEAD = {
    "torque": ("friction_torque",),
    "current": ("torque", "friction_torque"),
}


@dataclass(frozen=True)
class ParsedName:
    """A column name taken apart: ``qd_radps_3`` is stem ``qd``, unit rad/s, index ``3``."""

    name: str
    channel: str | None
    unit: Unit | None
    index: str | None
    rank: int  # 0 the channel's own name, 1 its own name otherwise written, 2 an alias


@dataclass(frozen=True)
class Choice:
    """The column chosen for a channel."""

    channel: str
    source: str
    unit: Unit | None  # None: no unit was named, the SI unit is taken
    said_by: str  # "map" | "option" | "suffix" | "name": who named the unit


def _key(stem: str) -> str:
    return re.sub(r"[\s_.\-/]+", "", stem).casefold()


def _unit_at_end(stem: str) -> tuple[str, str] | None:
    """Split off a unit in brackets, ``velocity [rad/s]``."""
    match = re.fullmatch(r"\s*(.*?)[\s_]*[\[(]([^\])]+)[\])]\s*", stem)
    return (match.group(1), match.group(2)) if match else None


def parse_name(name: str) -> ParsedName:
    """Take a column name apart into what it measures, its unit and its joint index."""
    if name in CHANNELS:
        return ParsedName(name, name, None, None, 0)
    for stem, index in _stems(name):
        found = _match(stem)
        if found is not None:
            channel, unit, own = found
            return ParsedName(name, channel, unit, index, 1 if own else 2)
    return ParsedName(name, None, None, None, 9)


def _stems(name: str) -> list[tuple[str, str | None]]:
    """List the readings of a name: whole, and without a joint index at either place."""
    stems: list[tuple[str, str | None]] = [(name, None)]
    match = re.fullmatch(r"(.*?[^\d_\[(.])[_.]?[\[(]?(\d{1,2})[\])]?", name)
    if match:
        stems.append((match.group(1), match.group(2)))
    # q_3_rad: the index stands before the unit.
    match = re.fullmatch(r"(.*?[^\d_])_?(\d{1,2})(_[A-Za-z%]\w*|\s*[\[(].*[\])])", name)
    if match:
        stems.append((match.group(1) + match.group(3), match.group(2)))
    return stems


def _match(stem: str) -> tuple[str, Unit | None, bool] | None:
    bracket = _unit_at_end(stem)
    if bracket is not None:
        channel = _CHANNEL_OF.get(_key(bracket[0]))
        if channel is not None:
            unit = find_unit(bracket[1], CHANNELS[channel])
            if unit is not None:
                return channel, unit, _key(bracket[0]) == _key(channel)
        return None
    channel = _CHANNEL_OF.get(_key(stem))
    if channel is not None:
        return channel, None, _key(stem) == _key(channel)
    parts = stem.split("_")
    for count in (1, 2, 3):
        if count >= len(parts):
            break
        head = "_".join(parts[:-count])
        channel = _CHANNEL_OF.get(_key(head))
        if channel is not None and CHANNELS[channel]:
            unit = find_unit("_".join(parts[-count:]), CHANNELS[channel])
            if unit is not None:
                return channel, unit, _key(head) == _key(channel)
    return None


def file_unit(name: str) -> Unit | None:
    """Return the unit a column's name carries, whatever the column measures."""
    bracket = _unit_at_end(name)
    if bracket is not None:
        return find_unit(bracket[1])
    for stem, _ in _stems(name):
        parts = stem.split("_")
        for count in (1, 2, 3):
            if count < len(parts):
                text = "_".join(parts[-count:])
                # One small letter alone is too weak a sign, except metres and seconds.
                unit = find_unit(text)
                if unit is not None and (len(text) > 1 or text in "smNVA%KC"):
                    return unit
    return None


def wide_groups(names: Sequence[str]) -> dict[str, dict[str, str]]:
    """Return, per channel, joint index -> column, for channels that come in several joints."""
    groups: dict[str, dict[str, str]] = {}
    for name in names:
        parsed = parse_name(name)
        if parsed.channel is not None and parsed.index is not None:
            groups.setdefault(parsed.channel, {}).setdefault(parsed.index, name)
    return {channel: columns for channel, columns in groups.items() if len(columns) > 1}


def choose_columns(
    path: str,
    names: Sequence[str],
    *,
    derived: Sequence[str],
    maps: Mapping[str, str],
    units: Mapping[str, str],
    index: str | None,
) -> tuple[dict[str, Choice], list[str]]:
    """Choose a column for every channel a file can feed.

    Parameters
    ----------
    names, derived
        Columns of the file with the derived ones; those that a formula made.
    maps, units
        What the user said: channel -> column, column -> unit.
    index
        The joint of a wide file (``q_1`` ... ``q_6``), when the user named one.

    Returns
    -------
    tuple
        Channel -> choice, and notes on what was decided.
    """
    notes: list[str] = []
    known = set(names)
    for channel, column in maps.items():
        if channel not in CHANNELS:
            raise RecordingError(
                f"{path}: --map {channel}={column}: '{channel}' is not a column stribeck knows"
                f"{nearest(channel, CHANNELS) or '; those are ' + ', '.join(CHANNELS)}"
            )
        if column not in known and column != "none":
            hint = nearest(column, names) or f"; the file has {', '.join(names)}"
            raise RecordingError(
                f"{path}: --map {channel}={column}: there is no column '{column}'{hint}"
            )
    for column in units:
        if column not in known and column not in CHANNELS:
            hint = nearest(column, names) or f"; the file has {', '.join(names)}"
            raise RecordingError(
                f"{path}: --unit {column}={units[column]}: there is no column '{column}'{hint}"
            )

    wide = wide_groups(names)
    follow = index
    if follow is None:
        # Maps that all name one joint of a wide file say which joint is meant.
        named = {parse_name(c).index for c in maps.values()} | {
            _any_index(c) for c in maps.values()
        }
        indices = {i for i in named if i is not None}
        if len(indices) == 1:
            follow = indices.pop()

    chosen: dict[str, Choice] = {}
    for channel in CHANNELS:
        if channel in maps:
            if maps[channel] == "none" and "none" not in known:
                continue
            chosen[channel] = _choice(path, channel, maps[channel], units, mapped=True)
            continue
        if channel in derived:
            chosen[channel] = _choice(path, channel, channel, units, mapped=False)
            continue
        if channel in _INSTEAD and any(c in maps or c in chosen for c in _INSTEAD[channel]):
            continue
        candidates = [p for p in map(parse_name, names) if p.channel == channel]
        plain = [p for p in candidates if p.index is None]
        indexed = [p for p in candidates if p.index is not None]
        if not plain and channel in wide:
            columns = wide[channel]
            if follow is not None and follow in columns:
                notes.append(
                    f"{channel} is read from '{columns[follow]}', the joint that was named"
                )
                plain = [parse_name(columns[follow])]
            elif index is not None:
                raise RecordingError(
                    f"{path}: there is no joint '{index}' in {', '.join(columns.values())}: "
                    f"name one of {', '.join(columns)}"
                )
            elif "velocity" in maps and channel in ("position", "acceleration"):
                continue
            else:
                raise RecordingError(_wide_sentence(path, wide))
        elif not plain and len(indexed) == 1:
            plain = indexed
        if not plain:
            continue
        best = min(p.rank for p in plain)
        best_ones = [p for p in plain if p.rank == best]
        if len(best_ones) > 1 and channel in ("torque", "load_torque", "friction_torque"):
            physical = [p for p in best_ones if p.unit and p.unit.dimension in ("torque", "force")]
            if len(physical) == 1:
                left = ", ".join(p.name for p in best_ones if p is not physical[0])
                notes.append(f"{channel} is read from '{physical[0].name}'; {left} left aside")
                best_ones = physical
        if len(best_ones) > 1:
            same = [p.name for p in best_ones]
            raise RecordingError(
                f"{path}: {', '.join(same)} could each be the {channel}: say which with "
                f"--map {channel}={same[0]}"
            )
        chosen[channel] = _choice(path, channel, best_ones[0].name, units, mapped=False)
    return chosen, notes


def _any_index(name: str) -> str | None:
    """Return the joint index of a column whatever it measures (``i_A_2``)."""
    match = re.search(r"[^\d](\d{1,2})[\])]?$", name)
    return match.group(1) if match else None


def _choice(
    path: str, channel: str, column: str, units: Mapping[str, str], *, mapped: bool
) -> Choice:
    dimensions = CHANNELS[channel]
    if not dimensions:
        return Choice(channel, column, None, "map" if mapped else "name")
    said = units.get(column, units.get(channel))
    if said is not None:
        unit = parse_unit(said, dimensions, f"{path}: --unit {column}={said}")
        return Choice(channel, column, unit, "option")
    parsed = parse_name(column)
    if parsed.unit is not None and parsed.unit.dimension in dimensions:
        return Choice(channel, column, parsed.unit, "suffix")
    carried = file_unit(column)
    if carried is not None and carried.dimension in dimensions:
        return Choice(channel, column, carried, "suffix")
    if mapped and carried is not None and len(carried.name) > 1 and column not in CHANNELS:
        # A mapped column that names a unit of another kind is a slip worth stopping for.
        raise RecordingError(
            f"{path}: --map {channel}={column}: the name says {carried.name}, a unit of "
            f"{carried.dimension}; say its unit with --unit {column}="
            f"{SI[dimensions[0]].replace(' ', '')}, or map another column"
        )
    return Choice(channel, column, None, "name")


def _wide_sentence(path: str, wide: Mapping[str, Mapping[str, str]]) -> str:
    indices = list(next(iter(wide.values())))
    first = indices[0]
    maps = " ".join(
        f"--map {channel}={columns.get(first, next(iter(columns.values())))}"
        for channel, columns in wide.items()
        if channel != "current" or "torque" not in wide
    )
    if "torque" not in wide and "friction_torque" not in wide and "current" not in wide:
        maps += " --map torque=COLUMN"
    if "current" in wide and "torque" not in wide:
        maps += " --torque-constant NM_PER_A"
    return (
        f"{path}: the file holds {len(indices)} joints side by side "
        f"({', '.join(next(iter(wide.values())).values())}): say which, e.g. for joint {first}: "
        f"{maps}"
    )
