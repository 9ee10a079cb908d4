"""The loop change by change: how a way grows, and what falls away from it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import stribeck as sb
from stribeck.base.errors import FitError
from stribeck.diagnosis import walk as loop
from stribeck.diagnosis.run import diagnose
from stribeck.diagnosis.walk import Step, Way, walk
from synthetic import joint, record


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> sb.Fit:
    """A joint with a load dependence, fitted without it."""
    load, v = joint(rows=2000)["load_torque"].to_numpy(), joint(rows=2000)["velocity"].to_numpy()
    frame = joint(0.15 * np.abs(load) * np.sign(v), rows=2000, noise=0.05)
    return sb.fit("coulomb", record(tmp_path_factory.mktemp("walk"), frame), starts=2)


@pytest.fixture(scope="module")
def ways(base: sb.Fit) -> list[Way]:
    """The whole way."""
    return list(walk(base))


def test_the_way_grows_by_an_effect_at_a_time(base: sb.Fit, ways: list[Way]) -> None:
    assert [len(way.steps) for way in ways] == [1, 1]
    assert ways[0].last.fit is base and ways[0].steps[0].finding is ways[0].last.findings[0]
    assert ways[-1].last.fit is ways[-1].current and not ways[-1].last.findings


@pytest.fixture(scope="module")
def detour(base: sb.Fit) -> Way:
    """Direction, which is not needed, then load and offset."""
    said = diagnose(base, brief=True)
    steps: list[Step] = []
    current = base
    for effect in ("direction", "load", "offset"):
        after = sb.add(current, effect, starts=1)
        finding = replace(said.findings[0], effect=effect, before=current, fit=after)
        steps.append(Step(finding, current, after))
        current = after
    return Way(base, said, tuple(steps))


def test_without_an_effect_those_before_it_stay_as_they_are(detour: Way) -> None:
    shorter = detour.without("load", seed=0)
    assert shorter.steps[0] is detour.steps[0]
    assert shorter.current.model.spec == "coulomb+direction+offset"
    assert shorter.steps[1].before is detour.steps[0].after
    gone = shorter.superfluous[0]
    assert (gone.effect, gone.because) == ("load", "offset")
    assert gone.before is detour.steps[0].after
    found = shorter.steps[1].finding
    assert found.before is shorter.steps[1].before and found.fit is shorter.current
    assert found.rmse_held_out_after == shorter.current.rmse_held_out


def test_an_effect_without_which_nothing_can_be_fitted_stays(
    detour: Way, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    assert loop._shortened(detour, 0.01, 0, told.append) is not None
    assert told == ["direction is no longer needed: walking the way again without it"]

    def refuse(*_: object) -> Step:
        raise FitError("the dry friction is negative")

    monkeypatch.setattr(loop, "_refitted", refuse)
    assert loop._shortened(detour, 0.01, 0, told.append) is None
    assert told[-1] == "direction stays: the dry friction is negative"
