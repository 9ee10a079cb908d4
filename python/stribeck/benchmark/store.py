"""The folder of a benchmark run: all results, then tables and figures.

``manifest.json`` identifies the program. ``answers.jsonl`` gets one line when a case ends, so that
nothing is lost when the run is stopped; the same command continues from there.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable
from pathlib import Path

import polars as pl

from stribeck.base.errors import StribeckError, option
from stribeck.base.files import write_whole
from stribeck.base.version import __version__
from stribeck.benchmark.answer import CaseAnswer
from stribeck.benchmark.judge import judge

KIND = "diagnosis benchmark"
MANIFEST, ANSWERS = "manifest.json", "answers.jsonl"
_TEXTS, _NUMBERS = pl.List(pl.String), pl.List(pl.Float64)
SCHEMA: dict[str, pl.DataType | type[pl.DataType]] = {
    "case": pl.String,
    "group": pl.String,
    "generator": pl.String,
    "effects": _TEXTS,
    "size": pl.Float64,
    "sizes": _NUMBERS,
    "detectable": _NUMBERS,
    "limit": pl.String,
    "nuisances": _TEXTS,
    "seed": pl.Int64,
    "correlation": pl.Float64,
    "right": pl.Boolean,
    "exact": pl.Boolean,
    "named": pl.String,
    "problem": pl.String,
    "found": _TEXTS,
    "confidence": _NUMBERS,
    "indistinguishable_from": pl.List(_TEXTS),
    "verdict": pl.String,
    "untestable": _TEXTS,
    "rmse_held_out": pl.Float64,
    "oracle_rmse": pl.Float64,
    "noise_rms": pl.Float64,
    "noise_floor": pl.Float64,
    "covered": pl.List(pl.Boolean),
    "covered_ordinary": pl.List(pl.Boolean),
    "parameters": _TEXTS,
    "seconds": pl.Float64,
    "failure": pl.String,
}


class AnswerStore:
    """Answers of one version of the program, on disk.

    Parameters
    ----------
    folder
        Created if it does not exist.

    Raises
    ------
    StribeckError
        The folder contains results of another version or other files, or cannot be written to.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.answers: dict[str, CaseAnswer] = {}
        manifest = {"kind": KIND, "version": __version__, "program": program_hash()}
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if (folder / MANIFEST).exists():
                self._check(manifest)
                self.answers = {a.case.name: a for a in read_answers(folder / ANSWERS)}
            elif any(folder.iterdir()):
                raise StribeckError(
                    f"{folder} is not empty and contains no benchmark: "
                    f"give another {option('output')}"
                )
            else:
                write_whole(folder / MANIFEST, json.dumps(manifest, indent=2) + "\n")
            write_whole(folder / ANSWERS, "".join(map(_line, self.answers.values())))
            self._log = (folder / ANSWERS).open("a", encoding="utf-8")
        except OSError as error:
            raise StribeckError(
                f"cannot write {folder}: {error.strerror or error}; give {option('output')} a "
                f"folder that can be written to"
            ) from None

    def _check(self, manifest: dict[str, str]) -> None:
        path = self.folder / MANIFEST
        try:
            found = json.loads(path.read_text(encoding="utf-8"))
        except ValueError:
            found = None
        if not isinstance(found, dict) or found.get("kind") != KIND:
            raise StribeckError(
                f"{path} does not belong to a benchmark: give another {option('output')}"
            )
        if found != manifest:
            raise StribeckError(
                f"{self.folder} contains answers of another version of stribeck: give another "
                f"{option('output')}, so that answers of two versions are not mixed"
            )

    def add(self, answer: CaseAnswer) -> None:
        """Write an answer to disk."""
        self.answers[answer.case.name] = answer
        self._log.write(_line(answer))
        self._log.flush()

    def close(self) -> None:
        """Close the file of answers."""
        self._log.close()


def program_hash() -> str:
    """Return the SHA-256 of the code of the package, on which the answers depend."""
    root = Path(__file__).resolve().parents[1]
    digest = hashlib.sha256()
    for path in sorted([*root.rglob("*.py"), *root.glob("_core*")]):
        digest.update(str(path.relative_to(root)).encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def frame(answers: Iterable[CaseAnswer]) -> pl.DataFrame:
    """Return a table with one row for each answer and its judgement."""
    rows = []
    for a in answers:
        scored = a.case.group != "coverage"
        judgement = judge(a) if scored else None
        rows.append(
            {
                "case": a.case.name,
                "group": a.case.group,
                "generator": a.case.generator,
                "effects": list(a.case.effects),
                "size": a.case.size,
                "limit": a.case.limit,
                "sizes": list(a.sizes),
                "detectable": list(a.detectable),
                "nuisances": list(a.case.nuisances),
                "seed": a.case.seed,
                "correlation": a.case.correlation,
                "right": judgement.right if judgement else None,
                "exact": judgement.exact if judgement else None,
                "named": judgement.named if judgement else None,
                "problem": judgement.problem if judgement else None,
                "found": [s.effect for s in a.steps],
                "confidence": [s.confidence for s in a.steps],
                "indistinguishable_from": [list(s.indistinguishable_from) for s in a.steps],
                "verdict": a.verdict,
                "untestable": list(a.untestable),
                "rmse_held_out": a.rmse_held_out,
                "oracle_rmse": a.oracle_rmse,
                "noise_rms": a.noise_rms,
                "noise_floor": a.noise_floor,
                "covered": [i.covers for i in a.intervals],
                "covered_ordinary": [i.covers_ordinary for i in a.intervals],
                "parameters": [i.parameter for i in a.intervals],
                "seconds": a.seconds,
                "failure": a.failure,
            }
        )
    return pl.DataFrame(rows, schema=SCHEMA)


def _line(answer: CaseAnswer) -> str:
    return json.dumps(_finite(answer.to_dict()), allow_nan=False) + "\n"


def _finite(value: object) -> object:
    """Replace NaN and infinity by None, because JSON has neither."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def read_answers(path: Path) -> list[CaseAnswer]:
    """Read earlier answers; an incomplete last line is ignored."""
    if not path.exists():
        return []
    text = path.read_text(encoding="utf-8")
    answers = []
    for number, line in enumerate(text[: text.rfind("\n") + 1].splitlines(), start=1):
        try:
            answers.append(CaseAnswer.from_dict(json.loads(line)))
        except (KeyError, TypeError, ValueError):
            raise StribeckError(
                f"{path}, line {number}, is damaged: remove it, or give another {option('output')}"
            ) from None
    return answers
