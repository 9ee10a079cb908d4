"""What is known about a file: the options joined with its sidecar, checked before data are read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from stribeck.base.errors import RecordingError, nearest, option
from stribeck.recording.formats.door import Asked
from stribeck.recording.naming.names import CHANNELS
from stribeck.recording.stated.options import TABLE, FilePath, ReadOptions
from stribeck.recording.stated.sidecar import Sidecar, find_sidecar, read_sidecar

__all__ = ["Mechanics", "Settings", "gather"]

_KINDS = {
    "revolute": "revolute",
    "rotary": "revolute",
    "rotational": "revolute",
    "r": "revolute",
    "prismatic": "prismatic",
    "linear": "prismatic",
    "p": "prismatic",
}
_RIGID_BODY = ("inertia", "gravity_cos", "gravity_sin", "gravity")
_MOTOR = ("km", "kb", "kt", "screw_pitch", "gear_ratio", "torque_constant")
_ONE_OF = ("average", "rows", "drive", "torque_at")
_NUMBERS = tuple(entry.name for entry in TABLE if entry.kind == "number")
_CHOICES = {entry.name: entry.choices for entry in TABLE}


@dataclass(frozen=True)
class Mechanics:
    """What is known about a joint's drive and rigid body.

    Attributes
    ----------
    gear_ratio
        Motor turns per joint turn.
    torque_constant
        N m/A.
    screw_pitch
        m per turn.
    terms
        Rigid body: inertia, gravity_cos, gravity_sin, gravity, where known.
    motor
        Constants of motor and transmission, where known.
    """

    gear_ratio: float
    torque_constant: float | None
    screw_pitch: float | None
    terms: dict[str, float]
    motor: dict[str, float]

    @classmethod
    def of(cls, numbers: Mapping[str, float]) -> Mechanics:
        """Sort the numbers by what they are about."""
        return cls(
            gear_ratio=numbers.get("gear_ratio", 1.0),
            torque_constant=numbers.get("torque_constant"),
            screw_pitch=numbers.get("screw_pitch"),
            terms={name: numbers[name] for name in _RIGID_BODY if name in numbers},
            motor={name: numbers[name] for name in _MOTOR if name in numbers},
        )


@dataclass(frozen=True)
class Settings:
    """Everything that is known about a recording besides its data.

    Attributes
    ----------
    mechanics
        Of the joint that is read, or of all joints where they do not differ.
    joints
        Of each joint, where they differ.
    units, maps, derive
        Column -> unit, channel -> column, new column -> formula.
    sidecar
        Its path.
    rows
        Which samples are scored: ``"moving"`` or ``"all"``.
    weights
        Formula of the weights of the samples.
    torque_at
        Where the torque was measured: ``"motor"``, ``"command"`` or ``"link"``.
    moving_above
        Speed above which a sample moves, in the SI unit of the velocity.
    columns
        Names for the columns of a table without a header.
    memory_limit
        Largest table, GB; None: what the free memory allows.
    unwrap, trust
        Whether an uncertain wrap is undone, and contradictions between channels are accepted.
    """

    mechanics: Mechanics
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
    weights: str | None = None
    torque_at: str | None = None
    moving_above: float | None = None
    columns: tuple[str, ...] = ()
    memory_limit: float | None = None
    unwrap: bool = False
    trust: bool = False
    joints: dict[str, Mechanics] = field(default_factory=dict)

    @property
    def knows_torque_constant(self) -> bool:
        """Whether the current of every joint can be converted into a torque."""
        own = [joint.torque_constant for joint in self.joints.values()]
        return self.mechanics.torque_constant is not None or (bool(own) and None not in own)

    @property
    def asked(self) -> Asked:
        """What decides which of several tables of a file is read."""
        conditions = [text for text in (self.where, self.weights) if text is not None]
        return Asked(
            columns=self.columns,
            named=(*self.maps.values(), *self.units),
            formulas=(*self.derive.values(), *conditions),
            joint=self.joint,
            memory_limit=self.memory_limit,
        )

    def for_joint(self, joint: str | None) -> Settings:
        """What is known about one joint of a file that holds several."""
        own = self.mechanics if joint is None else self.joints.get(joint, self.mechanics)
        return replace(self, mechanics=own, joints={})


def gather(path: FilePath, options: ReadOptions) -> Settings:
    """Join the options with the sidecar; an option wins over the sidecar.

    Raises
    ------
    RecordingError
        The sidecar cannot be used, or an option has a bad value.
    """
    beside = options.sidecar if options.sidecar is not None else find_sidecar(path)
    sidecar = read_sidecar(beside) if beside is not None else Sidecar()
    kind = _joint_kind(options, sidecar)
    units = {**sidecar.units, **options.pairs("unit")}
    maps, derive = _columns(options, sidecar)
    if "effort_unit" in sidecar.texts and "torque" not in units:
        units["torque"] = sidecar.texts["effort_unit"]
    numbers = {name: options.number(name) for name in _NUMBERS}
    given = {name: value for name, value in numbers.items() if value is not None}
    texts = {name: _chosen(name, options, sidecar) for name in _ONE_OF}
    for channel in maps:
        if channel not in CHANNELS:
            hint = nearest(channel, CHANNELS) or f"; the names are {', '.join(CHANNELS)}"
            named = option("map", f"{channel}={maps[channel]}")
            raise RecordingError(f"{named}: unknown name '{channel}'{hint}")
    joint = options.joint
    return Settings(
        mechanics=Mechanics.of({**sidecar.numbers, **given}),
        joint=str(joint) if joint is not None else sidecar.texts.get("joint"),
        joint_kind=kind,
        units=units,
        maps=maps,
        derive=derive,
        where=options.where if options.where is not None else sidecar.texts.get("where"),
        average=texts["average"],
        sidecar=sidecar.path,
        drive=texts["drive"],
        hold_out=options.hold_out,
        rows=texts["rows"] or "moving",
        weights=options.weights,
        torque_at=texts["torque_at"],
        moving_above=given.get("moving_above", sidecar.numbers.get("moving_above")),
        columns=_names(options, sidecar),
        memory_limit=given.get("memory_limit", sidecar.numbers.get("memory_limit")),
        unwrap=options.unwrap or sidecar.switches.get("unwrap", False),
        trust=options.trust or sidecar.switches.get("trust", False),
        joints={
            name: Mechanics.of({**sidecar.numbers, **own, **given})
            for name, own in sidecar.joints.items()
        },
    )


def _joint_kind(options: ReadOptions, sidecar: Sidecar) -> str | None:
    kind = options.joint_kind if options.joint_kind is not None else sidecar.texts.get("joint_kind")
    if kind is None:
        return None
    known = _KINDS.get(kind.strip().lower())
    if known is None:
        hint = nearest(kind, _CHOICES["joint_kind"]) or ": it is revolute or prismatic"
        named = _named("joint_kind", kind, options.joint_kind is not None, sidecar)
        raise RecordingError(f"{named}: unknown kind of joint{hint}")
    return known


def _columns(options: ReadOptions, sidecar: Sidecar) -> tuple[dict[str, str], dict[str, str]]:
    """Mapped and derived columns; an option replaces what the sidecar says of the same channel."""
    maps, derive = options.pairs("map"), options.pairs("derive")
    kept = {
        channel: column
        for channel, column in sidecar.map.items()
        if channel not in derive or channel in maps
    }
    made = {
        channel: formula
        for channel, formula in sidecar.derive.items()
        if channel not in maps or channel in derive
    }
    return {**kept, **maps}, {**made, **derive}


def _names(options: ReadOptions, sidecar: Sidecar) -> tuple[str, ...]:
    """Names for the columns of a table without a header."""
    given = options.columns if options.columns is not None else sidecar.texts.get("columns")
    if given is None:
        return ()
    names = tuple(name.strip() for name in given.split(","))
    if not all(names) or len(set(names)) < len(names):
        shown = option("columns", ",".join(names)[:80])
        raise RecordingError(f"{shown}: give each column a name of its own, separated by commas")
    return names


def _chosen(name: str, options: ReadOptions, sidecar: Sidecar) -> str | None:
    """A text of which only some are accepted."""
    given: str | None = getattr(options, name)
    text = given if given is not None else sidecar.texts.get(name)
    if text is not None and text not in _CHOICES[name]:
        named = _named(name, text, given is not None, sidecar)
        raise RecordingError(f"{named}: unknown value; give {' or '.join(_CHOICES[name])}")
    return text


def _named(name: str, value: str, as_option: bool, sidecar: Sidecar) -> str:
    """A value as sentences name it: the option, or the key of the sidecar."""
    return option(name, value) if as_option else f"{sidecar.path}: {name} {value}"
