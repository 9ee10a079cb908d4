"""The sidecar: a small TOML file that says about a recording what its columns cannot."""

from __future__ import annotations

import hashlib
import math
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from stribeck.base.errors import RecordingError, nearest

__all__ = ["Sidecar", "find_sidecar", "read_sidecar", "sidecar_hash"]

_NUMBERS = (
    "gear_ratio", "torque_constant", "km", "kb", "kt", "screw_pitch",
    "inertia", "gravity_cos", "gravity_sin", "gravity",
)  # fmt: skip
_TEXTS = (
    "kind", "joint_kind", "where", "average", "rows", "joint", "effort_unit", "drive", "note",
)  # fmt: skip
_TABLES = ("units", "map", "derive")
_JOINTS = "joints"  # [joints.NAME]: numbers of one joint of a file that holds several
_POSITIVE = ("torque_constant", "screw_pitch", "kt", "km", "kb")


@dataclass(frozen=True)
class Sidecar:
    """What a sidecar says; every field is optional."""

    path: str | None = None
    numbers: dict[str, float] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    map: dict[str, str] = field(default_factory=dict)
    derive: dict[str, str] = field(default_factory=dict)
    joints: dict[str, dict[str, float]] = field(default_factory=dict)


def find_sidecar(path: str | Path) -> Path | None:
    """Return the sidecar beside a recording (``FILE.EXT.sidecar.toml``), if there is one."""
    beside = Path(f"{path}.sidecar.toml")
    return beside if beside.is_file() else None


def sidecar_hash(path: str | Path, named: str | Path | None = None) -> str | None:
    """SHA-256 of the sidecar of a recording, `named` or beside it; None where it has none."""
    beside = Path(named) if named is not None else find_sidecar(path)
    return None if beside is None else hashlib.sha256(beside.read_bytes()).hexdigest()


def _parse(text: str) -> dict[str, Any]:
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(str(error)) from None


def _line(text: str, key: str, table: str | None = None) -> str:
    """Name the line a key stands on, as ``line 7``."""
    inside: str | None = None
    word = rf"""["']?{re.escape(key)}["']?"""
    for number, line in enumerate(text.splitlines(), start=1):
        header = re.match(r"\s*\[+\s*([^\]]+?)\s*\]+", line)
        if header:
            inside = header.group(1).strip("\"' ")
            if table is None and re.split(r"\s*\.\s*", inside)[0] == key:
                return f"line {number}"
        elif inside == table and re.match(rf"\s*{word}\s*[=.]", line):
            return f"line {number}"
    return f"key '{key}'"


def read_sidecar(path: str | Path) -> Sidecar:
    """Read and check a sidecar.

    Raises
    ------
    RecordingError
        When it is missing, not TOML, of the wrong kind, or has an unknown key or a bad value.
    """
    name = str(path)
    try:
        text = Path(path).read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise RecordingError(f"{name}: no such sidecar") from None
    except UnicodeDecodeError:
        raise RecordingError(f"{name}: the sidecar is not UTF-8 text") from None
    except OSError as error:
        raise RecordingError(
            f"{name}: the sidecar cannot be read ({error.strerror or error})"
        ) from None
    try:
        said = _parse(text)
    except ValueError as error:
        raise RecordingError(f"{name}: is not TOML: {error}") from None
    known = (*_TEXTS, *_NUMBERS, *_TABLES, _JOINTS)
    for key in said:
        if key not in known:
            hint = nearest(key, known) or f"; the keys are {', '.join(known)}"
            raise RecordingError(f"{name}, {_line(text, key)}: unknown key '{key}'{hint}")
    if said.get("kind") != "recording":
        where = _line(text, "kind") if "kind" in said else "line 1"
        got = f"kind is {said['kind']!r}" if "kind" in said else "there is no kind"
        raise RecordingError(f'{name}, {where}: {got}: a sidecar needs kind = "recording"')
    numbers = _numbers(name, text, said, None)
    texts: dict[str, str] = {}
    for key in _TEXTS:
        if key in said:
            if key == "joint" and isinstance(said[key], int):
                said[key] = str(said[key])
            if not isinstance(said[key], str):
                raise RecordingError(
                    f"{name}, {_line(text, key)}: {key} must be a text, not {said[key]!r}"
                )
            texts[key] = said[key]
    tables: dict[str, dict[str, str]] = {}
    for key in _TABLES:
        table = said.get(key, {})
        if not isinstance(table, dict):
            raise RecordingError(
                f"{name}, {_line(text, key)}: {key} must be a table: write [{key}]"
            )
        for inner, value in table.items():
            if not isinstance(value, str):
                raise RecordingError(
                    f"{name}, {_line(text, inner, key)}: {key}.{inner} must be a text, not "
                    f"{value!r}"
                )
        tables[key] = dict(table)
    joints = _joints(name, text, said)
    return Sidecar(name, numbers, texts, tables["units"], tables["map"], tables["derive"], joints)


def _numbers(name: str, text: str, said: dict[str, Any], table: str | None) -> dict[str, float]:
    """Check the numbers at the top of a sidecar, or in one of its tables."""
    numbers: dict[str, float] = {}
    for key in _NUMBERS:
        if key not in said:
            continue
        value = said[key]
        if (
            isinstance(value, bool)
            or not isinstance(value, (int, float))
            or not math.isfinite(value)
        ):
            raise RecordingError(
                f"{name}, {_line(text, key, table)}: {key} must be a finite number, not {value!r}"
            )
        if (key in _POSITIVE and value <= 0.0) or (key == "gear_ratio" and value == 0.0):
            raise RecordingError(
                f"{name}, {_line(text, key, table)}: {key} must be above zero, not {value!r}"
            )
        if key == "inertia" and value < 0.0:
            raise RecordingError(
                f"{name}, {_line(text, key, table)}: inertia must not be negative, it is {value!r}"
            )
        numbers[key] = float(value)
    return numbers


def _joints(name: str, text: str, said: dict[str, Any]) -> dict[str, dict[str, float]]:
    """Check the tables ``[joints.NAME]``."""
    tables = said.get(_JOINTS, {})
    if not isinstance(tables, dict):
        raise RecordingError(
            f"{name}, {_line(text, _JOINTS)}: joints must be tables: write [joints.NAME]"
        )
    joints: dict[str, dict[str, float]] = {}
    for joint, table in tables.items():
        where = f"{_JOINTS}.{joint}"
        if not isinstance(table, dict):
            raise RecordingError(
                f"{name}, {_line(text, joint, _JOINTS)}: {where} must be a table: write [{where}]"
            )
        for key in table:
            if key not in _NUMBERS:
                hint = nearest(key, _NUMBERS) or f"; the keys are {', '.join(_NUMBERS)}"
                raise RecordingError(
                    f"{name}, {_line(text, key, where)}: unknown key '{key}' of joint '{joint}'"
                    f"{hint}"
                )
        joints[joint] = _numbers(name, text, table, where)
    return joints
