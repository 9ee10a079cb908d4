"""The folder of a study: its description, and every fit.

``manifest.json`` describes the study. ``fits.csv`` gets one line when a fit ends, so that nothing
is lost when the study is stopped; at the end it is sorted, and written to ``fits.parquet`` too.
"""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterable
from pathlib import Path

import polars as pl

from stribeck.base.errors import StribeckError, option
from stribeck.base.files import write_bytes_whole, write_whole
from stribeck.base.run_folder import claim, unwritable
from stribeck.base.version import __version__
from stribeck.scale.study.plan import Job, StudyPlan
from stribeck.scale.study.trial import Trial

FITS = "fits.csv"
FIELDS = (
    "joint",
    "law",
    "start",
    "rmse",
    "rmse_held_out",
    "converged",
    "outcome",
    "evaluations",
    "seconds",
    "parameters",
    "constants",
    "rigid_body",
    "failure",
)
#: What must be the same to continue a study, and the words of the error if it is not.
IDENTITY = {
    "data": "of another recording or sidecar",
    "reading": "of a recording read with other options",
    "joints": "of other joints",
    "laws": "of other laws",
    "starts": "with another number of starts",
    "seed": "with another seed",
    "choices": "with other bounds, starts or fixed values",
    "version": "made by another version of stribeck",
}


class StudyStore:
    """The folder of one study.

    Parameters
    ----------
    folder
        Created if it does not exist.
    plan
        The fits of the study.

    Raises
    ------
    StribeckError
        The folder holds another study or other files, or cannot be written to.
    """

    def __init__(self, folder: Path, plan: StudyPlan) -> None:
        self.folder = folder
        self._lock = claim(folder, _manifest(plan), IDENTITY, "study")
        try:
            self.trials = _read_fits(folder / FITS, set(plan.jobs))
            self._rewrite()
            self._log = (folder / FITS).open("a", encoding="utf-8", newline="")
        except OSError as error:
            self._lock.release()
            raise unwritable(folder, error) from None
        except BaseException:
            self._lock.release()
            raise

    def __enter__(self) -> StudyStore:
        return self

    def __exit__(self, *error: object) -> None:
        """Leave the folder to other runs."""
        self._lock.release()

    def add(self, trial: Trial) -> None:
        """Write a fit to disk.

        Raises
        ------
        StribeckError
            It cannot be written; the fits before it are kept.
        """
        try:
            self._log.write(_lines([trial]))
            self._log.flush()
        except OSError as error:
            raise unwritable(self.folder, error) from None
        self.trials[trial.job] = trial

    def close(self) -> None:
        """Sort the fits, and write them as Parquet too."""
        self._log.close()
        self._rewrite()
        stream = io.BytesIO()
        self.frame().write_parquet(stream)
        write_bytes_whole(self.folder / "fits.parquet", stream.getvalue())

    def _rewrite(self) -> None:
        """Write the fits, sorted by joint, law and start."""
        write_whole(self.folder / FITS, ",".join(FIELDS) + "\n" + _lines(self.ordered()))

    def ordered(self) -> list[Trial]:
        """Return the fits sorted by joint, law and start."""
        return sorted(
            self.trials.values(), key=lambda t: (t.job.joint or "", t.job.law, t.job.start)
        )

    def frame(self) -> pl.DataFrame:
        """Return a table with one row for each fit; parameters are lists of name and value."""
        rows = [
            {
                "joint": t.job.joint,
                "law": t.job.law,
                "start": t.job.start,
                "rmse": t.rmse,
                "rmse_held_out": t.rmse_held_out,
                "converged": t.converged,
                "outcome": t.outcome,
                "evaluations": t.evaluations,
                "seconds": t.seconds,
                "parameters": [{"name": n, "value": v} for n, v in t.parameters.items()],
                "failure": t.failure,
            }
            for t in self.ordered()
        ]
        pairs = pl.List(pl.Struct({"name": pl.String, "value": pl.Float64}))
        schema: dict[str, pl.DataType | type[pl.DataType]] = {
            "joint": pl.String,
            "law": pl.String,
            "start": pl.Int64,
            "rmse": pl.Float64,
            "rmse_held_out": pl.Float64,
            "converged": pl.Boolean,
            "outcome": pl.String,
            "evaluations": pl.Int64,
            "seconds": pl.Float64,
            "parameters": pairs,
            "failure": pl.String,
        }
        return pl.DataFrame(rows, schema=schema)


def _manifest(plan: StudyPlan) -> dict[str, object]:
    made = {
        "kind": "study",
        "path": str(plan.path),
        "data": dict(plan.data),
        "reading": {k: v for k, v in plan.reading.given().items() if v != ""},
        "joints": list(plan.joints),
        "laws": list(plan.laws),
        "starts": plan.starts,
        "seed": plan.seed,
        "choices": plan.choices.arguments(),
        "version": __version__,
        "fits": len(plan.jobs),
        "skipped": [{"joint": s.joint, "law": s.law, "why": s.why} for s in plan.skipped],
    }
    # Tuples become lists in JSON; the manifest is compared with one that was read.
    return dict(json.loads(json.dumps(made, default=str)))


def _lines(trials: Iterable[Trial]) -> str:
    """Return fits as lines of CSV that reproduce every bit of the numbers."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    for t in trials:
        writer.writerow(
            [
                t.job.joint or "",
                t.job.law,
                t.job.start,
                _number(t.rmse),
                _number(t.rmse_held_out),
                str(t.converged).lower(),
                t.outcome,
                t.evaluations,
                repr(t.seconds),
                json.dumps(dict(t.parameters)),
                json.dumps(dict(t.constants)),
                json.dumps(list(t.rigid_body)),
                t.failure,
            ]
        )
    return stream.getvalue()


def _number(value: float | None) -> str:
    return "" if value is None or not math.isfinite(value) else repr(value)


def _read_fits(path: Path, wanted: set[Job]) -> dict[Job, Trial]:
    """Read earlier fits; an incomplete last line is ignored and fitted again."""
    if not path.exists():
        return {}
    text = path.read_text(encoding="utf-8")
    whole = text[: text.rfind("\n") + 1]
    trials: dict[Job, Trial] = {}
    for row in csv.DictReader(io.StringIO(whole, newline="")):
        try:
            trial = _trial(row)
        except (KeyError, TypeError, ValueError):
            raise StribeckError(
                f"{path} is damaged (after {len(trials)} fits): remove the folder, or give another "
                f"{option('output')}"
            ) from None
        if trial.job in wanted:
            trials[trial.job] = trial
    return trials


def _trial(row: dict[str, str]) -> Trial:
    return Trial(
        job=Job(row["joint"] or None, row["law"], int(row["start"])),
        rmse=float(row["rmse"]) if row["rmse"] else None,
        rmse_held_out=float(row["rmse_held_out"]) if row["rmse_held_out"] else None,
        converged=row["converged"] == "true",
        outcome=row["outcome"],
        evaluations=int(row["evaluations"]),
        seconds=float(row["seconds"]),
        parameters=json.loads(row["parameters"]),
        constants=json.loads(row["constants"]),
        rigid_body=tuple(json.loads(row["rigid_body"])),
        failure=row["failure"],
    )
