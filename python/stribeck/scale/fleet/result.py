"""The result of a fleet: joints that changed, and joints with an unusual effect."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import polars as pl

from stribeck.base.shown import Plotted
from stribeck.scale.fleet.changes import Changes
from stribeck.scale.fleet.effects import Effects
from stribeck.scale.fleet.store import FAILED, RESULTS
from stribeck.scale.fleet.task import Work


@dataclass(frozen=True)
class Failure:
    """A joint or file without a result."""

    file: str
    joint: str | None
    reason: str

    def to_dict(self) -> dict[str, object]:
        """JSON."""
        return {"file": self.file, "joint": self.joint, "reason": self.reason}


@dataclass(frozen=True, repr=False)
class Fleet(Plotted):
    """A model identified on every joint of many robots and days.

    Attributes
    ----------
    rows : polars.DataFrame
        The data set, one row per joint and file (`stribeck.scale.fleet.store.SCHEMA`).
    new
        Number of rows added by this run.
    incidents
        Failures of workers during the run.

    Examples
    --------
    >>> import numpy as np, polars as pl, stribeck as sb, tempfile
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> v = np.sin(np.arange(900) / 50.0)
    >>> run = pl.DataFrame({"t": np.arange(900) / 100.0, "qd": v, "tau": v + np.sign(v)})
    >>> with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(1) as executor:
    ...     run.write_csv(f"{folder}/one.csv")
    ...     run.drop("tau").write_csv(f"{folder}/other.csv")
    ...     given = {"executor": executor, "starts": 1}
    ...     found = sb.fleet([f"{folder}/*.csv"], f"{folder}/results", "coulomb", **given)
    >>> found.done.height, ["no torque column" in one.reason for one in found.failures]
    (1, [True])
    """

    folder: Path
    work: Work
    rows: pl.DataFrame
    new: int
    changes: Changes
    effects: Effects
    incidents: Sequence[str] = ()

    @property
    def done(self) -> pl.DataFrame:
        """The rows with a result."""
        return self.rows.filter(pl.col("status") != FAILED)

    @property
    def failures(self) -> tuple[Failure, ...]:
        """Joints and files without a result, and why."""
        failed = self.rows.filter(pl.col("status") == FAILED)
        return tuple(Failure(*row) for row in failed.select("file", "joint", "reason").iter_rows())

    def counts(self) -> dict[str, int]:
        """Numbers of files, robots, joints and days with a result, and without one."""
        done = self.done
        return {
            "files": done["file"].n_unique(),
            "robots": done["robot"].n_unique(),
            "joints": done.select("robot", "joint").n_unique(),
            "days": done["day"].drop_nulls().n_unique(),
            "done": done.height,
            "failed": self.rows.height - done.height,
            "new": self.new,
        }

    def reading_notes(self) -> tuple[str, ...]:
        """The notes on reading that most recordings share."""
        done = self.done
        notes = done["notes"].explode().drop_nulls().value_counts(sort=True)
        return tuple(text for text, count in notes.iter_rows() if 2 * count > done.height)

    def to_dict(self) -> dict[str, object]:
        """JSON of `stribeck fleet`."""
        return {
            "model": self.work.label,
            "output": str(self.folder / RESULTS),
            **self.counts(),
            "failures": [failure.to_dict() for failure in self.failures],
            "changes": self.changes.to_dict(),
            "effects": self.effects.to_dict(),
            "incidents": list(self.incidents),
            "notes": list(self.reading_notes()),
        }

    def to_frame(self) -> pl.DataFrame:
        """The data set: one row per joint and file."""
        return self.rows
