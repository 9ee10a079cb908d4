"""Statistics over the results of all cases."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.benchmark.answer import CaseAnswer
from stribeck.benchmark.by_nuisance import OfNuisance, by_nuisance
from stribeck.benchmark.cases import CORRELATIONS, SIZES
from stribeck.benchmark.judge import FAILED, NONE, UNEXPLAINED, Judgement, judge
from stribeck.benchmark.recall import Recall, recalls
from stribeck.benchmark.reliability import (
    Above,
    LeftOut,
    Reliability,
    above,
    in_bins,
    judged_findings,
    left_out,
)
from stribeck.benchmark.share import Share
from stribeck.models.catalog import effect_ids

#: Smallest share of correct results of each group, and of single effects by relative size.
BARS = {"two": 0.92, "three": 0.75, "none": 0.98, "limited": 1.0, "outside": 0.92}
BARS_BY_SIZE = dict(zip(SIZES, (0.98, 0.95, 0.85), strict=True))
TITLES = {
    "two": "two hidden effects: both and nothing else",
    "three": "three hidden effects: all and nothing else",
    "none": "no hidden effect",
    "limited": "limited motion: untestable, not claimed",
    "outside": "effect outside the library: unexplained",
}
#: Smallest share of recordings in which nothing is named that is not hidden, without nuisances.
BAR_OF_NO_EXTRA = 0.96
TITLE_OF_NO_EXTRA = "one to three hidden effects, or none: nothing else named"
#: With nuisances: every hidden effect found, and no friction claimed that is not hidden.
BARS_WITH_NUISANCES = {"one": 0.90, "two": 0.80, "three": 0.75, "none": 0.95}
TITLES_WITH_NUISANCES = {
    "one": "one hidden effect, with nuisances: found, no false friction",
    "two": "two hidden effects, with nuisances: found, no false friction",
    "three": "three hidden effects, with nuisances: found, no false friction",
    "none": "no hidden effect, with nuisances: no false friction",
}
#: Smallest and largest acceptable coverage of the 95 % intervals.
COVERAGE_BAR = (0.90, 0.98)
#: Largest acceptable ratio of the final held-out error to that of the generator's formula, for
#: single effects of these sizes.
RATIO_BAR = 1.03
RATIO_SIZES = (1.0, 0.3)
#: Row of the confusion matrix for effects outside the library.
OUTSIDE = "outside the library"


@dataclass(frozen=True)
class ScoreGroup:
    """One line of the scoreboard."""

    title: str
    share: Share
    bar: float

    @property
    def passed(self) -> bool:
        """Whether the share reaches the bar."""
        return self.share.value >= self.bar


@dataclass(frozen=True)
class Ratio:
    """Statistics of the final held-out RMSE divided by that of the oracle."""

    title: str
    count: int
    mean: float
    median: float
    p90: float
    within: Share


@dataclass(frozen=True)
class Coverage:
    """Share of 95 % intervals that contain the true value, for one correlation of the noise."""

    correlation: float
    recordings: int
    share: Share
    ordinary: Share
    profile: Share

    @property
    def passed(self) -> bool:
        """Whether the shares are within their limits, that of the profile if it was computed."""
        known = [share for share in (self.share, self.profile) if share.total]
        return all(COVERAGE_BAR[0] <= share.value <= COVERAGE_BAR[1] for share in known)


@dataclass(frozen=True)
class Confusion:
    """How often each effect (column) was named for each hidden effect (row)."""

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    counts: NDArray[np.int64]

    def right_column(self, hidden: str) -> str:
        """Return the correct name of a row."""
        return UNEXPLAINED if hidden == OUTSIDE else hidden

    def to_frame(self) -> pl.DataFrame:
        """One row per hidden effect."""
        return pl.DataFrame(
            {"hidden": list(self.rows)}
            | {name: self.counts[:, k] for k, name in enumerate(self.columns)}
        )


@dataclass(frozen=True)
class Score:
    """All figures of a run."""

    groups: tuple[ScoreGroup, ...]
    confusion: Confusion
    reliability: tuple[Reliability, ...]
    ratios: tuple[Ratio, ...]
    coverage: tuple[Coverage, ...]
    failures: tuple[tuple[CaseAnswer, Judgement], ...]
    nuisances: tuple[OfNuisance, ...] = ()
    recall: tuple[Recall, ...] = ()
    above: tuple[Above, ...] = ()
    left_out: tuple[LeftOut, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether every group and every coverage reaches its bar."""
        ratio = all(r.mean <= RATIO_BAR for r in self.ratios if r.title != OVER_NOISE_5)
        groups = all(group.passed for group in self.groups)
        return ratio and groups and all(line.passed for line in self.coverage)

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "passed": self.passed,
            "groups": [
                {"group": g.title, **g.share.to_dict(), "bar": g.bar, "passed": g.passed}
                for g in self.groups
            ],
            "nuisances": [row.to_dict() for row in self.nuisances],
            "confusion": {
                "rows": list(self.confusion.rows),
                "columns": list(self.confusion.columns),
                "counts": self.confusion.counts.tolist(),
            },
            "reliability": [row.to_dict() for row in self.reliability],
            "findings_above": [row.to_dict() for row in self.above],
            "nuisance_left_out": [row.to_dict() for row in self.left_out],
            "recall": [row.to_dict() for row in self.recall],
            "held_out_over_oracle": [
                {
                    "of": r.title,
                    "answers": r.count,
                    "mean": r.mean,
                    "median": r.median,
                    "p90": r.p90,
                    "within_bar": r.within.value,
                    "bar": RATIO_BAR,
                }
                for r in self.ratios
            ],
            "coverage": [
                {
                    "correlation": c.correlation,
                    "recordings": c.recordings,
                    "share": c.share.value,
                    "interval95": list(c.share.interval),
                    "ordinary_least_squares": c.ordinary.value,
                    "profile": c.profile.value,
                    "profile_interval95": list(c.profile.interval),
                    "bar": list(COVERAGE_BAR),
                    "passed": c.passed,
                }
                for c in self.coverage
            ],
            "wrong": [
                {"case": a.case.name, "named": j.named, "problem": j.problem}
                for a, j in self.failures
            ],
        }


