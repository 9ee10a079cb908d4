"""What counts as right."""

from __future__ import annotations

import dataclasses

import pytest
from stribeck.benchmark.answer import CaseAnswer, NamedEffect
from stribeck.benchmark.cases import Case
from stribeck.benchmark.judge import judge


def answered(
    group: str, hidden: tuple[str, ...], *steps: NamedEffect, **rest: object
) -> CaseAnswer:
    case = Case(group, "open_loop", hidden or ("none",), 1, 1.0)
    return dataclasses.replace(CaseAnswer(case, hidden=hidden, steps=steps, verdict="none"), **rest)


LOAD, STRIBECK = NamedEffect("load", 0.9), NamedEffect("stribeck", 0.99)
TIE = NamedEffect("gain", 0.6, ("load",))


@pytest.mark.parametrize(
    ("steps", "right", "exact", "named"),
    [
        ((LOAD,), True, True, "load"),
        ((TIE,), True, True, "load"),
        ((LOAD, STRIBECK), True, False, "load"),
        ((STRIBECK, LOAD), False, False, "stribeck"),
        ((), False, False, "none"),
    ],
)
def test_one_effect_is_right_when_it_comes_first(
    steps: tuple[NamedEffect, ...], right: bool, exact: bool, named: str
) -> None:
    judgement = judge(answered("one", ("load",), *steps))
    assert (judgement.right, judgement.exact, judgement.named) == (right, exact, named)
    assert bool(judgement.problem) != right


def test_an_effect_may_come_after_the_simpler_one_that_it_contains() -> None:
    quadrant = NamedEffect("quadrant", 0.9)
    both = answered("one", ("quadrant",), LOAD, quadrant, implied=("load",))
    assert judge(both).right
    assert judge(both).exact
    only_load = answered("one", ("quadrant",), LOAD, implied=("load",))
    assert not judge(only_load).right
    assert judge(only_load).named == "load"


@pytest.mark.parametrize("group", ["two", "three"])
def test_several_effects_must_all_be_found_and_nothing_else(group: str) -> None:
    hidden = ("load", "stribeck")
    assert judge(answered(group, hidden, STRIBECK, TIE)).right
    assert judge(answered(group, hidden, STRIBECK)).problem == "missed load"
    further = judge(answered(group, hidden, STRIBECK, LOAD, NamedEffect("drift", 0.9)))
    assert further.problem == "drift is not hidden"


def test_one_tie_stands_for_one_effect() -> None:
    tie = NamedEffect("load", 0.5, ("gain",))
    assert judge(answered("two", ("load", "gain"), tie)).problem == "missed gain"


def test_nothing_hidden_asks_for_the_verdict_none() -> None:
    assert judge(answered("none", ())).right
    assert not judge(answered("none", (), LOAD)).right
    unexplained = judge(answered("none", (), verdict="unexplained"))
    assert not unexplained.right
    assert unexplained.named == "unexplained"


def test_what_a_motion_cannot_show_is_listed_and_not_claimed() -> None:
    cannot = {"cannot_show": ("temperature_dry", "temperature_viscous")}
    listed = {**cannot, "untestable": ("temperature_dry", "temperature_viscous")}
    assert judge(answered("limited", ("temperature_dry",), **listed)).right
    silent = judge(answered("limited", (), **cannot))
    assert "temperature_dry is not listed as untestable" in silent.problem
    claimed = judge(answered("limited", (), NamedEffect("temperature_dry", 0.9), **listed))
    assert "claimed temperature_dry" in claimed.problem


def test_what_is_outside_the_library_is_unexplained() -> None:
    assert judge(answered("outside", ("humidity",), verdict="unexplained")).right
    assert not judge(answered("outside", ("humidity",))).right
    named = judge(
        answered("outside", ("humidity",), NamedEffect("drift", 0.9), verdict="unexplained")
    )
    assert not named.right
    assert named.named == "drift"


def test_a_failure_is_wrong_and_says_why() -> None:
    judgement = judge(answered("none", (), failure="FitError: too few rows"))
    assert not judgement.right
    assert judgement.problem == "FitError: too few rows"
