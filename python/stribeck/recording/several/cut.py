"""A part of a recording: the samples for which a condition holds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stribeck.base.arguments import door
from stribeck.base.errors import RecordingError
from stribeck.recording.computed import apply_formulas
from stribeck.recording.readers import Source
from stribeck.recording.recording import Recording
from stribeck.recording.several.join import join
from stribeck.recording.several.part import Part

__all__ = ["where"]


@door(RecordingError, condition=("a condition", str))
def where(recording: Recording, condition: str) -> Recording:
    """The samples of a recording for which a condition holds; see `Recording.where`."""
    part = Part.of(recording, "")
    table = recording.to_frame()
    settings = replace(part.settings, where=condition, derive={}, units={})
    source = Source(recording.path, recording.sha256, table, 0)
    kept = apply_formulas(source, settings, None).row
    mask = np.zeros(table.height, dtype=bool)
    mask[kept] = True
    count = recording.rows - int(mask.sum())
    samples = "1 sample" if count == 1 else f"{count} samples"
    cut = part.kept(mask, f"{samples} removed by where: {condition}")
    hold_out = replace(cut.settings, hold_out=None)
    return join([replace(cut, settings=hold_out)], recording.path)