#: Title of a ratio that is reported only, without a limit.
OVER_NOISE_5 = "one effect at 5 x the noise"


def score(answers: Iterable[CaseAnswer]) -> Score:
    """Judge results and compute the statistics."""
    every = list(answers)
    judged = [(a, judge(a)) for a in every if a.case.group != "coverage"]
    findings = judged_findings(every)
    wrong = [(a, j) for a, j in judged if not j.right]
    wrong += [
        (a, Judgement(False, False, FAILED, a.failure))
        for a in every
        if a.case.group == "coverage" and a.failure
    ]
    return Score(
        tuple(_groups(judged)),
        _confusion(judged),
        tuple(in_bins(findings)),
        tuple(_ratios(judged)),
        tuple(_coverages(every)),
        tuple(wrong),
        tuple(by_nuisance(every)),
        tuple(recalls(every)),
        tuple(above(findings)),
        tuple(left_out(findings)),
    )


Judged = Sequence[tuple[CaseAnswer, Judgement]]


def _groups(judged: Judged) -> Iterable[ScoreGroup]:
    plain = [(a, j) for a, j in judged if not a.case.nuisances]
    for size, bar in BARS_BY_SIZE.items():
        of = [j for a, j in plain if a.case.group == "one" and a.case.size == size]
        if of:
            yield ScoreGroup(f"one hidden effect, {size:g} x the noise", _right(of), bar)
    if of := [j for a, j in plain if a.case.group in ("one", "two", "three", "none")]:
        none_extra = Share(sum(not j.extra for j in of), len(of))
        yield ScoreGroup(TITLE_OF_NO_EXTRA, none_extra, BAR_OF_NO_EXTRA)
    for titles, bars, of_kind in (
        (TITLES, BARS, plain),
        (TITLES_WITH_NUISANCES, BARS_WITH_NUISANCES, [r for r in judged if r[0].case.nuisances]),
    ):
        for group, bar in bars.items():
            of = [j for a, j in of_kind if a.case.group == group]
            if of:
                yield ScoreGroup(titles[group], _right(of), bar)


def _right(judgements: Sequence[Judgement]) -> Share:
    return Share(sum(j.right for j in judgements), len(judgements))


def _confusion(judged: Judged) -> Confusion:
    """Rows: single hidden effects, no effect, and effects outside the library."""
    pairs = []
    for a, j in judged:
        if a.case.group in ("one", "none"):
            pairs.append((a.case.effects[0], j.named))
        elif a.case.group == "outside":
            pairs.append((OUTSIDE, j.named))
    hidden, named = {row for row, _ in pairs}, {column for _, column in pairs}
    effects = tuple(effect_ids())
    # A generator may hide effects that are not in the catalog yet.
    effects += tuple(sorted(hidden - {*effects, NONE, OUTSIDE}))
    rows = tuple(r for r in (*effects, NONE, OUTSIDE) if r in hidden)
    columns = tuple(c for c in effects if c in hidden | named)
    columns += (NONE, UNEXPLAINED, *([FAILED] if FAILED in named else []))
    counts = np.zeros((len(rows), len(columns)), dtype=np.int64)
    for row, column in pairs:
        counts[rows.index(row), columns.index(column)] += 1
    return Confusion(rows, columns, counts)


def _ratios(judged: Judged) -> Iterable[Ratio]:
    single = [a for a, _ in judged if a.case.group == "one" and a.ratio is not None]
    selections = [
        (
            f"one effect at {' and '.join(f'{s:g}' for s in sorted(RATIO_SIZES))} x the noise",
            [a for a in single if a.case.size in RATIO_SIZES],
        ),
        (OVER_NOISE_5, [a for a in single if a.case.size == SIZES[0]]),
    ]
    for title, of in selections:
        if of:
            values = np.array([a.ratio for a in of])
            within = Share(int(np.sum(values <= RATIO_BAR)), len(of))
            yield Ratio(
                title,
                len(of),
                float(values.mean()),
                float(np.median(values)),
                float(np.quantile(values, 0.9)),
                within,
            )


def _coverages(answers: Sequence[CaseAnswer]) -> Iterable[Coverage]:
    for correlation in CORRELATIONS:
        of = [a for a in answers if a.case.correlation == correlation and not a.failure]
        if not of:
            continue
        every = [i for a in of for i in a.intervals]
        ordinary = [i for i in every if i.covers_ordinary is not None]
        profiled = [i for i in every if i.covers_profile is not None]
        yield Coverage(
            correlation,
            len(of),
            Share(sum(i.covers for i in every), len(every)),
            Share(sum(bool(i.covers_ordinary) for i in ordinary), len(ordinary)),
            Share(sum(bool(i.covers_profile) for i in profiled), len(profiled)),
        )
