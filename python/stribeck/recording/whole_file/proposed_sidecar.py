"""A sidecar that states how a recording is read, with what its checks and columns propose."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from stribeck.base.errors import RecordingError, option, spell_options
from stribeck.base.files import write_whole
from stribeck.base.units import SI
from stribeck.recording.check import Check
from stribeck.recording.naming.names import CHANNELS
from stribeck.recording.naming.proposals import Proposal
from stribeck.recording.recording import Recording
from stribeck.recording.stated.options import TABLE, ReadOptions
from stribeck.recording.stated.settings import Settings, gather
from stribeck.recording.whole_file.table import Prepared, prepare

__all__ = ["sidecar_text", "write_sidecar"]

_NUMBERS = tuple(entry.name for entry in TABLE if entry.kind == "number")
#: What a channel is replaced by if nothing is mapped to it.
_PAIRS = ("map", "units", "derive")


def write_sidecar(
    recording: Recording, options: ReadOptions, proposals: Iterable[Proposal] = ()
) -> Path:
    """Write the proposed sidecar beside a recording.

    Parameters
    ----------
    options
        That the recording was read with.
    proposals
        Columns that are not read; they are taken for channels that the recording lacks.

    Raises
    ------
    RecordingError
        There is a sidecar already; it is not replaced.
    """
    path = Path(f"{recording.path}.sidecar.toml")
    if path.exists():
        raise RecordingError(
            f"{path} exists and is not replaced: remove it, or read another one with "
            f"{option('sidecar', 'FILE')}"
        )
    write_whole(str(path), sidecar_text(recording, options, proposals))
    return path


def sidecar_text(
    recording: Recording, options: ReadOptions, proposals: Iterable[Proposal] = ()
) -> str:
    """The proposed sidecar as TOML, with what it changes as comments."""
    settings = gather(recording.path, options)
    prepared = prepare(recording.path, settings)
    tables = _as_read(prepared, recording)
    comments = _remedies(recording.checks, tables)
    comments += _proposed(proposals, tables)
    top = _top(recording, settings, options)
    lines = ["# Proposed by stribeck inspect: how the columns are read. Check every line."]
    lines += [f"# {comment}" for comment in comments]
    lines += [f"{key} = {json.dumps(value)}" for key, value in top.items()]
    for name in _PAIRS:
        if tables[name]:
            lines += ["", f"[{name}]"]
            lines += [f"{_key(k)} = {json.dumps(v)}" for k, v in tables[name].items()]
    return "\n".join(lines) + "\n"


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else json.dumps(name)


def _top(recording: Recording, settings: Settings, options: ReadOptions) -> dict[str, object]:
    """The keys before the tables."""
    top: dict[str, object] = {"kind": "recording", "joint_kind": recording.joint_kind}
    if settings.joint is not None:
        top["joint"] = settings.joint
    texts = {
        "where": settings.where,
        "average": settings.average,
        "drive": settings.drive,
        "torque_at": recording.torque_at,
    }
    top |= {key: value for key, value in texts.items() if value is not None}
    if settings.rows != "moving":
        top["rows"] = settings.rows
    numbers = {name: options.number(name) for name in _NUMBERS}
    known = {**settings.mechanics.terms, **settings.mechanics.motor}
    given = {**{k: v for k, v in numbers.items() if v is not None}, **known}
    top |= given
    if settings.unwrap:
        top["unwrap"] = True
    return top


def _as_read(prepared: Prepared, recording: Recording) -> dict[str, dict[str, str]]:
    """The tables that state what is read now."""
    tables: dict[str, dict[str, str]] = {name: {} for name in _PAIRS}
    tables["derive"].update(prepared.settings.derive)
    slides = recording.joint_kind == "prismatic"
    for channel, choice in prepared.choices.items():
        derived = choice.source in prepared.derived
        if not derived and choice.channel == channel:
            tables["map"][channel] = choice.source
        dimensions = CHANNELS[channel]
        if not dimensions or choice.channel != channel:
            continue
        assumed = SI[dimensions[1 if slides and len(dimensions) > 1 else 0]]
        tables["units"][choice.source] = assumed if choice.unit is None else choice.unit.name
    return tables


def _remedies(checks: Iterable[Check], tables: Mapping[str, dict[str, str]]) -> list[str]:
    """Enter the first remedy of each check that fails; returns what was done."""
    comments: list[str] = []
    for check in checks:
        if check.ok or check.do is None:
            continue
        first = re.split(r"; otherwise |, or ", check.do)[0]
        comments.append(f"{check.said}: {spell_options(check.do, _spelt)}")

        def take(name: str, value: str | None) -> str:
            if value is not None and "COLUMN" not in value:
                _enter(name, value, tables)
            return ""

        spell_options(first, take)
    return comments


def _spelt(name: str, value: str | None) -> str:
    return f"{name} {value}" if value is not None else name


def _enter(name: str, value: str, tables: Mapping[str, dict[str, str]]) -> None:
    """Enter an option that was proposed."""
    if name == "unit":
        column, _, unit = value.rpartition("=")
        tables["units"][column] = unit
    elif name == "map":
        channel, _, column = value.partition("=")
        tables["map"][channel] = column
        tables["derive"].pop(channel, None)
    elif name == "derive":
        channel, _, formula = value.partition("=")
        tables["derive"][channel] = formula
        tables["map"].pop(channel, None)


def _proposed(proposals: Iterable[Proposal], tables: Mapping[str, dict[str, str]]) -> list[str]:
    """Map columns that are not read to the channels that are missing; returns what was done."""
    comments = []
    for proposal in proposals:
        channel = proposal.channel
        taken = channel in tables["map"] or channel in tables["derive"]
        if taken or channel not in ("temperature", "acceleration", "position", "velocity"):
            continue
        tables["map"][channel] = proposal.column
        if proposal.unit is not None:
            tables["units"][proposal.column] = proposal.unit
        comments.append(f"'{proposal.column}' may be the {channel}: it is not read without this")
    return comments
