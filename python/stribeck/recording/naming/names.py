"""What a column's name says: the channel, its unit and the joint it belongs to."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from stribeck.base.units import Unit, find_unit

__all__ = [
    "BESIDE",
    "CHANNELS",
    "MOTOR",
    "REFERENCE",
    "ParsedName",
    "any_index",
    "channel_words",
    "file_unit",
    "parse_name",
    "parse_names",
    "same_of_joint",
    "unknown_unit",
    "wide_groups",
]

_EFFORT = ("torque", "force", "voltage", "percent")

#: Channel -> dimensions that its unit may have; none: it holds names.
CHANNELS: dict[str, tuple[str, ...]] = {
    "time": ("time",),
    "position": ("angle", "length"),
    "velocity": ("angular velocity", "linear velocity"),
    "acceleration": ("angular acceleration", "linear acceleration"),
    "reference_position": ("angle", "length"),
    "reference_velocity": ("angular velocity", "linear velocity"),
    "reference_acceleration": ("angular acceleration", "linear acceleration"),
    "motor_position": ("angle", "length"),
    "motor_velocity": ("angular velocity", "linear velocity"),
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

#: Channels of the reference trajectory of a controller.
REFERENCE = ("reference_position", "reference_velocity", "reference_acceleration")
#: Channels of a second encoder, on the shaft of the motor.
MOTOR = ("motor_position", "motor_velocity")
#: Channels that most analyses do without: none of them makes a file ambiguous or a row incomplete.
BESIDE = REFERENCE + MOTOR

#: Names of each channel, as `_key` writes them.
_ALIASES: dict[str, str] = {
    "time": "time t timestamp seconds elapsed times",
    "position": (
        "position pos q angle theta jointposition positions actualq qmeas qmeasured displacement "
        "jointangle"
    ),
    "velocity": (
        "velocity vel v qd dq qdot omega speed jointvelocity velocities actualqd qdmeas thetadot "
        "dtheta qp"
    ),
    "acceleration": "acceleration accelerations acc accel a qdd ddq qddot jointacceleration qpp",
    "reference_position": (
        "referenceposition positionreference qref posref positionref refposition qdes qdesired "
        "desiredposition targetq targetposition"
    ),
    "reference_velocity": (
        "referencevelocity velocityreference qdref dqref velref velocityref refvelocity qddes "
        "dqdes desiredvelocity targetqd targetvelocity"
    ),
    "reference_acceleration": (
        "referenceacceleration accelerationreference qddref ddqref accref accelerationref "
        "refacceleration qdddes ddqdes desiredacceleration targetqdd targetacceleration"
    ),
    "motor_position": "motorposition motorangle motorpos positionmotor posmotor motorencoder",
    "motor_velocity": "motorvelocity motorspeed motorvel velocitymotor velmotor",
    "torque": (
        "torque tau effort efforts force motortorque taum tm jointtorque jointeffort "
        "taumeas actualtorque motorforce tor trq torq"
    ),
    "current": "current cur curr i motorcurrent iq actualcurrent jointcurrent",
    "load_torque": "loadtorque tl tauload load tload loadforce",
    "external_torque": "externaltorque te tauext tauexternal",
    "friction_torque": "frictiontorque tf taufriction tfriction frictionforce friction",
    "temperature": "temperature temp jointtemperature jointtemperatures motortemperature",
    "enabled": "enabled torqueenable torqueenabled motorenabled driveenabled",
    "joint": "joint jointname jointid axis",
    "run": "run runid trial repetition episode episodeindex",
}
#: Words of a name that do not change what is measured, and those of a second or relative sensor.
_QUALIFIERS = frozenset(
    "act actual value meas measured mot motor joint axis abs fb feedback cont continuous".split()
)
_SECOND = frozenset("se second secondary link rel relative raw".split())
#: Parts of a path that say that its end is a reference, or no measurement.
_REFERRED = frozenset("reference desired setpoint goal target command".split())
_UNMEASURED = frozenset("error output".split())
_CHANNEL_OF = {alias: channel for channel, aliases in _ALIASES.items() for alias in aliases.split()}


@dataclass(frozen=True)
class ParsedName:
    """The parts of a column's name: ``qd_radps_3`` is a velocity in rad/s, index ``3``.

    Attributes
    ----------
    rank
        0: the channel's own name, 1: the same in another spelling, 2: an alias, 3: an alias among
        words that do not change what is measured, 4: the same of a second sensor, 5: the end of a
        path (``/joint_states.velocity[2]``), 9: no channel.
    """

    name: str
    channel: str | None
    unit: Unit | None
    index: str | None
    rank: int


def _key(stem: str) -> str:
    return re.sub(r"[\s_.\-/]+", "", stem).casefold()


def channel_words(word: str) -> str | None:
    """The channel that a single word of a name stands for; None for any other word.

    Examples
    --------
    >>> channel_words("temp"), channel_words("mos")
    ('temperature', None)
    """
    return _CHANNEL_OF.get(_key(word))


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
    for stem, index in _stems(name):
        bare, second = _without_qualifiers(stem)
        found = None if bare is None else _match(bare)
        if found is not None:
            return ParsedName(name, found[0], found[1], index, 4 if second else 3)
    return _end_of_path(name) or _after_joint(name) or ParsedName(name, None, None, None, 9)


def _end_of_path(name: str) -> ParsedName | None:
    """What the last part of a path says; None for a name that is none, or of no channel.

    The joint may be the part before: ``/joint_states/elbow/velocity``.
    """
    # Units have points and slashes too: 'drive.torque [N.m]', 'qd_rad/s'.
    *before, end = re.split(r"[./](?!s\b)(?![^\[(]*[\])])", name)
    if not before or not end or _UNMEASURED.intersection(before):
        return None
    found = parse_name(end)
    if found.channel is None:
        return None
    index = found.index
    if index is None and len(before) > 1 and name.startswith("/"):
        index = before[-1]
    channel: str | None = found.channel
    if _REFERRED.intersection(before):
        channel = f"reference_{channel}" if f"reference_{channel}" in CHANNELS else None
    return ParsedName(name, channel, found.unit, index, 5) if channel else None


def _after_joint(name: str) -> ParsedName | None:
    """What follows the name of a joint, as robots are logged: ``elbow_joint_velocity``."""
    match = re.fullmatch(r"(.+_joint)_([A-Za-z]+)", name)
    channel = _CHANNEL_OF.get(_key(match.group(2))) if match else None
    if match is None or channel is None:
        return None
    return ParsedName(name, channel, None, match.group(1), 5)


def parse_names(names: Sequence[str]) -> list[ParsedName]:
    """The parts of all column names of a file.

    A motor's position or velocity is that of the joint if the file has no other motion.

    Examples
    --------
    >>> [parsed.channel for parsed in parse_names(["t", "motor_position", "torque"])]
    ['time', 'position', 'torque']
    """
    parsed = [parse_name(name) for name in names]
    if {"position", "velocity"} & {p.channel for p in parsed}:
        return parsed
    joint = dict(zip(MOTOR, ("position", "velocity"), strict=True))
    return [
        replace(p, channel=joint[p.channel], rank=3) if p.channel in joint else p for p in parsed
    ]


def _without_qualifiers(stem: str) -> tuple[str | None, bool]:
    """A name without the words of `_QUALIFIERS` and `_SECOND`, and whether it had one of these.

    None where it has none of them. ``act_pos_mot_deg`` is ``pos_deg``, and so are ``posAct_deg``
    and ``Pos actual value [deg]``.
    """
    words = [part for word in re.split(r"[_\s]+", stem) for part in _parts(word)]
    kept = [word for word in words if word.casefold() not in _QUALIFIERS | _SECOND]
    if len(kept) == len(words) or not kept:
        return None, False
    return "_".join(kept), any(word.casefold() in _SECOND for word in words)


def _parts(word: str) -> list[str]:
    """A word in parts that begin with capitals, if one of them qualifies: not ``mNm``."""
    parts = re.split(r"(?<=[a-z])(?=[A-Z])", word)
    return parts if any(p.casefold() in _QUALIFIERS | _SECOND for p in parts) else [word]


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
    # position_j1, axis2_current_A
    match = re.fullmatch(r"(?:(.+)_)?(?:joint|axis|j)_?(\d{1,2})(?:[_.](.+))?", name, re.IGNORECASE)
    if match and (match.group(1) or match.group(3)):
        stems.append(("_".join(filter(None, match.group(1, 3))), match.group(2)))
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
            unit = _unit_of_words(parts[-count:], CHANNELS[channel])
            if unit is not None:
                return channel, unit, _key(head) == _key(channel)
    return None


def _unit_of_words(words: Sequence[str], dimensions: tuple[str, ...] | None = None) -> Unit | None:
    """The unit that the last words of a name spell: ``mm_s`` is mm/s."""
    text = "_".join(words)
    per_second = re.sub(r"_(?=s2?$)", "/", text)
    return find_unit(per_second, dimensions) or find_unit(text, dimensions)


def file_unit(name: str) -> Unit | None:
    """Return the unit a column's name carries, whatever the column measures."""
    bracket = _unit_at_end(name)
    if bracket is not None:
        return find_unit(bracket[1])
    for stem, _ in _stems(name):
        parts = stem.split("_")
        for count in (3, 2, 1):
            if count < len(parts):
                text = "_".join(parts[-count:])
                # A single letter may mean anything, except these.
                unit = _unit_of_words(parts[-count:])
                if unit is not None and (len(text) > 1 or text in "smNVA%KC"):
                    return unit
    return None


