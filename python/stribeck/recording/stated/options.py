"""The options that say how a file is read, stated once.

Python takes them as keyword arguments (`ReadArguments`), the command line as flags made from the
same table (`TABLE`), and project files keep them in ``[reading]``.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Literal, TypedDict, cast

from stribeck.base.checks import shown
from stribeck.base.errors import RecordingError, nearest, option

__all__ = [
    "TABLE",
    "Entry",
    "Limit",
    "Pairs",
    "ReadArguments",
    "ReadOptions",
    "check_limit",
    "split_pairs",
]

#: ``"NAME=VALUE"`` texts, one of them, or a mapping.
Pairs = Sequence[str] | Mapping[str, str] | str
#: A file or folder.
FilePath = str | os.PathLike[str]
#: What a number must be besides finite.
Limit = Literal["any", "above zero", "not zero", "not negative"]


@dataclass(frozen=True)
class Entry:
    """One row of the table of options.

    Attributes
    ----------
    name
        In Python; the command line's flag is ``--name``, with hyphens.
    kind
        What is given.
    help
        One sentence for the command line's help.
    unit
        Of a number; several where it depends on the joint.
    limit
        What a number must be.
    choices
        The texts that are accepted; empty: any.
    form
        How a text or pair is written.
    command_line
        Whether the command line has a flag for it.
    """

    kind: Literal["text", "path", "number", "pairs", "switch"]
    help: str
    unit: str | None = None
    limit: Limit = "any"
    choices: tuple[str, ...] = ()
    form: str | None = None
    command_line: bool = True
    name: str = ""


def _text(help: str, choices: tuple[str, ...] = (), form: str | None = None) -> dict[str, Entry]:
    return {"entry": Entry("text", help, choices=choices, form=form)}


def _number(help: str, unit: str | None, limit: Limit) -> dict[str, Entry]:
    return {"entry": Entry("number", help, unit=unit, limit=limit)}


def _pairs(help: str, form: str) -> dict[str, Entry]:
    return {"entry": Entry("pairs", help, form=form)}


def _switch(help: str) -> dict[str, Entry]:
    return {"entry": Entry("switch", help)}


class ReadArguments(TypedDict, total=False):
    """The keyword arguments of `stribeck.read`, for type checkers and editors."""

    joint: str | None
    sidecar: FilePath | None
    columns: str | None
    map: Pairs
    derive: Pairs
    where: str | None
    average: str | None
    rows: str | None
    unit: Pairs
    joint_kind: str | None
    gear_ratio: float | None
    torque_constant: float | None
    screw_pitch: float | None
    inertia: float | None
    drive: str | None
    hold_out: str | None
    weights: str | None
    km: float | None
    kb: float | None
    kt: float | None
    torque_at: str | None
    moving_above: float | None
    memory_limit: float | None
    unwrap: bool
    trust: bool
    standstill: bool


@dataclass(frozen=True, kw_only=True)
class ReadOptions:
    """How a file is read, as given by the user; `stribeck.read` explains each option."""

    joint: str | None = field(
        default=None, metadata=_text("Which joint of a file that holds several.")
    )
    sidecar: FilePath | None = field(
        default=None, metadata={"entry": Entry("path", "Sidecar file (TOML).")}
    )
    columns: str | None = field(
        default=None,
        metadata=_text("Names for the columns of a table without a header.", form="NAME,NAME,..."),
    )
    map: Pairs = field(default=(), metadata=_pairs("Use COLUMN as NAME.", "NAME=COLUMN"))
    derive: Pairs = field(
        default=(), metadata=_pairs("Compute a column by a formula.", "NAME=FORMULA")
    )
    where: str | None = field(
        default=None, metadata=_text("Keep the samples for which it holds.", form="CONDITION")
    )
    average: str | None = field(
        default=None,
        metadata=_text("Steady-state points: the median of each run, or each row.", ("run", "row")),
    )
    rows: str | None = field(
        default=None,
        metadata=_text(
            "Samples that are scored: those that move (default), or all.", ("moving", "all")
        ),
    )
    unit: Pairs = field(default=(), metadata=_pairs("Unit of a file's column.", "COLUMN=UNIT"))
    joint_kind: str | None = field(
        default=None,
        metadata=_text(
            "Default: from the position's unit, else revolute.", ("revolute", "prismatic")
        ),
    )
    gear_ratio: float | None = field(
        default=None, metadata=_number("Motor turns per joint turn.", None, "not zero")
    )
    torque_constant: float | None = field(
        default=None, metadata=_number("Torque per current.", "N m/A", "above zero")
    )
    screw_pitch: float | None = field(
        default=None,
        metadata=_number(
            "Travel of a ball screw per turn: a torque in N m is the motor's, and becomes a force.",
            "m",
            "above zero",
        ),
    )
    inertia: float | None = field(
        default=None, metadata=_number("Known inertia or mass.", "kg m2 or kg", "not negative")
    )
    drive: str | None = field(
        default=None, metadata=_text("The effort is the voltage on a DC motor.", ("voltage",))
    )
    hold_out: str | None = field(
        default=None,
        metadata=_text(
            "Hold out by the values of a column of the file, not by time or run.",
            form="COLUMN[=VALUE]",
        ),
    )
    weights: str | None = field(
        default=None,
        metadata=_text(
            "Weight of each sample's squared error in a fit: a column, or a formula of columns "
            "('1/sigma^2').",
            form="FORMULA",
        ),
    )
    km: float | None = field(
        default=None, metadata=_number("Motor constant, for the energy.", "N m/W^0.5", "above zero")
    )
    kb: float | None = field(
        default=None,
        metadata=_number("Back-EMF constant, for the energy.", "V s/rad", "above zero"),
    )
    kt: float | None = field(
        default=None, metadata=_number("Torque constant, for the energy.", "N m/A", "above zero")
    )
    torque_at: str | None = field(
        default=None,
        metadata=_text(
            "Where the torque was measured: at the motor, commanded, or at the link.",
            ("motor", "command", "link"),
        ),
    )
    moving_above: float | None = field(
        default=None,
        metadata=_number(
            "Score the samples that are faster than this.", "rad/s or m/s", "not negative"
        ),
    )
    memory_limit: float | None = field(
        default=None,
        metadata=_number(
            "Largest table to read; default 4, or half of the free memory if that is less.",
            "GB",
            "above zero",
        ),
    )
    unwrap: bool = field(
        default=False, metadata=_switch("Unwrap a position that wraps, even if it is not certain.")
    )
    trust: bool = field(
        default=False,
        metadata=_switch("Go on where the channels contradict each other."),
    )
    standstill: bool = field(
        default=False,
        metadata={
            "entry": Entry("switch", "Accept a recording without motion.", command_line=False)
        },
    )

    @classmethod
    def of(cls, arguments: Mapping[str, object]) -> ReadOptions:
        """From keyword arguments of `stribeck.read`.

        Raises
        ------
        RecordingError
            There is no such option.
        """
        for name in arguments:
            if name not in _BY_NAME:
                raise RecordingError(
                    f"there is no {option(name)}{nearest(name, tuple(_BY_NAME))}; the options are "
                    f"{', '.join(_BY_NAME)}"
                )
        return cls(**cast(ReadArguments, arguments))

    def __post_init__(self) -> None:
        for entry in TABLE:
            value = getattr(self, entry.name)
            wrong = value is not None and (
                (entry.kind in ("text", "path") and not isinstance(value, str | os.PathLike))
                or (entry.kind == "switch" and not isinstance(value, bool))
                or (entry.kind == "pairs" and not _are_pairs(value))
            )
            if wrong:
                words = {"text": "a text", "path": "a path", "switch": "True or False"}
                form = entry.form or words[entry.kind]
                raise RecordingError(f"{option(entry.name)} is {shown(value)}: give {form}")

    def given(self) -> ReadArguments:
        """The options that are not at their default, as keyword arguments of `stribeck.read`.

        An inertia of 0 is not the default; an empty list is.
        """
        values = ((f.name, getattr(self, f.name), f.default) for f in fields(self))
        kept = {name: v for name, v, default in values if v != default and v not in ([], {})}
        return cast(ReadArguments, kept)

    def number(self, name: str) -> float | None:
        """A number that was given, checked.

        Raises
        ------
        RecordingError
            It is no number, not finite, or out of its limit.
        """
        given, entry = getattr(self, name), _BY_NAME[name]
        if given is None:
            return None
        try:
            value = math.nan if isinstance(given, bool) else float(given)
        except (TypeError, ValueError):
            given_as = option(name, given) if isinstance(given, str) else option(name)
            raise RecordingError(f"{given_as}: is not a number") from None
        problem = check_limit(value, entry.limit)
        if problem is not None:
            raise RecordingError(f"{option(name, value)}: {problem}")
        return value

    def pairs(self, name: str) -> dict[str, str]:
        """What was given as ``NAME=VALUE``, split.

        Raises
        ------
        RecordingError
            A text without ``=``, or with nothing on one side of it.
        """
        return split_pairs(name, getattr(self, name))


def _are_pairs(value: object) -> bool:
    if isinstance(value, str | Mapping):
        return True
    return isinstance(value, Iterable) and all(isinstance(item, str) for item in value)


#: Every option of `stribeck.read`, in the order of the command line's help.
TABLE: tuple[Entry, ...] = tuple(
    Entry(**{**vars(f.metadata["entry"]), "name": f.name}) for f in fields(ReadOptions)
)
_BY_NAME = {entry.name: entry for entry in TABLE}


def split_pairs(name: str, given: Pairs) -> dict[str, str]:
    """Split the ``NAME=VALUE`` texts of an option, or take a mapping."""
    if isinstance(given, Mapping):
        return {str(key): str(value) for key, value in given.items()}
    form = _BY_NAME[name].form or "NAME=VALUE"
    found: dict[str, str] = {}
    for item in [given] if isinstance(given, str) else given:
        # Columns may hold '=', and so do formulas: the split is next to the side that cannot.
        left, mark, value = item.rpartition("=") if name == "unit" else item.partition("=")
        if not mark or not left.strip() or not value.strip():
            raise RecordingError(f"{option(name, item)}: write {option(name, form)}")
        found[left.strip()] = value.strip()
    return found


def check_limit(value: float, limit: Limit) -> str | None:
    """What is wrong with a number; None where nothing is.

    Examples
    --------
    >>> check_limit(0.0, "above zero"), check_limit(0.0, "any")
    ('must be above zero', None)
    """
    if not math.isfinite(value):
        return "must be a finite number"
    if limit == "above zero" and value <= 0.0:
        return "must be above zero"
    if limit == "not zero" and value == 0.0:
        return "must not be zero"
    if limit == "not negative" and value < 0.0:
        return "must not be negative"
    return None
