"""The columns of a file, and the effects that it can show."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError, RecordingError, option
from stribeck.base.shown import Shown
from stribeck.diagnosis.testable import Untestable, untestable
from stribeck.fitting.fit import fit
from stribeck.fitting.protocols.found import Protocol, found_protocols
from stribeck.fitting.transmission.measure import Transmission, measure_transmission
from stribeck.identify.left_out.rows import scored_rows
from stribeck.identify.scaling import rigid_body_terms
from stribeck.models.catalog import effect_ids
from stribeck.models.rigid_body import own_load
from stribeck.recording.assembly.assemble import nothing_moves
from stribeck.recording.check import Check
from stribeck.recording.load import Given, read_with
from stribeck.recording.naming.proposals import Proposal, propose
from stribeck.recording.recording import Column, Recording
from stribeck.recording.several.paths import listed_files, text_of
from stribeck.recording.several.scan import joined_table
from stribeck.recording.stated.options import ReadArguments, ReadOptions, split_pairs
from stribeck.recording.whole_file.proposed_sidecar import write_sidecar
from stribeck.recording.whole_file.scan import Table, scan_with

if TYPE_CHECKING:
    from typing_extensions import Unpack

Array = NDArray[np.float64]


@dataclass(frozen=True, repr=False)
class Inspection(Shown):
    """The columns of a file, and what each of its joints can show.

    Attributes
    ----------
    recordings
        The joint that was read, or every joint of the file; empty where the file cannot be read
        as a recording (`problem` says what is missing).
    untestable
        Effects that none of these joints can show, by id.
    proposed
        Columns that are not read, and the channel that each may hold.
    files
        Each file by itself, where there are several.
    transmissions
        Of the joints with two encoders, by name: the transmission, or why it cannot be measured.
    protocols
        Test-bench protocols that were found, by joint.
    """

    table: Table
    recordings: tuple[Recording, ...]
    untestable: dict[str, Untestable]
    problem: str | None
    proposed: tuple[Proposal, ...] = ()
    files: tuple[Table, ...] = ()
    transmissions: dict[str, Transmission | str] = field(default_factory=dict)
    protocols: dict[str, tuple[Protocol, ...]] = field(default_factory=dict)

    @property
    def testable(self) -> tuple[str, ...]:
        """Effects that the data can show."""
        if not self.recordings or self.problem is not None:
            return ()
        return tuple(effect for effect in effect_ids() if effect not in self.untestable)

    @property
    def notes(self) -> tuple[str, ...]:
        """How the columns were interpreted."""
        notes = [note for r in self.recordings for note in r.notes]
        return tuple(dict.fromkeys([*self.table.notes, *notes]))

    @property
    def checks(self) -> tuple[Check, ...]:
        """Whether the channels of the joints agree with each other."""
        return tuple(dict.fromkeys(check for r in self.recordings for check in r.checks))

    def to_dict(self, spell: Callable[[str], str] = str) -> dict[str, object]:
        """The JSON of `stribeck inspect`; `spell` writes the options in its sentences."""
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
            "checks": [
                {k: spell(v) if isinstance(v, str) else v for k, v in check.to_dict().items()}
                for check in self.checks
            ],
            "proposed": [row.to_dict() for row in self.proposed],
        }
        if self.files:
            made["files"] = [
                {"file": t.path, "rows": t.rows, "rate_hz": t.rate_hz, "gaps": t.gaps}
                for t in self.files
            ]
        made["protocols"] = [
            {"joint": name, **protocol.to_dict()}
            for name, found in self.protocols.items()
            for protocol in found
        ]
        if self.transmissions:
            made["transmissions"] = [
                {"joint": name, **({"why": spell(t)} if isinstance(t, str) else t.to_dict())}
                for name, t in self.transmissions.items()
            ]
        if len(self.recordings) == 1:
            (only,) = self.recordings
            made["scored"] = only.scored(scored_rows(only))
        if self.problem is not None:
            made["problem"] = spell(self.problem)
        return made


def write_proposed(inspection: Inspection, options: ReadOptions) -> Path:
    """Write the sidecar that an inspection proposes beside the file; returns its path.

    Raises
    ------
    RecordingError
        The file cannot be read, has several joints and none is named, or has a sidecar; or there
        are several files.
    """
    if inspection.files:
        raise RecordingError(
            f"{inspection.table.path}: a sidecar lies beside one file: inspect one at a time"
        )
    if inspection.problem is not None:
        raise RecordingError(inspection.problem)
    if len(inspection.recordings) > 1:
        raise RecordingError(
            f"{inspection.table.path}: holds {len(inspection.recordings)} joints: name the one to "
            f"propose a sidecar for with {option('joint')}"
        )
    return write_sidecar(inspection.recordings[0], options, inspection.proposed)


def _described(column: Column) -> dict[str, object]:
    return {
        "from": column.source,
        "unit": column.unit,
        "min": column.minimum,
        "max": column.maximum,
    }


def inspect(path: Given, **reading: Unpack[ReadArguments]) -> Inspection:
    """Look at files: columns, units, rate, gaps, ranges, and which effects they can show.

    Parameters
    ----------
    path
        A file; several, a folder or a pattern are runs of the same joints.
    joint : str
        One joint of a file that holds several; default: all.
    **options
        As of `stribeck.read`.
    """
    options = ReadOptions.of(reading)
    files = listed_files(path)
    tables = tuple(scan_with(file, options) for file in files)
    several = tables if len(tables) > 1 else ()
    table = joined_table(tables, text_of(path, files), options.joint)
    if table.problem is not None:
        if _is_of_an_option(table.problem, options):
            raise RecordingError(table.problem)
        proposed = _proposed(table, (), options.joint)
        return Inspection(table, (), {}, table.problem, proposed, several)
    joint = options.joint
    # What cannot be fitted is inspected all the same.
    needs_motion = not options.standstill
    options = replace(options, standstill=True)
    names: list[str | None] = [joint] if joint is not None else [*table.joints] or [None]
    made = (read_with(path, replace(options, joint=name)) for name in names)
    recordings = tuple(replace(recording, trusted=True) for recording in made)
    proposed = _proposed(table, recordings, joint)
    still = [r for r in recordings if needs_motion and not r.moving.any()]
    if still:
        problem = str(nothing_moves(still[0]))
        shown = Inspection(table, recordings, {}, problem, proposed, several)
        return _with_findings(shown)
    answers = [untestable(r, _load(r)) for r in recordings]
    common = {
        effect: answers[0][effect]
        for effect in answers[0]
        if all(effect in answer for answer in answers)
    }
    return _with_findings(Inspection(table, recordings, common, None, proposed, several))


def _is_of_an_option(problem: str, options: ReadOptions) -> bool:
    """Whether a file cannot be read because of a column or a unit that the caller named."""
    named = {name: split_pairs(name, getattr(options, name)) for name in ("map", "unit")}
    given = [option(name, f"{k}={x}") for name, pairs in named.items() for k, x in pairs.items()]
    if options.weights is not None:
        given.append(option("weights", options.weights))
    return any(text in problem for text in given)


def _with_findings(inspection: Inspection) -> Inspection:
    """With the protocols, and the transmissions of joints with two encoders."""
    recordings = inspection.recordings
    return replace(
        inspection,
        transmissions=_transmissions(recordings),
        protocols={r.joint or "": found_protocols(r) for r in recordings},
    )


def _transmissions(recordings: tuple[Recording, ...]) -> dict[str, Transmission | str]:
    """What two encoders show of the transmission, by joint."""
    found: dict[str, Transmission | str] = {}
    for recording in recordings:
        if recording.motor_position is not None:
            try:
                found[recording.joint or ""] = measure_transmission(recording)
            except FitError as error:
                found[recording.joint or ""] = str(error)
    return found


def _proposed(
    table: Table, recordings: tuple[Recording, ...], joint: str | None
) -> tuple[Proposal, ...]:
    """The columns that are not read and may hold a channel."""
    used = [c.name for c in table.columns if c.channel is not None or c.derived]
    used += [column.source for r in recordings for column in r.columns.values()]
    number = joint if table.wide or joint is None or joint.isdigit() else None
    found = propose([c.name for c in table.columns], used, number)
    # What is computed from a column is read from it.
    formulas = [c.source for r in recordings for c in r.columns.values() if c.derived]
    return tuple(p for p in found if not any(p.column in text for text in formulas))


def _load(recording: Recording) -> Array | None:
    """Load torque of the rigid body, array [n], identified where the recording does not give it."""
    if not rigid_body_terms(recording):
        return None
    return own_load(fit("coulomb", recording).model, recording)
