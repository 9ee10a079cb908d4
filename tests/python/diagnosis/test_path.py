"""The path of the loop: how it grows, and what is dropped from it."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from made_paths import path_through
from stribeck.base.errors import FitError
from stribeck.diagnosis.loop import path as made
from stribeck.diagnosis.loop.path import ImprovementPath, ImprovementStep
from stribeck.diagnosis.loop.search import Search, improvement_paths
from synthetic import joint, record


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> sb.Fit:
    """A joint with a load dependence, fitted without it."""
    load, v = joint(rows=2000)["load_torque"].to_numpy(), joint(rows=2000)["velocity"].to_numpy()
    frame = joint(0.15 * np.abs(load) * np.sign(v), rows=2000, noise=0.05)
    return sb.fit("coulomb", record(tmp_path_factory.mktemp("path"), frame), starts=2)


@pytest.fixture(scope="module")
def paths(base: sb.Fit) -> list[ImprovementPath]:
    """The path after each change."""
    return list(improvement_paths(base))


def test_the_path_grows_by_an_effect_at_a_time(base: sb.Fit, paths: list[ImprovementPath]) -> None:
    assert [len(path.steps) for path in paths] == [1, 1]
    assert paths[0].last.fit is base and paths[0].steps[0].finding is paths[0].last.findings[0]
    assert paths[-1].last.fit is paths[-1].current and not paths[-1].last.findings


@pytest.fixture(scope="module")
def detour(base: sb.Fit) -> ImprovementPath:
    """Direction, which is not needed, then load and offset."""
    return path_through(base, ("direction", "load", "offset"))


def test_without_an_effect_those_before_it_stay_as_they_are(detour: ImprovementPath) -> None:
    shorter = detour.without("load", seed=0)
    assert shorter.steps[0] is detour.steps[0]
    assert shorter.current.model.spec == "coulomb+direction+offset"
    assert shorter.steps[1].before is detour.steps[0].after
    gone = shorter.dropped[0]
    assert (gone.effect, gone.reason) == ("load", "superfluous once offset is in the model")
    assert gone.before is detour.steps[0].after
    found = shorter.steps[1].finding
    assert found.before is shorter.steps[1].before and found.fit is shorter.current
    assert found.rmse_held_out_after == shorter.current.rmse_held_out


def test_an_effect_without_which_nothing_can_be_fitted_stays(
    detour: ImprovementPath, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    search = Search(0, 0.01, 8, (), (), told.append)
    findings = [step.finding for step in detour.steps]
    assert search._shortened(detour, findings[:1])[0] is not None
    assert told == ["direction is superfluous: refitting the later effects without it"]

    def refuse(*_: object) -> ImprovementStep:
        raise FitError("the dry friction is negative")

    monkeypatch.setattr(made, "refitted", refuse)
    assert search._shortened(detour, findings[:1])[0] is None
    assert told[-1] == "direction stays: the dry friction is negative"


def test_the_end_of_a_path_is_pruned(detour: ImprovementPath) -> None:
    """The recording has a dependence on load alone; the effects needed least go first."""
    path, gone = detour, []
    search = Search(0, 0.01, 8, (), (), lambda sentence: None)
    for _ in range(3):
        findings = [step.finding for step in path.steps]
        shorter, path = search._shortened(path, findings)
        if shorter is None:
            break
        gone.append(shorter.dropped[-1])
        path = shorter
    assert path.current.model.spec == "coulomb+load"
    assert sorted(row.effect for row in gone) == ["direction", "offset"]
    assert ["no more than one standard error" in row.reason for row in gone] == [
        row.effect == "offset" for row in gone
    ]
