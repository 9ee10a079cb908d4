"""One of several recordings that are joined: what was read of it, and how its checks ended."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.check import Check
from stribeck.recording.joint.channels import Channels, Layout
from stribeck.recording.recording import Column, Recording
from stribeck.recording.stated.settings import Settings

__all__ = ["Part", "joined_values"]


@dataclass(frozen=True)
class Part:
    """One of several recordings that are joined.

    Attributes
    ----------
    name
        Of its run, or before the names of its runs.
    path, files
        As sentences name it; path and SHA-256 of each of its files.
    values, columns
        The channels that were read, in SI units, and where they come from; arrays [n].
    sequence
        Rows of the file; a step of more than one is a gap, [n].
    trusted
        Whether contradictions between its channels are accepted.
    labels
        What its samples are held out by, [n], where a column is named.
    checker
        Checks the joined recording by the columns of the part, where the part alone cannot be
        checked.
    """

    name: str
    path: str
    files: tuple[tuple[str, str], ...]
    values: dict[str, Floats]
    columns: dict[str, Column]
    sequence: Ints
    layout: Layout
    settings: Settings
    torque_at: str | None
    notes: tuple[str, ...]
    checks: tuple[Check, ...]
    trusted: bool
    labels: pl.Series | None = None
    checker: Callable[[Recording], tuple[Check, ...]] | None = None

    @property
    def rows(self) -> int:
        """Number of samples."""
        return int(self.sequence.size)

    @property
    def run_names(self) -> list[str]:
        """The names of its runs beside those of others."""
        own = self.layout.run_names
        if not self.name:
            return list(own)
        return [self.name] if len(own) == 1 else [f"{self.name}/{run}" for run in own]

    @classmethod
    def of_channels(cls, data: Channels, layout: Layout, name: str, torque_at: str | None) -> Part:
        """A part of loaded channels, without checks."""
        return cls(
            name,
            data.path,
            ((data.path, data.prepared.source.sha256),),
            dict(data.values),
            dict(data.columns),
            data.sequence,
            layout,
            data.prepared.settings,
            torque_at,
            tuple(data.notes),
            tuple(data.doubts),
            data.prepared.settings.trust,
        )

    @classmethod
    def of(cls, recording: Recording, name: str) -> Part:
        """A part of a recording.

        Raises
        ------
        RecordingError
            It was not read from a file or table, or holds medians of runs.
        """
        origin = recording.origin
        if origin is None or recording.excerpt_of is not None:
            raise RecordingError(
                f"{recording.path}: was not read from a file or table, and cannot be joined or cut"
            )
        if origin.settings.average == "run":
            raise RecordingError(
                f"{recording.path}: holds medians of runs, which cannot be joined or cut: read the "
                "files together, as a list"
            )
        read = {channel: _read(recording, channel) for channel in origin.channels}
        values = {channel: column for channel, column in read.items() if column is not None}
        columns = {channel: recording.columns[channel] for channel in values}
        if recording.weight is not None and "weight" not in values:
            values["weight"] = recording.weight
            columns["weight"] = Column.of("weight", "given", "1", True, recording.weight)
        return cls(
            name,
            recording.path,
            origin.files,
            values,
            columns,
            np.arange(recording.rows) + recording.segment,
            Layout(
                recording.joint,
                recording.joint_kind,
                recording.torque_unit,
                recording.position_unit,
                recording.run,
                recording.run_names,
                recording.rows_dropped,
            ),
            origin.settings,
            recording.torque_at,
            origin.notes,
            recording.checks,
            recording.trusted,
        )

    def kept(self, mask: np.ndarray, note: str) -> Part:
        """The part without the samples where `mask` [n] is false, which become gaps."""
        runs = self.layout.run[mask]
        numbers, run = np.unique(runs, return_inverse=True)
        names = tuple(self.layout.run_names[k] for k in numbers)
        return replace(
            self,
            values={name: values[mask] for name, values in self.values.items()},
            sequence=self.sequence[mask],
            layout=replace(self.layout, run=run, run_names=names),
            notes=(*self.notes, note),
            labels=None if self.labels is None else self.labels.filter(pl.Series(mask)),
        )


def _read(recording: Recording, channel: str) -> Floats | None:
    """A channel as it was read; None where the recording has left it out."""
    values = getattr(recording, "torque" if channel == "friction_torque" else channel)
    return None if values is None else np.asarray(values, dtype=np.float64)


def joined_values(parts: Sequence[Part], channel: str) -> Floats:
    """A channel of all parts, one after the other."""
    return np.concatenate([part.values[channel] for part in parts])
