"""The result of a study: its tables as data, text and files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import polars as pl

from stribeck.base.shown import Plotted, draw
from stribeck.fitting.energy import Energy, joules, total_energy
from stribeck.scale.study.assess import Entry, JointData
from stribeck.scale.study.plan import GROUPS, LawGroup, Skipped, StudyPlan
from stribeck.scale.study.trial import Trial

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Row:
    """A law in its table."""

    law: str
    entries: Mapping[str | None, Entry]
    energy: Energy | None
    energy_all_rows: Energy | None


@dataclass(frozen=True)
class Table:
    """Laws of one group, the smallest error first."""

    group: LawGroup
    rows: tuple[Row, ...]


@dataclass(frozen=True, repr=False)
class Study(Plotted):
    """Laws times joints times starts on a recording.

    Attributes
    ----------
    joints
        The scored data of each joint.
    tables
        As tables 4, 5 and 6 of the review; a group without laws is left out.
    failed
        Fits that could not be made.
    frame
        Every fit, one row each.
    """

    plan: StudyPlan
    folder: Path
    joints: Mapping[str | None, JointData]
    tables: tuple[Table, ...]
    failed: tuple[Trial, ...]
    frame: pl.DataFrame

    @property
    def skipped(self) -> tuple[Skipped, ...]:
        """Laws that a recording lacks a channel for."""
        return self.plan.skipped

    def entries(self) -> Iterator[tuple[Table, Row, str | None, Entry]]:
        """Every law on every joint, table by table."""
        for table in self.tables:
            for row in table.rows:
                for joint, entry in row.entries.items():
                    yield table, row, joint, entry

    def to_dict(self) -> dict[str, object]:
        """JSON of `stribeck study`."""
        return {
            "data": {
                "path": self.plan.path,
                "sha256": self.plan.data["sha256"],
                "joints": [
                    {
                        "joint": joint,
                        "rows": data.rows,
                        "scored": dict(data.scored),
                        "unit": data.torque_unit,
                        "low_speed": {"below": data.low_speed, "unit": data.velocity_unit},
                    }
                    for joint, data in self.joints.items()
                ],
                "notes": list(self.plan.notes),
            },
            "laws": list(self.plan.laws),
            "starts": self.plan.starts,
            "seed": self.plan.seed,
            "fits": self.frame.height,
            "complete": self.frame.height == len(self.plan.jobs),
            "tables": [
                {
                    "group": table.group.id,
                    "title": table.group.title,
                    "rows": [
                        {
                            "law": row.law,
                            "joints": [
                                {"joint": joint, **entry.to_dict()}
                                for joint, entry in row.entries.items()
                            ],
                            "energy": joules(row.energy),
                            "energy_all_rows": joules(row.energy_all_rows),
                        }
                        for row in table.rows
                    ],
                }
                for table in self.tables
            ],
            "skipped": [{"joint": s.joint, "law": s.law, "why": s.why} for s in self.skipped],
            "failed": [
                {"joint": t.job.joint, "law": t.job.law, "start": t.job.start, "why": t.failure}
                for t in self.failed
            ],
            "output": str(self.folder),
        }

    def to_frame(self) -> pl.DataFrame:
        """One row per law and joint, with the figures of the tables."""
        return pl.DataFrame(
            [
                {
                    "table": table.group.id,
                    "law": row.law,
                    "joint": joint,
                    "unit": self.joints[joint].torque_unit,
                    "mean": entry.whole.mean,
                    "std": entry.whole.std,
                    "rmse": entry.whole.rms,
                    "rmse_held_out": entry.best.rmse_held_out,
                    "low_speed_mean": entry.low_speed.mean,
                    "low_speed_std": entry.low_speed.std,
                    "low_speed_rmse": entry.low_speed.rms,
                    "low_speed_rows": entry.low_speed.rows,
                    "measured_J": entry.energy.measured if entry.energy else None,
                    "model_J": entry.energy.modelled if entry.energy else None,
                    "error_J": entry.energy.error if entry.energy else None,
                    "best_start": entry.best.job.start,
                    "starts": entry.trials,
                    "starts_agreeing": entry.agreeing,
                }
                for table, row, joint, entry in self.entries()
            ]
        )

    def plot(self, joint: str | None = None) -> Figure:
        """Box plots of the torque error of one joint (default: the first)."""
        return draw(self, joint=next(iter(self.joints)) if joint is None else joint)


def make_tables(
    groups: Mapping[str, LawGroup], entries: Mapping[str, Mapping[str | None, Entry]]
) -> tuple[Table, ...]:
    """Sort laws into their tables.

    Parameters
    ----------
    groups, entries
        By law; entries by joint.
    """
    tables = []
    for group in GROUPS:
        laws = {law: of for law, of in entries.items() if of and groups[law] == group}
        rows = [
            Row(
                law,
                laws[law],
                total_energy(entry.energy for entry in laws[law].values()),
                total_energy(entry.energy_all_rows for entry in laws[law].values()),
            )
            for law in _ranked(laws)
        ]
        if rows:
            tables.append(Table(group, tuple(rows)))
    return tuple(tables)


def _ranked(laws: Mapping[str, Mapping[str | None, Entry]]) -> list[str]:
    """Sort laws by the mean over the joints of error / smallest error of the joint.

    The ratio is used because joints differ in size. Laws without some joint come last.
    """
    best: dict[str | None, float] = {}
    for entries in laws.values():
        for joint, entry in entries.items():
            best[joint] = min(best.get(joint, np.inf), entry.whole.rms)

    def key(law: str) -> tuple[int, float, str]:
        entries = laws[law]
        ratios = [entry.whole.rms / (best[joint] or 1.0) for joint, entry in entries.items()]
        return len(best) - len(entries), float(np.mean(ratios)), law

    return sorted(laws, key=key)
