"""What `stribeck benchmark diagnosis` prints."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from stribeck.benchmark.by_nuisance import OfNuisance
from stribeck.benchmark.recall import CONFIDENT, DETECTABLE, RECALL_BAR, Recall
from stribeck.benchmark.reliability import BARS, Above, LeftOut, Reliability
from stribeck.benchmark.score import (
    COVERAGE_BAR,
    RATIO_BAR,
    Confusion,
    Coverage,
    Ratio,
    Score,
    ScoreGroup,
)
from stribeck.benchmark.share import Share
from stribeck.report.layout import table

#: Largest number of wrong results that are listed.
MOST_LISTED = 40


def score_text(score: Score) -> str:
    """Return all statistics as text."""
    parts = [
        _part("Share of answers that are right", _groups(score.groups)),
        _part("Recordings with each nuisance, alone or among others", _nuisances(score.nuisances)),
        _part("Hidden effect, and what was named first", _confusion(score.confusion)),
        _part(
            "Findings by confidence, and how many of them are right",
            _reliability(score.reliability),
        ),
        _part("Findings above a confidence, bounded by recording", _above(score.above)),
        _part(
            "Findings of friction among one nuisance, and share expected from all other recordings",
            _left_out(score.left_out),
        ),
        _part(
            f"Hidden effects of at least {DETECTABLE:g} standard errors in the generator's own "
            f"model, and those named with a confidence above {CONFIDENT:g}",
            _recall(score.recall),
        ),
        _part(
            "Final held-out RMSE over that of the generator's own formula, refitted",
            _ratios(score.ratios),
        ),
        _part("95 % intervals that cover the truth, under AR(1) noise", _coverage(score.coverage)),
        _part("Wrong answers", _wrong(score)),
    ]
    return "\n\n".join(part for part in parts if part)


def _part(title: str, body: str) -> str:
    return f"{title}\n\n{body}" if body else ""


def _percent(share: float) -> str:
    return f"{100 * share:.1f} %"


def _interval(share: Share) -> str:
    low, high = share.interval
    return f"{100 * low:.0f} to {100 * high:.0f} %"


def _mark(passed: bool) -> str:
    return "yes" if passed else "NO"


def _groups(groups: Sequence[ScoreGroup]) -> str:
    if not groups:
        return ""
    rows = [["group", "right", "of", "share", "95 % interval", "bar", "reached"]]
    rows += [
        [
            g.title,
            str(g.share.count),
            str(g.share.total),
            _percent(g.share.value),
            _interval(g.share),
            _percent(g.bar),
            _mark(g.passed),
        ]
        for g in groups
    ]
    return table(rows, right=(1, 2, 3, 4, 5))


def _nuisances(rows_of: Sequence[OfNuisance]) -> str:
    if not rows_of:
        return ""
    rows = [
        ["nuisance", "nothing hidden", "no friction claimed", "hidden", "right", "falsely claimed"]
    ]
    rows += [
        [
            r.nuisance,
            str(r.controls.total),
            str(r.controls.count),
            str(r.effects.total),
            str(r.effects.count),
            ", ".join(f"{name} {count}" for name, count in r.claimed) or "-",
        ]
        for r in rows_of
    ]
    return table(rows, right=(1, 2, 3, 4))


def _confusion(confusion: Confusion) -> str:
    """One line per hidden effect: how often it was named, and what was named instead."""
    if not confusion.rows:
        return ""
    rows = [["hidden", "cases", "right", "named instead"]]
    for k, hidden in enumerate(confusion.rows):
        named = Counter(
            {c: int(n) for c, n in zip(confusion.columns, confusion.counts[k], strict=True) if n}
        )
        right = named.pop(confusion.right_column(hidden), 0)
        others = ", ".join(f"{name} {count}" for name, count in named.most_common())
        rows.append([hidden, str(right + sum(named.values())), str(right), others or "-"])
    return table(rows, right=(1, 2))


def _reliability(bins: Sequence[Reliability]) -> str:
    if not bins:
        return ""
    rows = [["confidence", "mean", "findings", "right", "share", "95 % interval"]]
    rows += [
        [
            f"{r.low:g} to {r.high:g}",
            f"{r.mean:.3f}",
            str(r.share.total),
            str(r.share.count),
            _percent(r.share.value),
            _interval(r.share),
        ]
        for r in bins
    ]
    return table(rows, right=(1, 2, 3, 4, 5))


def _above(rows_of: Sequence[Above]) -> str:
    if not rows_of:
        return ""
    header = ["above", "findings", "recordings", "of controls", "right", "share", "at least", "bar"]
    rows = [header]
    rows += [
        [
            f"{r.confidence:g}",
            str(r.share.total),
            str(r.recordings),
            str(r.of_controls),
            str(r.share.count),
            _percent(r.share.value),
            _percent(r.lower),
            _percent(BARS[r.confidence]),
        ]
        for r in rows_of
    ]
    return table(rows, right=range(8))


def _left_out(rows_of: Sequence[LeftOut]) -> str:
    if not rows_of:
        return ""
    rows = [["nuisance", "findings", "right", "share", "95 % interval", "expected", "holds"]]
    rows += [
        [
            r.nuisance,
            str(r.share.total),
            str(r.share.count),
            _percent(r.share.value),
            _interval(r.share),
            _percent(r.expected),
            _mark(r.holds),
        ]
        for r in rows_of
    ]
    return table(rows, right=(1, 2, 3, 4, 5))


def _recall(rows_of: Sequence[Recall]) -> str:
    if not rows_of:
        return ""
    head = ["hidden", "too small", "detectable", "named", "tied", "share", "any", "bar"]
    rows = [[*head, "reached"]]
    rows += [
        [
            r.title,
            str(r.too_small),
            str(r.named.total),
            str(r.named.count),
            str(r.ties),
            _percent(r.named.value),
            str(r.found.count),
            _percent(RECALL_BAR),
            _mark(r.passed),
        ]
        for r in rows_of
    ]
    return table(rows, right=range(1, 8))


def _ratios(ratios: Sequence[Ratio]) -> str:
    if not ratios:
        return ""
    rows = [["recordings", "number", "mean", "median", "90 % below", f"within {RATIO_BAR:g}"]]
    rows += [
        [
            r.title,
            str(r.count),
            f"{r.mean:.4f}",
            f"{r.median:.4f}",
            f"{r.p90:.4f}",
            _percent(r.within.value),
        ]
        for r in ratios
    ]
    return table(rows, right=(1, 2, 3, 4, 5))


def _coverage(lines: Sequence[Coverage]) -> str:
    if not lines:
        return ""
    low, high = COVERAGE_BAR
    rows = [
        [
            "correlation",
            "recordings",
            "covered",
            "95 % interval",
            "profile",
            "ordinary least squares",
            f"between {_percent(low)} and {_percent(high)}",
        ]
    ]
    rows += [
        [
            f"{c.correlation:g}",
            str(c.recordings),
            _percent(c.share.value),
            _interval(c.share),
            _percent(c.profile.value) if c.profile.total else "-",
            _percent(c.ordinary.value) if c.ordinary.total else "-",
            _mark(c.passed),
        ]
        for c in lines
    ]
    return table(rows, right=range(6))


def _wrong(score: Score) -> str:
    if not score.failures:
        return ""
    rows = [["case", "found", "verdict", "what is wrong"]]
    rows += [
        [a.case.name, ", ".join(s.effect for s in a.steps) or "-", a.verdict or "-", j.problem]
        for a, j in score.failures[:MOST_LISTED]
    ]
    text = table(rows)
    rest = len(score.failures) - MOST_LISTED
    return text + (f"\n  and {rest} more (all are in answers.parquet)" if rest > 0 else "")
