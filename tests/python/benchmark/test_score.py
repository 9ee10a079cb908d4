"""The scoreboard's figures, from answers that are known."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from stribeck.benchmark.answer import CaseAnswer, NamedEffect
from stribeck.benchmark.cases import Case
from stribeck.benchmark.coverage import Interval
from stribeck.benchmark.figures import calibration_figure, confusion_figure
from stribeck.benchmark.score import OUTSIDE, score
from stribeck.benchmark.share import Share
from stribeck.benchmark.text import score_text


def one(
    effect: str, named: str, confidence: float = 0.95, seed: int = 0, **rest: object
) -> CaseAnswer:
    case = Case("one", "open_loop", (effect,), seed, 1.0)
    made = CaseAnswer(
        case,
        hidden=(effect,),
        steps=(NamedEffect(named, confidence),),
        verdict="none",
        rmse_held_out=1.01,
        oracle_rmse=1.0,
    )
    return dataclasses.replace(made, **rest)


def covered(correlation: float, share: float, profile: float | None = None) -> list[CaseAnswer]:
    return [
        CaseAnswer(
            Case("coverage", "autoregressive", ("coulomb",), k, correlation=correlation),
            intervals=(
                Interval(
                    "coulomb_friction",
                    k < share * 100,
                    k < 20,
                    0.1,
                    0.01,
                    None if profile is None else k < profile * 100,
                ),
            ),
        )
        for k in range(100)
    ]


def test_groups_are_counted_against_their_bars() -> None:
    answers = [one("load", "load", seed=k) for k in range(19)] + [one("load", "gain", seed=19)]
    group, nothing_else = score(answers).groups
    assert group.share == Share(19, 20)
    assert group.bar == 0.95
    assert group.passed
    assert nothing_else.share == Share(19, 20) and not nothing_else.passed
    worse, _ = score([*answers, one("load", "gain", seed=20)]).groups
    assert not worse.passed


def test_an_effect_beside_the_hidden_one_is_counted() -> None:
    beside = (NamedEffect("load", 1.0), NamedEffect("position", 0.9))
    found, nothing_else = score([one("load", "load"), one("load", "load", steps=beside)]).groups
    assert found.share == Share(2, 2)
    assert nothing_else.share == Share(1, 2)


def test_the_confusion_matrix_holds_every_single_effect() -> None:
    none = CaseAnswer(Case("none", "open_loop", ("none",), 1), verdict="none")
    outside = CaseAnswer(
        Case("outside", "open_loop", ("humidity",), 2, 3.0),
        hidden=("humidity",),
        verdict="unexplained",
    )
    answers = [one("load", "load"), one("load", "gain"), none, outside]
    confusion = score(answers).confusion
    assert confusion.rows == ("load", "none", OUTSIDE)
    cells = {
        (row, column): int(confusion.counts[i, j])
        for i, row in enumerate(confusion.rows)
        for j, column in enumerate(confusion.columns)
    }
    assert {key: n for key, n in cells.items() if n} == {
        ("load", "load"): 1,
        ("load", "gain"): 1,
        ("none", "none"): 1,
        (OUTSIDE, "unexplained"): 1,
    }
    assert confusion.to_frame()["hidden"].to_list() == ["load", "none", OUTSIDE]


def test_an_effect_that_no_catalog_knows_has_its_row() -> None:
    confusion = score([one("flutter", "load")]).confusion
    assert confusion.rows == ("flutter",)
    assert confusion.columns[:2] == ("load", "flutter")


def test_confidence_is_compared_with_the_share_that_is_right() -> None:
    answers = [one("load", "load" if k < 9 else "gain", 0.92, seed=k) for k in range(10)]
    (reliability,) = score(answers).reliability
    assert (reliability.low, reliability.high) == (0.9, 0.95)
    assert reliability.mean == pytest.approx(0.92)
    assert reliability.share == Share(9, 10)
    low, high = reliability.share.interval
    # Wilson's interval of 9 in 10, as tables give it.
    assert (low, high) == pytest.approx((0.5958, 0.9821), abs=1e-4)


def test_a_tie_is_no_credit_for_the_confidence_of_the_name() -> None:
    tied = one("load", "gain", 0.6)
    tied = dataclasses.replace(tied, steps=(NamedEffect("gain", 0.6, ("load",)),))
    made = score([tied])
    assert made.groups[0].share.count == 1
    assert made.reliability[0].share.count == 0


def test_the_error_is_compared_with_the_oracle() -> None:
    answers = [one("load", "load", seed=k, rmse_held_out=1.0 + k / 100) for k in range(5)]
    (ratio,) = score(answers).ratios
    assert ratio.mean == pytest.approx(1.02)
    assert ratio.median == pytest.approx(1.02)
    assert ratio.within == Share(4, 5)


@pytest.mark.parametrize(("share", "passed"), [(0.89, False), (0.95, True), (0.99, False)])
def test_coverage_has_a_bar_on_both_sides(share: float, passed: bool) -> None:
    (line,) = score(covered(0.9, share)).coverage
    assert line.share.value == pytest.approx(share)
    assert line.ordinary.value == pytest.approx(0.2)
    assert line.passed is passed and line.profile.total == 0
    (profiled,) = score(covered(0.9, 0.95, share)).coverage
    assert profiled.profile.value == pytest.approx(share)
    assert profiled.passed is passed


def test_everything_is_printed_and_drawn() -> None:
    answers = [one("load", "load"), one("load", "gain"), *covered(0.99, 0.94)]
    made = score(answers)
    text = score_text(made)
    for part in ("one hidden effect, 1 x the noise", "gain 1", "94.0 %", "hidden load"):
        assert part in text
    shown = [t.get_text() for t in confusion_figure(made.confusion).axes[0].texts]
    assert shown == ["1", "1"]
    line = calibration_figure(made.reliability).axes[0].lines[0]
    np.testing.assert_array_equal(line.get_xdata(), [0, 1])


def test_nothing_gives_an_empty_board() -> None:
    made = score([])
    assert made.groups == made.reliability == made.ratios == made.coverage == ()
    assert score_text(made) == ""
