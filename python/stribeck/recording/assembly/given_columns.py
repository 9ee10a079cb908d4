"""`Recording.from_columns`: arrays, each given as the channel that it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from stribeck.base.arguments import door
from stribeck.base.errors import RecordingError, nearest
from stribeck.recording.assembly.assemble import build
from stribeck.recording.assembly.one import one_joint
from stribeck.recording.naming.names import CHANNELS
from stribeck.recording.recording import Recording
from stribeck.recording.stated.options import ReadOptions
from stribeck.recording.tables.in_memory import columns_source

__all__ = ["from_columns"]

_OPTIONS = frozenset(field.name for field in fields(ReadOptions)) - {"unit", "map", "sidecar"}


@door(RecordingError)
def from_columns(units: Mapping[str, str] | None, given: Mapping[str, Any]) -> Recording:
    """A recording of arrays; see `Recording.from_columns`."""
    columns: dict[str, object] = {}
    options: dict[str, Any] = {}
    for name, values in given.items():
        # A text names the joint to read; an array is the joint of each sample.
        if name in _OPTIONS and (name not in CHANNELS or isinstance(values, str | int)):
            options[name] = values
        elif name in CHANNELS:
            if values is not None:
                columns[name] = values
        else:
            known = (*CHANNELS, *sorted(_OPTIONS))
            hint = nearest(name, known) or f"; the channels are {', '.join(CHANNELS)}"
            raise RecordingError(f"'{name}' is neither a channel nor an option of reading{hint}")
    for name in units or {}:
        if name not in columns:
            hint = nearest(name, columns) or f"; given are {', '.join(columns)}"
            raise RecordingError(f"units: there is no column '{name}'{hint}")
    joint = options.pop("joint", None)
    if joint is not None and "joint" not in columns:
        columns["joint"] = [str(joint)] * _length(columns)
    read = ReadOptions(
        **options, unit=dict(units or {}), joint=None if joint is None else str(joint)
    )
    return build(*one_joint(columns_source(columns), read), standstill=read.standstill)


def _length(columns: Mapping[str, Any]) -> int:
    return next((len(values) for values in columns.values()), 0)
