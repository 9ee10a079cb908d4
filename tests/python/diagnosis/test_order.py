"""Which of several effects is named first, which are its ties, and what that costs its confidence.

Every number that the rules read is given here: no fit, no search.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import cast

import pytest
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.trials import ranking
from stribeck.diagnosis.trials.imitations import NARROW
from stribeck.diagnosis.trials.ranking import ALIKE, MATERIAL, NEGLIGIBLE, Ranked, ranked
from stribeck.diagnosis.trials.sifting import Doubted, Sifted
from stribeck.diagnosis.trials.trial import SIMPLEST, TIE, Trial, tie_weight
from stribeck.fitting.result import Fit

TRIED, LEAST = 20, 0.02


@dataclass(frozen=True)
class Fitted:
    """A fit by its errors. `square` is the held-out square over the compared samples."""

    rmse_held_out: float
    square: float
    loss_weight: object = None
    recording: None = None


@dataclass(frozen=True)
class Evident:
    """Evidence by its p value, of an effect outside the band of the motion."""

    p_value: float = 0.0
    fall_in_band: float = 0.0


@dataclass(frozen=True)
class Tried:
    """A trial by what the rules read: its parameters, and how much worse than the best it is."""

    effect: str
    parameters: int
    fit: Fitted
    statistic: float = 0.0
    rank: float = -1.0
    evidence: Evident = Evident()

    def only_delays(self, effect: str) -> bool:
        """No trial here lags."""
        return False


@dataclass(frozen=True)
class Apart:
    """The difference of two fits by its certainty."""

    certainty: float = 1.0


@dataclass
class World:
    """What the tests and searches say that the ranking asks, by effect."""

    #: (first, other) where `other` explains something beside `first`.
    adds: set[tuple[str, str]] = field(default_factory=set)
    friction: set[str] = field(default_factory=lambda: {"best", "other"})
    #: Effects that their thorough fit does not confirm; or does, and a rule demotes.
    failing: set[str] = field(default_factory=set)
    not_everywhere: set[str] = field(default_factory=set)
    demoted: set[str] = field(default_factory=set)
    #: Effects of which the recording does not determine how large they are.
    of_unknown_size: set[str] = field(default_factory=set)
    #: Effects that no recording like this tells from one of the catalog.
    alike: dict[str, tuple[str, ...]] = field(default_factory=dict)
    #: Structure that remains, and effects between which and the best it may decide.
    structure: float = 0.0
    undecided: set[str] = field(default_factory=set)
    #: How certainly the model predicts better with a finding.
    certainty: float = 1.0


@pytest.fixture
def world(monkeypatch: pytest.MonkeyPatch) -> Iterator[World]:
    """The ranking, asking this world alone."""
    made = World()

    class Judge(Sifted):
        @classmethod
        def of(cls, before: Fit, trials: object, least: float) -> Sifted:
            (trial,) = cast("list[Trial]", trials)
            if trial.effect in made.demoted:
                return Sifted((), (Doubted(trial, "judged again"),))
            return Sifted((trial,))

    answers = {
        "tie_statistic": lambda best, other: other.statistic,
        "adds_to": lambda first, other, *rest: (first.effect, other.effect) in made.adds,
        "difference": lambda before, after: Apart(made.certainty),
        "held_out_square": lambda fit, before: fit.square,
        "refined": lambda trial, before, seed: trial,
        "passes": lambda trial, *rest: trial.effect not in made.failing,
        "falls_on_all_samples": lambda before, trial: trial.effect not in made.not_everywhere,
        "has_known_size": lambda effect, fit: effect not in made.of_unknown_size,
        "is_friction": lambda effect: effect in made.friction,
        "where": lambda *rest: "here",
        "structure_share": lambda fit, floor: made.structure,
        "only_imitates": lambda trial, best, before: False,
        "is_undecided": lambda effects, fits, before, left: (
            left > 0.0 and effects[1] in made.undecided
        ),
        "alike": lambda effect, before, after: made.alike.get(effect, ()),
        "Sifted": Judge,
    }
    for name, answer in answers.items():
        monkeypatch.setattr(ranking, name, answer)
    yield made


#: The error before is 10 (square 100), the best removes 96 of it.
BEFORE = Fitted(10.0, 100.0)
BEST = Tried("best", 4, Fitted(2.0, 4.0))


def other(
    statistic: float, parameters: int = 4, square: float = 50.0, effect: str = "other"
) -> Tried:
    """An effect that brings half of the fall of the best, if nothing else is said."""
    return Tried(effect, parameters, Fitted(square**0.5, square), statistic, -0.5)


def order(
    *stand: Tried,
    before: Fitted = BEFORE,
    demoted: tuple[Tried, ...] = (),
    refused: tuple[Tried, ...] = (),
    floor: float | None = 0.0,
) -> Ranked:
    """The findings of these trials."""
    doubted = [
        tuple(Doubted(cast("Trial", trial), "a rule") for trial in trials)
        for trials in (demoted, refused)
    ]
    sift = Sifted(cast("tuple[Trial, ...]", stand), *doubted)
    return ranked(cast("Fit", before), sift, TRIED, LEAST, NoiseFloor(floor), 0)


def names(found: Ranked) -> list[str]:
    return [finding.effect for finding in found.findings]


@pytest.mark.parametrize(
    ("statistic", "parameters", "expected"),
    [
        (0.5 * SIMPLEST, 3, ["other", "best"]),  # as good and simpler
        (0.5 * SIMPLEST, 4, ["best", "other"]),  # as good and as simple: the smaller error
        (0.5 * SIMPLEST, 5, ["best", "other"]),
        (SIMPLEST, 3, ["other", "best"]),
        (1.5 * SIMPLEST, 3, ["other", "best"]),  # simpler, and the best adds nothing to it
        (1.5 * SIMPLEST, 4, ["best", "other"]),
        (TIE, 3, ["other", "best"]),
        (TIE + 0.1, 3, ["best", "other"]),
    ],
)
def test_of_equals_the_simplest_comes_first(
    world: World, statistic: float, parameters: int, expected: list[str]
) -> None:
    found = order(BEST, other(statistic, parameters))
    assert names(found) == expected
    tied = statistic <= TIE
    assert [f.indistinguishable_from for f in found.findings] == (
        [(expected[1],), (expected[0],)] if tied else [(), ()]
    )


def test_a_simpler_effect_does_not_replace_one_that_adds_to_it(world: World) -> None:
    world.adds = {("other", "best")}
    assert names(order(BEST, other(1.5, 3))) == ["best", "other"]
    # Within one standard error nothing is left to add.
    assert names(order(BEST, other(0.5, 3))) == ["other", "best"]


@pytest.mark.parametrize(
    ("friction", "expected"),
    [
        ({"best"}, ["best", "other"]),
        ({"other"}, ["other", "best"]),
        (set(), ["other", "best"]),
    ],
)
def test_what_is_no_friction_replaces_friction_within_one_error_only(
    world: World, friction: set[str], expected: list[str]
) -> None:
    world.friction = friction
    assert names(order(BEST, other(1.5, 3))) == expected
    assert names(order(BEST, other(0.5, 3))) == ["other", "best"]


def test_an_effect_with_nearly_the_same_fall_is_a_tie(world: World) -> None:
    """However significant the difference is, if it adds nothing; but it does not replace."""
    fall = BEFORE.square - BEST.fit.square
    enough = BEFORE.square - (ALIKE + 0.01) * fall
    too_little = BEFORE.square - (ALIKE - 0.01) * fall
    found = order(BEST, other(3.0, 3, enough))
    assert names(found) == ["best", "other"]
    assert found.findings[0].indistinguishable_from == ("other",)
    for no_tie in (other(3.0, 3, too_little), other(3.0, 5, enough)):
        assert order(BEST, no_tie).findings[0].indistinguishable_from == ()
    assert order(BEST, other(3.0, 4, enough)).findings[0].indistinguishable_from == ("other",)


def test_a_simpler_effect_of_unknown_size_wins_no_tie(world: World) -> None:
    world.of_unknown_size = {"other"}
    assert names(order(BEST, other(0.5, 3))) == ["best", "other"]
    world.of_unknown_size = {"best", "other"}
    assert names(order(BEST, other(0.5, 3))) == ["other", "best"]
    # It comes before one that may not replace the best at all.
    world.of_unknown_size = {"other"}
    third = Tried("third", 4, Fitted(1.1, 1.21), 1.5, -0.9)
    assert names(order(BEST, third, other(0.5, 5))) == ["best", "other", "third"]


@pytest.mark.parametrize("statistic", [0.5, 3.0])
def test_an_effect_that_adds_to_the_best_is_no_tie(world: World, statistic: float) -> None:
    world.adds = {("best", "other")}
    found = order(BEST, other(statistic, 3, 1.5))
    assert names(found) == ["best", "other"]
    assert [f.indistinguishable_from for f in found.findings] == [(), ()]


def test_ties_share_the_confidence_by_their_weights(world: World) -> None:
    third = Tried("third", 6, Fitted(1.1, 1.1**2), 1.0, -0.4, Evident(0.01))
    found = order(BEST, other(1.5, 5), third)
    total = 1.0 + tie_weight(1.5) + tie_weight(1.0)
    expected = {"best": 1.0, "other": tie_weight(1.5), "third": 0.8 * tie_weight(1.0)}
    assert {f.effect: f.confidence for f in found.findings} == pytest.approx(
        {effect: weight / total for effect, weight in expected.items()}
    )
    # The third is within one standard error of the best.
    assert found.findings[0].indistinguishable_from == ("third", "other")


@pytest.mark.parametrize("how", ["demoted", "refused"])
def test_effects_that_may_not_be_claimed_take_their_share(world: World, how: str) -> None:
    """Those that predict as well as the best; not those that add to it, or that weigh nothing."""
    light = 4.0
    assert tie_weight(light) < NEGLIGIBLE
    doubted = (other(1.0), other(0.5, effect="adding"), other(light, effect="light"))
    world.adds = {("best", "adding")}
    (first,) = order(BEST, **{how: doubted}).findings
    assert first.indistinguishable_from == ("other",)
    assert first.confidence == pytest.approx(1.0 / (1.0 + tie_weight(1.0)))


def test_a_demoted_effect_weighs_against_those_that_stand(world: World) -> None:
    (told,) = order(BEST, demoted=(other(1.0, square=5.0),)).demoted
    weight = tie_weight(1.0)
    assert told.confidence == pytest.approx(weight / (1.0 + weight))
    # Alone it is as likely as not.
    (told,) = order(demoted=(other(1.0, square=5.0),)).demoted
    assert told.confidence == 0.5 and told.indistinguishable_from == ()
    rare = Tried("other", 4, Fitted(1.0, 1.0), 1.0, -1.0, Evident(0.035))
    (told,) = order(demoted=(rare,)).demoted
    assert told.confidence == pytest.approx(1.0 - TRIED * 0.035)


def test_the_thorough_fit_must_pass_every_test(world: World) -> None:
    found = order(BEST, other(3.0))
    assert names(found) == ["best", "other"] and found.demoted == ()
    for said in (world.failing, world.not_everywhere):
        said.add("best")
        found = order(BEST, other(3.0))
        assert names(found) == ["other"] and found.demoted == ()
        said.clear()
    # One that passes the test of evidence and breaks a rule is told as such.
    world.demoted = {"best"}
    found = order(BEST, other(3.0))
    assert names(found) == ["other"]
    assert [(f.effect, f.demoted) for f in found.demoted] == [("best", "judged again")]
    # Where it does not pass, it is not told at all.
    world.failing = {"best"}
    found = order(BEST, other(3.0))
    assert names(found) == ["other"] and found.demoted == ()


def test_a_small_share_is_no_finding_unless_outliers_may_be_the_rest(world: World) -> None:
    left = 10.0 * (1.0 - 0.5 * MATERIAL) ** 0.5
    small = Tried("best", 4, Fitted(left, left**2))
    assert names(order(small)) == []
    assert names(order(small, floor=None)) == ["best"]
    robust = Fitted(10.0, 100.0, loss_weight=object())
    assert names(order(small, before=robust)) == ["best"]
    large = Tried("best", 4, Fitted(9.0, 81.0))
    assert names(order(large)) == ["best"]


def test_what_no_recording_tells_apart_halves_the_confidence(world: World) -> None:
    world.alike = {"best": ("twin",)}
    found = order(BEST, other(0.5))
    first, second = found.findings
    share = 1.0 / (1.0 + tie_weight(0.5))
    assert first.indistinguishable_from == ("other", "twin")
    assert first.confidence == pytest.approx(0.5 * share)
    assert second.confidence == pytest.approx(tie_weight(0.5) * share)
    assert second.indistinguishable_from == ("best",)


def test_no_finding_is_surer_than_that_it_predicts_better(world: World) -> None:
    world.certainty = 0.8
    (found,) = order(BEST).findings
    assert (found.weight, found.certainty, found.confidence) == (1.0, 0.8, 0.8)


def test_what_predicts_hardly_better_than_the_measurement_is_not_certain(world: World) -> None:
    trial = cast("Trial", BEST)
    sift = Sifted((trial,)).narrowed(trial, NARROW)
    found = ranked(cast("Fit", BEFORE), sift, TRIED, LEAST, NoiseFloor(1.0), 0).findings[0]
    assert found.confidence == NARROW


def test_a_named_tie_leaves_a_doubt(world: World) -> None:
    """It brings nearly the same fall, however far its error is in standard errors."""
    first, *_ = order(BEST, other(4.0, 3, 8.0)).findings
    assert first.indistinguishable_from == ("other",)
    assert first.confidence == pytest.approx(1.0 / (1.0 + tie_weight(TIE)))


@pytest.mark.parametrize(("structure", "confidence"), [(0.0, 1.0), (0.4, 0.5)])
def test_what_remains_may_decide_between_friction_and_another_cause(
    world: World, structure: float, confidence: float
) -> None:
    world.friction, world.structure, world.undecided = {"other"}, structure, {"other"}
    (first,) = order(BEST, refused=(other(3.0, 5),)).findings
    assert first.confidence == pytest.approx(confidence, abs=0.01)
    assert first.indistinguishable_from == (("other",) if structure else ())
