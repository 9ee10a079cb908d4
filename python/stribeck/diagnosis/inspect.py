"""The columns of a file, and the effects that it can show."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.testable import Untestable, untestable
from stribeck.fitting.fit import fit
from stribeck.fitting.rigid_body import own_load
from stribeck.identify.scaling import rigid_body_terms
from stribeck.models.catalog import effect_ids
from stribeck.recording.load import read_with
from stribeck.recording.options import ReadArguments, ReadOptions
from stribeck.recording.recording import Column, Recording
from stribeck.recording.scan import Table, scan_with

if TYPE_CHECKING:
    from typing_extensions import Unpack

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Inspection:
    """The columns of a file, and what each of its joints can show.

    Attributes
    ----------
    recordings
        The joint that was read, or every joint of the file; empty where the file cannot be read
        as a recording (`problem` says what is missing).
    untestable
        Effects that none of these joints can show, by id.
    """

    table: Table
    recordings: tuple[Recording, ...]
    untestable: dict[str, Untestable]
    problem: str | None

    @property
    def testable(self) -> tuple[str, ...]:
        """Effects that the data can show."""
        if not self.recordings:
            return ()
        return tuple(effect for effect in effect_ids() if effect not in self.untestable)

    @property
    def notes(self) -> tuple[str, ...]:
        """How the columns were interpreted."""
        notes = [note for r in self.recordings for note in r.notes]
        return tuple(dict.fromkeys([*self.table.notes, *notes]))

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck inspect`."""
        columns = {name: _described(column) for name, column in self.table.channels.items()}
        for r in self.recordings[:1]:
            for name, column in r.columns.items():
                columns.setdefault(name, _described(column))
        made: dict[str, object] = {
            "rows": self.table.rows,
            "joints": list(self.table.joints),
            "runs": self.table.runs,
            "columns": columns,
            "rate_hz": self.table.rate_hz,
            "gaps": self.table.gaps,
            "testable": list(self.testable),
            "untestable": [row.to_dict() for row in self.untestable.values()],
            "notes": list(self.notes),
        }
        if len(self.recordings) == 1:
            made["scored"] = self.recordings[0].scored()
        if self.problem is not None:
            made["problem"] = self.problem
        return made


def _described(column: Column) -> dict[str, object]:
    return {
        "from": column.source,
        "unit": column.unit,
        "min": column.minimum,
        "max": column.maximum,
    }


def inspect(path: str, **reading: Unpack[ReadArguments]) -> Inspection:
    """Look at a file: columns, units, rate, gaps, ranges, and which effects it can show.

    Parameters
    ----------
    joint : str
        One joint of a file that holds several; default: all.
    **options
        As of `stribeck.read`.
    """
    options = ReadOptions(**reading)
    table = scan_with(path, options)
    if table.problem is not None:
        return Inspection(table, (), {}, table.problem)
    joint = options.joint
    names: list[str | None] = [joint] if joint is not None else [*table.joints] or [None]
    recordings = tuple(read_with(path, replace(options, joint=name)) for name in names)
    answers = [untestable(r, _load(r)) for r in recordings]
    common = {
        effect: answers[0][effect]
        for effect in answers[0]
        if all(effect in answer for answer in answers)
    }
    return Inspection(table, recordings, common, None)


def _load(recording: Recording) -> Array | None:
    """Load torque of the rigid body, array [n], identified where the recording does not give it."""
    if not rigid_body_terms(recording, ()):
        return None
    return own_load(fit("coulomb", recording).model, recording)
