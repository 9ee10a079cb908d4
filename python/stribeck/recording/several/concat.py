"""Recordings that were read one by one, as the runs of one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

from stribeck.base.arguments import door
from stribeck.base.errors import RecordingError
from stribeck.recording.recording import Recording
from stribeck.recording.several.join import join
from stribeck.recording.several.part import Part
from stribeck.recording.several.paths import run_name

__all__ = ["Recordings", "as_one", "concat"]

#: One recording, or several that are runs of one joint.
Recordings: TypeAlias = Recording | Sequence[Recording]


@door(RecordingError, recordings=("a list of recordings", Sequence))
def concat(recordings: Sequence[Recording], names: Sequence[str] | None = None) -> Recording:
    """Join recordings of one joint: each is a run, as if they had been read together.

    Nothing is resampled: each run keeps its rate. Filters, noise and scored samples are found again
    for all of them.

    Parameters
    ----------
    names
        Name of each recording's run, in their order. Default: the name of its file where all
        differ, otherwise ``"1"``, ``"2"``, ... A recording with several runs gives ``name/run``.

    Raises
    ------
    RecordingError
        The recordings are not of one joint or not read alike; names that are not one for each, or
        not different.

    Examples
    --------
    >>> import numpy as np, stribeck as sb
    >>> t = np.arange(500) / 100.0
    >>> runs = [
    ...     sb.Recording.from_columns(time=t, velocity=k * np.sin(t), torque=np.sign(np.sin(t)))
    ...     for k in (1.0, 2.0)
    ... ]
    >>> sb.concat(runs, names=["slow", "fast"]).run_names
    ('slow', 'fast')
    """
    several = list(recordings)
    if not several:
        raise RecordingError("there is no recording to join: give at least one")
    for one in several:
        if not isinstance(one, Recording):
            raise _wrong(one)
    if len(several) == 1 and names is None:
        return several[0]
    named = _names(several, names)
    parts = [Part.of(one, name) for one, name in zip(several, named, strict=True)]
    # Blocks by a column of the file are found again from the files.
    parts = [replace(p, settings=replace(p.settings, hold_out=None)) for p in parts]
    first, count = several[0].path, len(several) - 1
    path = f"{first} and {count} more" if count else first
    return join(parts, path, standstill=not any(one.moving.any() for one in several))


def as_one(recording: Recordings) -> Recording:
    """A recording, or several joined.

    Raises
    ------
    RecordingError
        It is neither a recording nor a list of them.
    """
    if isinstance(recording, Recording):
        return recording
    if isinstance(recording, Sequence) and not isinstance(recording, str):
        return concat(recording)
    raise _wrong(recording)


def _wrong(given: object) -> RecordingError:
    what = f"'{given}'" if isinstance(given, str | Path | None) else f"a {type(given).__name__}"
    return RecordingError(
        f"{what} is not a recording: read it first, with `stribeck.read`, or give a list of "
        "recordings"
    )


def _names(recordings: Sequence[Recording], names: Sequence[str] | None) -> list[str]:
    """The name of each recording."""
    if names is None:
        named = [run_name(one.path) for one in recordings]
        different = len(set(named)) == len(named)
        return named if different else [str(k) for k in range(1, len(recordings) + 1)]
    named = [names] if isinstance(names, str) else [str(name) for name in names]
    if len(named) != len(recordings) or len(set(named)) != len(named):
        raise RecordingError(
            f"{len(recordings)} recordings and the names {', '.join(named) or 'none'}: give a name "
            "of its own to each"
        )
    return named
