"""Are findings right as often as their confidence says?

A finding is right if its effect is hidden in the recording, or part of one that is. Among nuisances
only findings of friction are judged: a nuisance is another cause itself.

Several findings of one recording are right or wrong together, so that bounds come from resampled
recordings (cluster bootstrap; Efron and Tibshirani 1993, chapter 8), or from Wilson's interval
where that is wider, as it is where all findings are right.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from stribeck.benchmark.answer import CaseAnswer
from stribeck.benchmark.distortion import EVERY
from stribeck.benchmark.judge import is_right
from stribeck.benchmark.share import Share
from stribeck.effect.describe import is_friction

#: Edges of the bins of `confidence`.
CONFIDENCE_EDGES = (0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0)
#: Confidences above which findings are counted, and the share of them that must be right.
BARS = {0.9: 0.90, 0.99: 0.985}
#: Number of resampled sets of recordings, and the share of them below the lower bound.
RESAMPLED, BELOW = 2000, 0.025


@dataclass(frozen=True)
class Judged:
    """One finding of the benchmark.

    Attributes
    ----------
    recording
        Name of the case.
    nuisances
        Those of the recording.
    control
        Whether nothing is hidden in the recording.
    """

    recording: str
    nuisances: tuple[str, ...]
    control: bool
    confidence: float
    right: bool


@dataclass(frozen=True)
class Reliability:
    """Findings whose confidence is in one bin, and how many of them are correct."""

    low: float
    high: float
    mean: float
    share: Share

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "from": self.low,
            "to": self.high,
            "mean_confidence": self.mean,
            **self.share.to_dict(),
        }


@dataclass(frozen=True)
class LeftOut:
    """Findings among one nuisance, and what those of all other recordings lead to expect.

    Attributes
    ----------
    share
        Those that are right.
    expected
        Share that the bins of the other recordings predict for the same confidences.
    """

    nuisance: str
    share: Share
    expected: float

    @property
    def holds(self) -> bool:
        """Whether no smaller share of the findings is right than expected, beyond chance."""
        return self.expected <= self.share.interval[1]

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "nuisance": self.nuisance,
            **self.share.to_dict(),
            "expected_from_others": self.expected,
            "holds": self.holds,
        }


@dataclass(frozen=True)
class Above:
    """Findings above a confidence.

    Attributes
    ----------
    confidence
        The findings counted have a larger one.
    share
        Those that are right.
    lower
        Lower bound of the share at 97.5 %, the recordings being drawn anew.
    recordings
        Number of recordings with such a finding.
    of_controls
        Findings from recordings with nothing hidden.
    """

    confidence: float
    share: Share
    lower: float
    recordings: int
    of_controls: int

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "above": self.confidence,
            **self.share.to_dict(),
            "lower_bound_by_recording": self.lower,
            "recordings": self.recordings,
            "findings_of_controls": self.of_controls,
            "bar": BARS.get(self.confidence),
        }


def judged_findings(answers: Iterable[CaseAnswer]) -> list[Judged]:
    """The findings that can be judged, in the order of the recordings."""
    return [
        Judged(
            a.case.name,
            a.case.nuisances,
            a.case.group == "none",
            step.confidence,
            is_right(step, a),
        )
        for a in answers
        if a.case.group != "coverage"
        for step in a.steps
        if not a.case.nuisances or is_friction(step.effect)
    ]


def in_bins(findings: Sequence[Judged]) -> Iterator[Reliability]:
    """One row for each bin of the confidence that has findings."""
    for low, high in pairwise(CONFIDENCE_EDGES):
        of = [f for f in findings if _bin(f.confidence) == CONFIDENCE_EDGES.index(low)]
        if of:
            mean = float(np.mean([f.confidence for f in of]))
            yield Reliability(low, high, mean, share_right(of))


def left_out(findings: Sequence[Judged]) -> Iterator[LeftOut]:
    """One row for each nuisance: its findings against the bins of all other recordings."""
    for name in EVERY:
        of = [f for f in findings if name in f.nuisances]
        others = [f for f in findings if name not in f.nuisances]
        if not of or not others:
            continue
        calibrated = _calibrated(others)
        expected = float(np.mean([calibrated[_bin(f.confidence)] for f in of]))
        yield LeftOut(name, share_right(of), expected)


def _bin(confidence: float) -> int:
    return min(
        int(np.searchsorted(CONFIDENCE_EDGES, confidence, side="right")) - 1,
        len(CONFIDENCE_EDGES) - 2,
    )


def _calibrated(findings: Sequence[Judged]) -> NDArray[np.float64]:
    """Share that is right in each bin, by the mean of Jeffreys' posterior."""
    bins = np.array([_bin(f.confidence) for f in findings])
    right = np.array([f.right for f in findings])
    count = len(CONFIDENCE_EDGES) - 1
    total = np.bincount(bins, minlength=count)
    return np.asarray((np.bincount(bins[right], minlength=count) + 0.5) / (total + 1.0))


def above(findings: Sequence[Judged]) -> Iterator[Above]:
    """One row for each confidence of `BARS`."""
    for least in BARS:
        of = [f for f in findings if f.confidence > least]
        if of:
            yield Above(
                least,
                share_right(of),
                lower_bound(of),
                len({f.recording for f in of}),
                sum(f.control for f in of),
            )


def share_right(findings: Sequence[Judged]) -> Share:
    """How many of the findings are right."""
    return Share(sum(f.right for f in findings), len(findings))


def lower_bound(findings: Sequence[Judged]) -> float:
    """Lower bound of the share that is right, at 97.5 %."""
    right, total = _by_recording(findings)
    rng = np.random.default_rng(0)
    drawn = rng.integers(0, total.size, (RESAMPLED, total.size))
    shares = right[drawn].sum(axis=1) / total[drawn].sum(axis=1)
    return min(float(np.quantile(shares, BELOW)), share_right(findings).interval[0])


def _by_recording(findings: Sequence[Judged]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    names = {name: k for k, name in enumerate(dict.fromkeys(f.recording for f in findings))}
    recording = np.array([names[f.recording] for f in findings])
    right = np.array([f.right for f in findings])
    return np.bincount(recording[right], minlength=len(names)), np.bincount(recording)
