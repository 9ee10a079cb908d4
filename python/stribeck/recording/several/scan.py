"""What is in several files before a joint is selected."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from stribeck.base.errors import RecordingError, option
from stribeck.recording.recording import Column
from stribeck.recording.several.paths import run_names
from stribeck.recording.whole_file.scan import Table

__all__ = ["joined_table"]


def joined_table(tables: Sequence[Table], path: str, joint: str | None) -> Table:
    """One table of several files; the table itself where there is one.

    Parameters
    ----------
    path
        As sentences name it.
    joint
        The joint that was named; without one, every file must hold the same joints.

    Raises
    ------
    RecordingError
        Files of the same name, or with different joints.
    """
    first = tables[0]
    if len(tables) == 1:
        return first
    run_names([t.path for t in tables])
    for other in tables[1:]:
        if joint is None and other.joints != first.joints:
            raise RecordingError(
                f"{other.path}: {_joints(other)}, but {_joints(first)} in {first.path}: files of "
                f"one joint must agree; name one with {option('joint')}"
            )
    longest = max(tables, key=lambda t: t.rows)
    counted = [t.gaps for t in tables if t.gaps is not None]
    return replace(
        first,
        path=path,
        rows=sum(t.rows for t in tables),
        runs=sum(t.runs for t in tables),
        columns=tuple({c.name: c for t in reversed(tables) for c in t.columns}.values()),
        channels={
            name: _joined([t.channels[name] for t in tables if name in t.channels])
            for name in dict.fromkeys(name for t in tables for name in t.channels)
        },
        rate_hz=longest.rate_hz,
        gaps=sum(counted) if counted else None,
        problem=next((t.problem for t in tables if t.problem is not None), None),
        notes=(),
    )


def _joints(table: Table) -> str:
    if not table.joints:
        return "no joint is named"
    return f"joint{'s' * (len(table.joints) > 1)} {', '.join(table.joints)}"


def _joined(columns: Sequence[Column]) -> Column:
    """A channel with its columns and its range over all files."""
    return replace(
        columns[0],
        source=", ".join(dict.fromkeys(c.source for c in columns)),
        minimum=min(c.minimum for c in columns),
        maximum=max(c.maximum for c in columns),
    )
