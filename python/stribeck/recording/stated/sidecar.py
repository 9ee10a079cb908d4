"""The sidecar: a small TOML file with what the columns of a recording do not say."""

from __future__ import annotations

import hashlib
import os
import re
from dataclasses import dataclass, field
from pathlib import Path

from stribeck.base.errors import RecordingError, nearest
from stribeck.base.replaceable import check_regular
from stribeck.base.toml import TomlText
from stribeck.recording.stated.options import TABLE, FilePath, Limit, check_limit

__all__ = ["Sidecar", "find_sidecar", "read_sidecar", "sidecar_hash"]

#: Numbers, and what each must be: those of the options, and those that only a sidecar gives.
_NUMBERS: dict[str, Limit] = {
    **{entry.name: entry.limit for entry in TABLE if entry.kind == "number"},
    "screw_pitch": "above zero",
    "gravity_cos": "any",
    "gravity_sin": "any",
    "gravity": "any",
}
_TEXTS = (
    "kind",
    "columns",
    "joint_kind",
    "where",
    "average",
    "rows",
    "joint",
    "effort_unit",
    "drive",
    "torque_at",
    "note",
)
_SWITCHES = tuple(entry.name for entry in TABLE if entry.kind == "switch" and entry.command_line)
_TABLES = ("units", "map", "derive")
#: ``[joints.NAME]``: numbers of one joint of a file that holds several.
_JOINTS = "joints"

#: What TOML gives.
Toml = dict[str, object]


@dataclass(frozen=True)
class Sidecar:
    """What a sidecar says; every field may be empty."""

    path: str | None = None
    numbers: dict[str, float] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    map: dict[str, str] = field(default_factory=dict)
    derive: dict[str, str] = field(default_factory=dict)
    joints: dict[str, dict[str, float]] = field(default_factory=dict)
    switches: dict[str, bool] = field(default_factory=dict)


def find_sidecar(path: FilePath) -> Path | None:
    """Return the sidecar beside a recording (``FILE.EXT.sidecar.toml``), if there is one."""
    beside = Path(f"{path}.sidecar.toml")
    return beside if os.path.isfile(beside) else None


def sidecar_hash(path: FilePath, named: FilePath | None = None) -> str | None:
    """SHA-256 of the sidecar of a recording, `named` or beside it; None where it has none."""
    beside = Path(named) if named is not None else find_sidecar(path)
    return None if beside is None else hashlib.sha256(beside.read_bytes()).hexdigest()


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


def read_sidecar(path: FilePath) -> Sidecar:
    """Read and check a sidecar.

    Raises
    ------
    RecordingError
        It is missing, is not TOML or of the wrong kind, or has an unknown key or a bad value.
    """
    name = str(path)
    page = _Page(name, _text(name))
    page.check_keys()
    tables = {key: page.text_table(key) for key in _TABLES}
    return Sidecar(
        name,
        page.numbers(page.content, None),
        page.texts(),
        tables["units"],
        tables["map"],
        tables["derive"],
        page.joints(),
        page.switches(),
    )


def _text(name: str) -> str:
    check_regular(name, RecordingError)
    try:
        return Path(name).read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise RecordingError(f"{name}: no such sidecar") from None
    except UnicodeDecodeError:
        raise RecordingError(f"{name}: the sidecar is not UTF-8 text") from None
    except OSError as error:
        raise RecordingError(
            f"{name}: the sidecar cannot be read ({error.strerror or error})"
        ) from None


class _Page:
    """A sidecar while it is checked."""

    def __init__(self, name: str, text: str) -> None:
        self.name = name
        self.text = text
        self.content = TomlText(Path(name), text, RecordingError).parsed()

    def stop(self, problem: str, key: str, table: str | None = None) -> RecordingError:
        """The error about a key, with its line."""
        return RecordingError(f"{self.name}, {_line(self.text, key, table)}: {problem}")

    def check_keys(self) -> None:
        """Refuse unknown keys and files that are no sidecars."""
        known = (*_TEXTS, *_SWITCHES, *_NUMBERS, *_TABLES, _JOINTS)
        for key in self.content:
            if key not in known:
                hint = nearest(key, known) or f"; the keys are {', '.join(known)}"
                raise self.stop(f"unknown key '{key}'{hint}", key)
        if self.content.get("kind") != "recording":
            there = "kind" in self.content
            where = _line(self.text, "kind") if there else "line 1"
            got = f"kind is {self.content['kind']!r}" if there else "there is no kind"
            raise RecordingError(f'{self.name}, {where}: {got}: a sidecar needs kind = "recording"')

    def texts(self) -> dict[str, str]:
        """The texts at the top."""
        texts: dict[str, str] = {}
        for key in _TEXTS:
            value = self.content.get(key)
            if key == "joint" and isinstance(value, int):
                value = str(value)
            if key in self.content:
                if not isinstance(value, str):
                    raise self.stop(f"{key} must be a text, not {value!r}", key)
                texts[key] = value
        return texts

    def switches(self) -> dict[str, bool]:
        """What is switched on or off."""
        switches: dict[str, bool] = {}
        for key in _SWITCHES:
            value = self.content.get(key, False)
            if not isinstance(value, bool):
                raise self.stop(f"{key} must be true or false, not {value!r}", key)
            switches[key] = value
        return switches

    def text_table(self, key: str) -> dict[str, str]:
        """A table of texts."""
        table = self.content.get(key, {})
        if not isinstance(table, dict):
            raise self.stop(f"{key} must be a table: write [{key}]", key)
        for inner, value in table.items():
            if not isinstance(value, str):
                raise self.stop(f"{key}.{inner} must be a text, not {value!r}", inner, key)
        return dict(table)

    def numbers(self, content: Toml, table: str | None) -> dict[str, float]:
        """The numbers at the top, or in one of the tables."""
        numbers: dict[str, float] = {}
        for key, limit in _NUMBERS.items():
            if key not in content:
                continue
            value = content[key]
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                raise self.stop(f"{key} must be a finite number, not {value!r}", key, table)
            problem = check_limit(value, limit)
            if problem is not None:
                raise self.stop(f"{key} {problem}, it is {value!r}", key, table)
            numbers[key] = float(value)
        return numbers

    def joints(self) -> dict[str, dict[str, float]]:
        """The tables ``[joints.NAME]``."""
        tables = self.content.get(_JOINTS, {})
        if not isinstance(tables, dict):
            raise self.stop("joints must be tables: write [joints.NAME]", _JOINTS)
        joints: dict[str, dict[str, float]] = {}
        for joint, table in tables.items():
            where = f"{_JOINTS}.{joint}"
            if not isinstance(table, dict):
                raise self.stop(f"{where} must be a table: write [{where}]", joint, _JOINTS)
            for key in table:
                if key not in _NUMBERS:
                    hint = nearest(key, _NUMBERS) or f"; the keys are {', '.join(_NUMBERS)}"
                    raise self.stop(f"unknown key '{key}' of joint '{joint}'{hint}", key, where)
            joints[joint] = self.numbers(table, where)
        return joints