def unknown_unit(name: str) -> str | None:
    """What stands in brackets at the end of a name, if it is no unit that is known.

    Examples
    --------
    >>> unknown_unit("force (kip)"), unknown_unit("force (kN)"), unknown_unit("force")
    ('kip', None, None)
    """
    bracket = _unit_at_end(name)
    return None if bracket is None or find_unit(bracket[1]) is not None else bracket[1]


def wide_groups(names: Sequence[str]) -> dict[str, dict[str, str]]:
    """Return, per channel, joint index -> column, for channels that come in several joints.

    Reference and motor channels are left out: a joint is chosen by what was measured at it.
    """
    groups: dict[str, dict[str, str]] = {}
    # The best name of a channel comes first; those of one rank stay in the order of the file.
    for parsed in sorted(parse_names(names), key=lambda p: p.rank):
        if parsed.channel in BESIDE:
            continue
        if parsed.channel is not None and parsed.index is not None:
            groups.setdefault(parsed.channel, {}).setdefault(parsed.index, parsed.name)
    return {channel: columns for channel, columns in groups.items() if len(columns) > 1}


def any_index(name: str) -> str | None:
    """The joint index at the end of a column's name, whatever it measures (``i_A_2``)."""
    match = re.search(r"[^\d](\d{1,2})[\])]?$", name)
    return match.group(1) if match else None


def same_of_joint(names: Sequence[str], column: str) -> dict[str, str]:
    """Joint index -> column, for the columns of other joints that are otherwise named alike.

    Examples
    --------
    >>> same_of_joint(["t", "q_1", "q_2", "dq_2"], "q_1")
    {'2': 'q_2'}
    >>> same_of_joint(["arm_1_joint_position", "arm_2_joint_position"], "arm_1_joint_position")
    {'2': 'arm_2_joint_position'}
    """
    # Of several numbers the last one that differs between columns is that of the joint.
    for number in reversed(list(re.finditer(r"(?<!\d)\d{1,2}(?!\d)", column))):
        stem, tail = column[: number.start()], column[number.end() :]
        alike = re.compile(f"{re.escape(stem)}(\\d{{1,2}}){re.escape(tail)}")
        found = {m.group(1): name for name in names if (m := alike.fullmatch(name))}
        found.pop(number.group(), None)
        if found:
            return found
    return {}
