"""Findings against their confidence, counted by recording."""

from __future__ import annotations

import pytest
from stribeck.benchmark.answer import CaseAnswer, NamedEffect
from stribeck.benchmark.cases import Case
from stribeck.benchmark.reliability import above, judged_findings, left_out, lower_bound
from stribeck.benchmark.score import score
from stribeck.benchmark.share import Share
from stribeck.benchmark.text import score_text


def made(seed: int, *steps: NamedEffect, nuisance: str = "load_scale") -> CaseAnswer:
    case = Case("one", "open_loop", ("load",), seed, 1.0, nuisances=(nuisance,))
    return CaseAnswer(case, hidden=("load",), steps=steps, verdict="none")


RIGHT, WRONG = NamedEffect("load", 0.999), NamedEffect("position", 0.95)


def test_among_nuisances_only_friction_is_judged() -> None:
    answers = [made(1, RIGHT, NamedEffect("delay", 1.0)), made(2, WRONG)]
    assert [(f.confidence, f.right) for f in judged_findings(answers)] == [
        (0.999, True),
        (0.95, False),
    ]
    control = CaseAnswer(
        Case("none", "open_loop", ("none",), 3), steps=(NamedEffect("delay", 0.95),)
    )
    (finding,) = judged_findings([control])
    assert finding.control and not finding.right


def test_findings_above_a_confidence_are_counted() -> None:
    answers = [made(k, RIGHT) for k in range(30)] + [made(30, WRONG)]
    low, high = above(judged_findings(answers))
    assert (low.confidence, low.share, low.recordings) == (0.9, Share(30, 31), 31)
    assert (high.confidence, high.share, high.recordings) == (0.99, Share(30, 30), 30)
    # No recording differs: Wilson's interval remains.
    assert high.lower == high.share.interval[0] < 1.0


def test_findings_of_one_recording_count_together() -> None:
    # Ten recordings of ten findings each, all right or all wrong.
    answers = [made(k, *[RIGHT if k < 8 else WRONG] * 10) for k in range(10)]
    findings = judged_findings(answers)
    # Binomial(10, 0.8) is 5 or less with a probability of 3.3 %, 4 or less with 0.6 %.
    assert lower_bound(findings) == pytest.approx(0.5, abs=0.01)
    assert Share(80, 100).interval[0] > 0.7


def test_a_nuisance_is_judged_by_the_others() -> None:
    answers = [made(k, RIGHT) for k in range(40)]
    answers += [made(100 + k, RIGHT, nuisance="sensor_lag") for k in range(5)]
    answers += [
        made(200 + k, NamedEffect("position", 0.999), nuisance="time_jitter") for k in range(9)
    ]
    rows = {row.nuisance: row for row in left_out(judged_findings(answers))}
    assert set(rows) == {"load_scale", "sensor_lag", "time_jitter"}
    assert rows["sensor_lag"].holds and rows["load_scale"].holds
    assert not rows["time_jitter"].holds
    # All 45 others are right: the mean of the posterior with Jeffreys' prior.
    assert rows["time_jitter"].expected == pytest.approx(45.5 / 46)
    said = score(answers)
    assert "share expected from all other recordings" in score_text(said)
    assert said.to_dict()["findings_above"][1]["recordings"] == 54
