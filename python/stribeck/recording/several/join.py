"""From several parts to one recording with a run for each."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl

from stribeck.recording.arrays import Floats, Ints, ints
from stribeck.recording.assembly.assemble import completed, settled
from stribeck.recording.blocks.hold_out import with_hold_out
from stribeck.recording.blocks.repeated_motion import held_out_together
from stribeck.recording.blocks.speeds_once import held_out_in_turn
from stribeck.recording.check import Check
from stribeck.recording.consistency.runs import OF_RUNS, between_runs
from stribeck.recording.joint.channels import Channels, Layout
from stribeck.recording.naming.columns import Choice
from stribeck.recording.recording import Column, Recording
from stribeck.recording.rows import MANY_RUNS
from stribeck.recording.several.agree import check_agreement
from stribeck.recording.several.part import Part, joined_values
from stribeck.recording.stated.origin import Origin
from stribeck.recording.tables.prepared import Prepared
from stribeck.recording.tables.readers import Source

__all__ = ["join", "joined_hash"]


def join(parts: Sequence[Part], path: str, *, standstill: bool = False) -> Recording:
    """One recording of several parts, in this order; each is a run, or several.

    Filters, noise and scored samples are those of one file with a run column. Where there are at
    least five parts, each is a held-out block.

    Parameters
    ----------
    path
        As sentences name the recording.
    standstill
        Accept a recording in which nothing moves.

    Raises
    ------
    RecordingError
        The parts are not of the same joint, or not read alike.
    """
    check_agreement(parts)
    data, layout = _joined(parts, path)
    torque_at = next((p.torque_at for p in parts if p.torque_at is not None), None)
    made = completed(data, layout, torque_at=torque_at)
    made = replace(
        made,
        checks=(*(c for c in _checks(parts, made) if c.check not in OF_RUNS), *between_runs(made)),
        trusted=all(p.trusted for p in _contradictory(parts) or parts),
        origin=Origin(
            data.prepared.settings,
            tuple(parts[0].values),
            tuple(_notes(parts)),
            tuple(file for part in parts for file in part.files),
        ),
    )
    made = settled(made, data, standstill=standstill)
    if len(parts) >= MANY_RUNS and not made.averaged:
        block = np.repeat(np.arange(len(parts)), [part.rows for part in parts])
        made = replace(made, block=ints(block), block_count=len(parts))
    hold_out = data.prepared.settings.hold_out
    if hold_out is None:
        return held_out_together(held_out_in_turn(made))
    return with_hold_out(made, data.prepared, data.rows, hold_out, layout)


def _contradictory(parts: Sequence[Part]) -> list[Part]:
    """The parts of which a check failed."""
    return [part for part in parts if not all(check.ok for check in part.checks)]


def _joined(parts: Sequence[Part], path: str) -> tuple[Channels, Layout]:
    """The channels of all parts, one after the other, and their layout."""
    data = Channels(_prepared(parts, path), np.arange(sum(part.rows for part in parts)))
    data.values = {channel: joined_values(parts, channel) for channel in parts[0].values}
    data.columns = {name: _column(parts, name, values) for name, values in data.values.items()}
    data.sequence = np.concatenate([part.sequence for part in parts])
    data.notes = _notes(parts)
    run, names = _runs(parts)
    layout = replace(
        parts[0].layout,
        joint=next((p.layout.joint for p in parts if p.layout.joint is not None), None),
        run=run,
        run_names=names,
        rows_dropped=sum(part.layout.rows_dropped for part in parts),
    )
    return data, layout


def _runs(parts: Sequence[Part]) -> tuple[Ints, tuple[str, ...]]:
    """Number of the run of each sample, [n], and the names of the runs."""
    first = np.cumsum([0, *(len(part.layout.run_names) for part in parts)])
    run = np.concatenate([p.layout.run + k for p, k in zip(parts, first[:-1], strict=True)])
    return run, tuple(name for part in parts for name in part.run_names)


def _prepared(parts: Sequence[Part], path: str) -> Prepared:
    """A table with what can be held out by, and the settings that all parts share."""
    run, names = _runs(parts)
    table = pl.DataFrame(
        {
            "file": np.repeat([part.name for part in parts], [part.rows for part in parts]),
            "run": np.array(names)[run],
        }
    )
    settings = parts[0].settings
    if settings.hold_out is not None and all(part.labels is not None for part in parts):
        column = settings.hold_out.partition("=")[0].strip()
        labels = pl.concat([part.labels for part in parts if part.labels is not None])
        table = table.with_columns(labels.alias(column))
    motor = {k: v for part in parts for k, v in part.settings.mechanics.motor.items()}
    settings = replace(settings, mechanics=replace(settings.mechanics, motor=motor))
    files = tuple(file for part in parts for file in part.files)
    return Prepared(
        Source(path, joined_hash(files), table, 0),
        settings,
        table,
        np.arange(table.height),
        {name: _choice(parts, name) for name in parts[0].values},
        (),
    )


def joined_hash(files: Sequence[tuple[str, str]]) -> str:
    """Hash of the names and hashes of several files, in order; that of a single file."""
    if len(files) == 1:
        return files[0][1]
    lines = (f"{sha256}  {Path(path).name}\n" for path, sha256 in files)
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def _source(parts: Sequence[Part], name: str) -> str:
    """The columns that a channel comes from."""
    return ", ".join(dict.fromkeys(part.columns[name].source for part in parts))


def _choice(parts: Sequence[Part], name: str) -> Choice:
    return Choice(name, _source(parts, name), None, "name")


def _column(parts: Sequence[Part], name: str, values: Floats) -> Column:
    first = parts[0].columns[name]
    return Column.of(name, _source(parts, name), first.unit, first.derived, values)


def _notes(parts: Sequence[Part]) -> list[str]:
    """Notes that all parts have, once; the others with the part's file."""
    if len(parts) == 1:
        return list(parts[0].notes)
    made = []
    for part in parts:
        for note in part.notes:
            shared = all(note in other.notes for other in parts)
            made.append(note if shared else f"{Path(part.path).name}: {note}")
    return list(dict.fromkeys(made))


def _checks(parts: Sequence[Part], made: Recording) -> tuple[Check, ...]:
    """The checks of every part, with its file where they differ."""
    if len(parts) == 1:
        return parts[0].checks
    own = [(*part.checks, *(() if part.checker is None else part.checker(made))) for part in parts]
    found = []
    for part, checks in zip(parts, own, strict=True):
        name = Path(part.path).name
        for check in checks:
            others = [c for other in own for c in other if c.check == check.check]
            if all(check == other for other in others):
                found.append(check)
            elif all(other.ok for other in others):
                # One sentence stands for all files that agree.
                if check is others[0]:
                    found.append(replace(check, said=f"{check.said} ({name}; the others alike)"))
            else:
                found.append(replace(check, said=f"{name}: {check.said}"))
    return tuple(dict.fromkeys(found))
