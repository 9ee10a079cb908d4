"""Whether several recordings are of the same joint, read alike."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from stribeck.base.errors import RecordingError, option
from stribeck.recording.several.part import Part

__all__ = ["check_agreement"]


class _Fact(NamedTuple):
    """Something that is the same in all files of a joint.

    Attributes
    ----------
    what
        As sentences name it.
    of
        Its value in one file; None: the file does not say it.
    must
        Whether a file that does not say it disagrees with one that does.
    do
        The remedy.
    """

    what: str
    of: Callable[[Part], object]
    must: bool
    do: str


def _number(name: str) -> Callable[[Part], object]:
    return lambda part: part.settings.mechanics.motor.get(name)


def _term(name: str) -> Callable[[Part], object]:
    return lambda part: part.settings.mechanics.terms.get(name)


def _option(name: str) -> str:
    return f"correct the sidecars, or say it for all of them with {option(name)}"


_FACTS = (
    _Fact("joint", lambda p: p.layout.joint, False, f"name one with {option('joint')}"),
    _Fact("joint kind", lambda p: p.layout.joint_kind, True, _option("joint_kind")),
    _Fact("unit of the torque", lambda p: p.layout.torque_unit, True, _option("unit")),
    _Fact("gear ratio", lambda p: p.settings.mechanics.gear_ratio, True, _option("gear_ratio")),
    _Fact("torque constant", _number("torque_constant"), False, _option("torque_constant")),
    *(_Fact(name, _number(name), False, _option(name)) for name in ("km", "kb", "kt")),
    _Fact("screw_pitch", _number("screw_pitch"), True, "correct the sidecars"),
    _Fact("inertia", _term("inertia"), True, _option("inertia")),
    *(
        _Fact(name, _term(name), True, "correct the sidecars")
        for name in ("gravity", "gravity_cos", "gravity_sin")
    ),
    _Fact("drive", lambda p: p.settings.drive, True, _option("drive")),
    _Fact("place of the torque", lambda p: p.torque_at, True, _option("torque_at")),
    _Fact("average", lambda p: p.settings.average, True, _option("average")),
    _Fact("rows", lambda p: p.settings.rows, True, _option("rows")),
    _Fact("moving_above", lambda p: p.settings.moving_above, True, _option("moving_above")),
)


def check_agreement(parts: Sequence[Part]) -> None:
    """Refuse parts that are not of the same joint, or not read alike.

    Raises
    ------
    RecordingError
        The first fact or channel in which two of them differ, with both files.
    """
    for fact in _FACTS:
        said = [(part, fact.of(part)) for part in parts]
        known = [(part, value) for part, value in said if fact.must or value is not None]
        for part, value in known[1:]:
            first, of_first = known[0]
            if value != of_first:
                raise RecordingError(
                    f"{part.path}: {fact.what} {_shown(value)}, but {_shown(of_first)} in "
                    f"{first.path}: files of one joint must agree; {fact.do}"
                )
    _check_channels(parts)


def _shown(value: object) -> str:
    if value is None:
        return "not given"
    return f"{value:g}" if isinstance(value, float) else f"'{value}'"


def _check_channels(parts: Sequence[Part]) -> None:
    """Refuse a channel that only some of the parts have."""
    channels = list(dict.fromkeys(channel for part in parts for channel in part.values))
    for channel in channels:
        having = [part for part in parts if channel in part.values]
        lacking = [part for part in parts if channel not in part.values]
        if not lacking:
            continue
        if channel == "weight":
            remedy = "weigh all samples or none"
        elif channel in ("torque", "friction_torque"):
            remedy = "read the same kind of torque from every file"
        else:
            leave = option("map", f"{channel}=none")
            remedy = f"name the column, or leave {channel} out of all with {leave}"
        raise RecordingError(
            f"{lacking[0].path}: there is no {channel}, which {having[0].path} has: {remedy}"
        )
