"""LabVIEW's TDMS files."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.arrays import Array
from stribeck.recording.formats.door import Asked, Entered, missing_library, short
from stribeck.recording.formats.names import with_unit
from stribeck.recording.formats.part import Part, Read, chosen, merged
from stribeck.recording.naming.names import parse_name

if TYPE_CHECKING:
    from nptdms import TdmsChannel, TdmsGroup

__all__ = ["read_tdms"]


def read_tdms(file: Entered, asked: Asked) -> Read:
    """The groups of a TDMS file; a waveform's channels get a time column from its step.

    Raises
    ------
    RecordingError
        The file is damaged or too large, or npTDMS is not installed.
    """
    try:
        import nptdms
    except ImportError:
        raise missing_library(file.name, "TDMS", "npTDMS") from None
    parts: list[Part] = []
    unread: list[str] = []
    said: list[str] = []
    try:
        with _said(said), file.open() as stream, nptdms.TdmsFile.open(stream) as content:
            groups = content.groups()
            channels = [channel for group in groups for channel in group.channels()]
            file.check_columns([channel.name for channel in channels])
            file.refuse_above(8 * sum(map(len, channels)), "what the channels hold")
            names = Counter(channel.name for channel in channels)
            for group in groups:
                parts += _parts(group, names, unread)
    except RecordingError:
        raise
    except Exception as error:  # the library raises many kinds on damaged files
        raise file.damaged("TDMS", error, "copy it again") from None
    read = chosen(file, merged(parts), asked)
    notes = (*read.notes, *dict.fromkeys(said))
    if unread:
        notes = (*notes, f"not read, no columns of numbers: {', '.join(unread[:6])}")
    return Read(read.table, notes)


@contextmanager
def _said(notes: list[str]) -> Iterator[None]:
    """Keep the library's warnings (a recording that was not closed) for the notes."""

    class Keep(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            notes.append(short(record.getMessage()))

    log = logging.getLogger("nptdms.reader")
    keep, others, propagate = Keep(), log.handlers[:], log.propagate
    log.handlers, log.propagate = [keep], False
    try:
        yield
    finally:
        log.handlers, log.propagate = others, propagate


def _parts(group: TdmsGroup, names: Counter[str], unread: list[str]) -> list[Part]:
    """The channels of a group, those of one length and step together.

    A name that another group has too is preceded by the group's.
    """
    found: dict[tuple[Any, ...], dict[str, Array]] = {}
    for channel in group.channels():
        if not len(channel):
            continue
        values = channel[:]
        if values.dtype.kind not in "biufMUO":
            unread.append(channel.path)
            continue
        if values.dtype.kind == "O":
            values = values.astype(str)
        step, offset = _waveform(channel)
        columns = found.setdefault((len(channel), step, offset), {})
        unit = channel.properties.get("unit_string") or channel.properties.get("unit")
        name = with_unit(channel.name, str(unit) if unit else None)
        columns[name if names[channel.name] == 1 else f"{group.name}.{name}"] = values
    parts = []
    for (rows, step, offset), columns in found.items():
        clock = None
        if step and not any(parse_name(name).channel == "time" for name in columns):
            clock = "time"
            columns = {clock: offset + step * np.arange(rows), **columns}
        parts.append(Part(group.name, pl.DataFrame(columns), clock))
    return parts


def _waveform(channel: TdmsChannel) -> tuple[float, float]:
    """Step and first time [s] of a waveform; a step of 0 where the channel is none."""
    try:
        step = float(channel.properties.get("wf_increment", 0.0))
        return step, float(channel.properties.get("wf_start_offset", 0.0))
    except (TypeError, ValueError):
        return 0.0, 0.0
