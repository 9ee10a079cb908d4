"""A part of a recording: the samples for which a condition holds."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import polars as pl

from stribeck.base.arguments import door
from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Floats
from stribeck.recording.joint.units import current_of
from stribeck.recording.recording import Recording
from stribeck.recording.several.join import join
from stribeck.recording.several.part import Part
from stribeck.recording.tables.column_functions import Over
from stribeck.recording.tables.computed import apply_formulas
from stribeck.recording.tables.readers import Source

__all__ = ["where"]


@dataclass(frozen=True)
class _Read:
    """What a condition on a recording sees besides its table: the current, if there was one."""

    recording: Recording

    def over(
        self, table: pl.DataFrame, names: tuple[str, ...], where: str, notes: list[str]
    ) -> Over:
        """Refuse functions of all samples."""
        raise RecordingError(
            f"{where}: '{names[0]}' sees all samples of a file: give the condition to `read`, as "
            f"{option('where')}"
        )

    def channels(
        self, table: pl.DataFrame, names: tuple[str, ...], where: str, notes: list[str]
    ) -> dict[str, Floats]:
        """The current, [n]."""
        current = current_of(self.recording)
        for name in names:
            if name != "current" or current is None:
                raise RecordingError(
                    f"{where}: the recording has no channel '{name}'; it has "
                    f"{', '.join(table.columns)}"
                )
        return {} if current is None else dict.fromkeys(names, current)


@door(RecordingError, condition=("a condition", str))
def where(recording: Recording, condition: str) -> Recording:
    """The samples of a recording for which a condition holds; see `Recording.where`."""
    part = Part.of(recording, "")
    table = recording.to_frame()
    settings = replace(part.settings, where=condition, derive={}, units={})
    source = Source(recording.path, recording.sha256, table, 0)
    kept = apply_formulas(source, settings, _Read(recording)).row
    mask = np.zeros(table.height, dtype=bool)
    mask[kept] = True
    count = recording.rows - int(mask.sum())
    samples = "1 sample" if count == 1 else f"{count} samples"
    cut = part.kept(mask, f"{samples} removed by where: {condition}")
    hold_out = replace(cut.settings, hold_out=None)
    return join([replace(cut, settings=hold_out)], recording.path)
