"""What the user said about a file: flags over sidecar, checked before the data are touched."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from stribeck.base.errors import RecordingError, nearest
from stribeck.recording.columns import CHANNELS
from stribeck.recording.sidecar import Sidecar, find_sidecar, read_sidecar

__all__ = ["DRIVES", "Mechanics", "Options", "gather"]

_KINDS = {
    "revolute": "revolute", "rotary": "revolute", "rotational": "revolute", "r": "revolute",
    "prismatic": "prismatic", "linear": "prismatic", "p": "prismatic",
}  # fmt: skip

#: What `torque` may be of a motor that is not driven by its torque or current.
DRIVES = ("voltage",)

#: What makes a steady-state point: the median of a run, or a row, which is one already.
AVERAGES = ("run", "row")
#: Which rows count: those that move, or all of them.
SCORED = ("moving", "all")

Pairs = Sequence[str] | Mapping[str, str] | str


@dataclass(frozen=True)
class Mechanics:
    """What was said about a joint's drive and rigid body."""

    gear_ratio: float
    torque_constant: float | None
    screw_pitch: float | None
    terms: dict[str, float]  # rigid body: inertia, gravity_cos, gravity_sin, gravity
    motor: dict[str, float]


@dataclass(frozen=True)
class Options(Mechanics):
    """Everything said about a recording."""

    joint: str | None
    joint_kind: str | None
    units: dict[str, str]
    maps: dict[str, str]
    derive: dict[str, str]
    where: str | None
    average: str | None
    sidecar: str | None
    drive: str | None = None
    hold_out: str | None = None
    rows: str = "moving"
    joints: dict[str, Mechanics] = field(default_factory=dict)  # where they differ by joint

    @property
    def knows_torque_constant(self) -> bool:
        """Whether a current can be turned into a torque, whichever joint it is of."""
        own = [joint.torque_constant for joint in self.joints.values()]
        return self.torque_constant is not None or (bool(own) and None not in own)

    def for_joint(self, joint: str | None) -> Options:
        """What was said about one joint of a file that holds several."""
        own = self if joint is None else self.joints.get(joint, self)
        return replace(
            self, gear_ratio=own.gear_ratio, torque_constant=own.torque_constant,
            screw_pitch=own.screw_pitch, terms=own.terms, motor=own.motor, joints={},
        )  # fmt: skip


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
    km: float | None,
    kb: float | None,
    kt: float | None,
    unit: Pairs,
    map: Pairs,
    derive: Pairs,
    where: str | None,
    average: str | None,
    drive: str | None = None,
    hold_out: str | None = None,
    rows: str | None = None,
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
    flags = {
        "gear_ratio": _number(gear_ratio, "--gear-ratio", positive=False),
        "torque_constant": _number(torque_constant, "--torque-constant", positive=True),
        "inertia": _number(inertia, "--inertia", positive=False),
        "km": _number(km, "--km", positive=True),
        "kb": _number(kb, "--kb", positive=True),
        "kt": _number(kt, "--kt", positive=True),
    }
    if flags["gear_ratio"] == 0.0:
        raise RecordingError("--gear-ratio 0: must not be zero")
    if flags["inertia"] is not None and flags["inertia"] < 0.0:
        raise RecordingError(f"--inertia {inertia}: must not be negative")
    given = {name: value for name, value in flags.items() if value is not None}
    one_per = average if average is not None else said.texts.get("average")
    if one_per not in (None, *AVERAGES):
        raise RecordingError(f"--average {one_per}: only 'run' and 'row' make points")
    scored = rows if rows is not None else said.texts.get("rows", SCORED[0])
    if scored not in SCORED:
        raise RecordingError(f"--rows {scored}: it is {' or '.join(SCORED)}")
    driven = drive if drive is not None else said.texts.get("drive")
    if driven not in (None, *DRIVES):
        source = "--drive" if drive is not None else f"{said.path}: drive"
        raise RecordingError(f"{source} {driven}: unknown drive; it is {', '.join(DRIVES)}")
    for channel in maps:
        if channel not in CHANNELS:
            hint = nearest(channel, CHANNELS) or f"; the names are {', '.join(CHANNELS)}"
            raise RecordingError(f"--map {channel}={maps[channel]}: unknown name '{channel}'{hint}")
    common = _mechanics({**said.numbers, **given})
    return Options(
        gear_ratio=common.gear_ratio,
        torque_constant=common.torque_constant,
        screw_pitch=common.screw_pitch,
        terms=common.terms,
        motor=common.motor,
        joint=str(joint) if joint is not None else said.texts.get("joint"),
        joint_kind=kind,
        units=units,
        maps=maps,
        derive=formulas,
        where=where if where is not None else said.texts.get("where"),
        average=one_per,
        sidecar=said.path,
        drive=driven,
        hold_out=hold_out,
        rows=scored,
        joints={
            name: _mechanics({**said.numbers, **numbers, **given})
            for name, numbers in said.joints.items()
        },
    )


def _mechanics(numbers: Mapping[str, float]) -> Mechanics:
    """Sort what was said by what it is about."""

    def chosen(*names: str) -> dict[str, float]:
        return {name: numbers[name] for name in names if name in numbers}

    return Mechanics(
        gear_ratio=numbers.get("gear_ratio", 1.0),
        torque_constant=numbers.get("torque_constant"),
        screw_pitch=numbers.get("screw_pitch"),
        terms=chosen("inertia", "gravity_cos", "gravity_sin", "gravity"),
        motor=chosen("km", "kb", "kt", "screw_pitch", "gear_ratio", "torque_constant"),
    )
