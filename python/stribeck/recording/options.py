"""What the user said about a file: flags over sidecar, checked before the data are touched."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import RecordingError, nearest
from .columns import CHANNELS
from .sidecar import Sidecar, find_sidecar, read_sidecar

__all__ = ["Options", "gather"]

_KINDS = {
    "revolute": "revolute", "rotary": "revolute", "rotational": "revolute", "r": "revolute",
    "prismatic": "prismatic", "linear": "prismatic", "p": "prismatic",
}  # fmt: skip

Pairs = Sequence[str] | Mapping[str, str] | str


@dataclass(frozen=True)
class Options:
    """Everything said about a recording."""

    joint: str | None
    joint_kind: str | None
    gear_ratio: float
    torque_constant: float | None
    screw_pitch: float | None
    terms: dict[str, float]  # rigid body: inertia, gravity_cos, gravity_sin, gravity
    motor: dict[str, float]
    units: dict[str, str]
    maps: dict[str, str]
    derive: dict[str, str]
    where: str | None
    average: str | None
    sidecar: str | None


def _pairs(said: Pairs, flag: str, right: str, *, last: bool = False) -> dict[str, str]:
    """Split ``NAME=VALUE`` texts (or take a mapping)."""
    if isinstance(said, Mapping):
        return {str(key): str(value) for key, value in said.items()}
    found: dict[str, str] = {}
    for item in [said] if isinstance(said, str) else said:
        # Column names may hold '=', formulas do: the side that cannot is where the split is.
        left, mark, value = item.rpartition("=") if last else item.partition("=")
        if not mark or not left.strip() or not value.strip():
            raise RecordingError(f"{flag} {item}: write {flag} {right}")
        found[left.strip()] = value.strip()
    return found


def _number(value: float | None, flag: str, *, positive: bool) -> float | None:
    if value is None:
        return None
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise RecordingError(f"{flag} {value}: is not a number") from None
    if not math.isfinite(number) or (positive and number <= 0.0):
        raise RecordingError(
            f"{flag} {value}: must be a finite number{' above zero' if positive else ''}"
        )
    return number


def gather(
    path: str | Path,
    *,
    sidecar: str | Path | None,
    joint: str | None,
    joint_kind: str | None,
    gear_ratio: float | None,
    torque_constant: float | None,
    inertia: float | None,
    unit: Pairs,
    map: Pairs,
    derive: Pairs,
    where: str | None,
    average: str | None,
) -> Options:
    """Join the flags with the sidecar; a flag wins over what the sidecar says."""
    beside = sidecar if sidecar is not None else find_sidecar(path)
    said = read_sidecar(beside) if beside is not None else Sidecar()
    kind = joint_kind if joint_kind is not None else said.texts.get("joint_kind")
    if kind is not None:
        if kind.strip().lower() not in _KINDS:
            hint = nearest(kind, ("revolute", "prismatic")) or ": it is revolute or prismatic"
            source = "--joint-kind" if joint_kind is not None else f"{said.path}: joint_kind"
            raise RecordingError(f"{source} {kind}: unknown kind of joint{hint}")
        kind = _KINDS[kind.strip().lower()]
    units = {**said.units, **_pairs(unit, "--unit", "COLUMN=UNIT", last=True)}
    maps = {**said.map, **_pairs(map, "--map", "NAME=COLUMN")}
    formulas = {**said.derive, **_pairs(derive, "--derive", "NAME=FORMULA")}
    # A flag that maps or derives a channel replaces what the sidecar says of the same channel.
    for channel in _pairs(map, "--map", "NAME=COLUMN"):
        if channel in said.derive and channel not in _pairs(derive, "--derive", "NAME=FORMULA"):
            formulas.pop(channel, None)
    for channel in _pairs(derive, "--derive", "NAME=FORMULA"):
        if channel in said.map and channel not in _pairs(map, "--map", "NAME=COLUMN"):
            maps.pop(channel, None)
    if "effort_unit" in said.texts and "torque" not in units:
        units["torque"] = said.texts["effort_unit"]
    ratio = _number(gear_ratio, "--gear-ratio", positive=False)
    if ratio is None:
        ratio = said.numbers.get("gear_ratio", 1.0)
    if ratio == 0.0:
        raise RecordingError("--gear-ratio 0: must not be zero")
    constant = _number(torque_constant, "--torque-constant", positive=True)
    if constant is None:
        constant = said.numbers.get("torque_constant")
    terms: dict[str, float] = {
        key: said.numbers[key]
        for key in ("inertia", "gravity_cos", "gravity_sin", "gravity")
        if key in said.numbers
    }
    moved = _number(inertia, "--inertia", positive=False)
    if moved is not None:
        if moved < 0.0:
            raise RecordingError(f"--inertia {inertia}: must not be negative")
        terms["inertia"] = moved
    motor: dict[str, float] = {
        key: said.numbers[key] for key in ("km", "kb", "kt", "screw_pitch") if key in said.numbers
    }
    if ratio != 1.0:
        motor["gear_ratio"] = ratio
    if constant is not None:
        motor["torque_constant"] = constant
    one_per = average if average is not None else said.texts.get("average")
    if one_per is not None and one_per != "run":
        raise RecordingError(f"--average {one_per}: only 'run' can be averaged over")
    for channel in maps:
        if channel not in CHANNELS:
            hint = nearest(channel, CHANNELS) or f"; the names are {', '.join(CHANNELS)}"
            raise RecordingError(f"--map {channel}={maps[channel]}: unknown name '{channel}'{hint}")
    return Options(
        joint=str(joint) if joint is not None else said.texts.get("joint"),
        joint_kind=kind,
        gear_ratio=ratio,
        torque_constant=constant,
        screw_pitch=said.numbers.get("screw_pitch"),
        terms=terms,
        motor=motor,
        units=units,
        maps=maps,
        derive=formulas,
        where=where if where is not None else said.texts.get("where"),
        average=one_per,
        sidecar=said.path,
    )
