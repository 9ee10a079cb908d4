"""What a column's name says: the channel, its unit and the joint it belongs to."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from stribeck.base.units import Unit, find_unit

__all__ = ["CHANNELS", "ParsedName", "any_index", "file_unit", "parse_name", "wide_groups"]

_EFFORT = ("torque", "force", "voltage", "percent")

#: Channel -> dimensions that its unit may have; none: it holds names.
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

#: Names of each channel, as `_key` writes them.
_ALIASES: dict[str, str] = {
    "time": "time t timestamp seconds elapsed times",
    "position": (
        "position pos q angle theta jointposition actualq qmeas qmeasured displacement jointangle"
    ),
    "velocity": (
        "velocity vel v qd dq qdot omega speed jointvelocity actualqd qdmeas thetadot dtheta qp"
    ),
    "acceleration": "acceleration acc accel a qdd ddq qddot jointacceleration qpp",
    "torque": (
        "torque tau effort force motortorque taum tm jointtorque jointeffort "
        "taumeas actualtorque motorforce"
    ),
    "current": "current i motorcurrent iq actualcurrent jointcurrent",
    "load_torque": "loadtorque tl tauload load tload loadforce",
    "external_torque": "externaltorque te tauext tauexternal",
    "friction_torque": "frictiontorque tf taufriction tfriction frictionforce friction",
    "temperature": "temperature temp jointtemperature motortemperature",
    "enabled": "enabled torqueenable torqueenabled motorenabled driveenabled",
    "joint": "joint jointname jointid axis",
    "run": "run runid trial repetition",
}
_CHANNEL_OF = {alias: channel for channel, aliases in _ALIASES.items() for alias in aliases.split()}


@dataclass(frozen=True)
class ParsedName:
    """The parts of a column's name: ``qd_radps_3`` is a velocity in rad/s, index ``3``.

    Attributes
    ----------
    rank
        0: the channel's own name, 1: the same in another spelling, 2: an alias, 9: no channel.
    """

    name: str
    channel: str | None
    unit: Unit | None
    index: str | None
    rank: int


def _key(stem: str) -> str:
    return re.sub(r"[\s_.\-/]+", "", stem).casefold()


def _unit_at_end(stem: str) -> tuple[str, str] | None:
    """Split off a unit in brackets, ``velocity [rad/s]``."""
    match = re.fullmatch(r"\s*(.*?)[\s_]*[\[(]([^\])]+)[\])]\s*", stem)
    return (match.group(1), match.group(2)) if match else None


def parse_name(name: str) -> ParsedName:
    """Split a column's name into the channel, its unit and its joint index."""
    if name in CHANNELS:
        return ParsedName(name, name, None, None, 0)
    for stem, index in _stems(name):
        found = _match(stem)
        if found is not None:
            channel, unit, own = found
            return ParsedName(name, channel, unit, index, 1 if own else 2)
    return ParsedName(name, None, None, None, 9)


def _stems(name: str) -> list[tuple[str, str | None]]:
    """The possible readings of a name: as it is, and without a joint index."""
    stems: list[tuple[str, str | None]] = [(name, None)]
    match = re.fullmatch(r"(.*?[^\d_\[(.])[_.]?[\[(]?(\d{1,2})[\])]?", name)
    if match:
        stems.append((match.group(1), match.group(2)))
    # q_3_rad: the index is before the unit.
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
                # A single letter may mean anything, except these.
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


def any_index(name: str) -> str | None:
    """The joint index at the end of a column's name, whatever it measures (``i_A_2``)."""
    match = re.search(r"[^\d](\d{1,2})[\])]?$", name)
    return match.group(1) if match else None
