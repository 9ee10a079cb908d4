"""The loop beyond single steps: what is tried, what gives way, what is not let in."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.loop import provisional
from stribeck.diagnosis.loop import search as search_module
from stribeck.diagnosis.loop.exchange import exchanges
from stribeck.diagnosis.loop.path import ImprovementPath
from stribeck.diagnosis.loop.provisional import judged, on_trial
from stribeck.diagnosis.loop.search import Search
from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.trials.evidence import evidence
from stribeck.diagnosis.trials.imitations import NARROW, standing
from stribeck.diagnosis.trials.sifting import Sifted
from stribeck.diagnosis.trials.trial import (
    TIE,
    Trial,
    is_uncertain,
    passes,
    passes_in_one_block,
)
from synthetic import joint, joint_with_stribeck_curve, motion, record

T, Q, V, A = motion()
LOAD = joint()["load_torque"].to_numpy()
STRUCTURE = Unexplained(0.5, "everywhere", 0.5)


def warm_up(share: float) -> np.ndarray:
    """The torque of an amplifier whose gain settles within a third of the recording."""
    return share * joint()["torque"].to_numpy() * np.exp(-T / 10.0)


@pytest.fixture(scope="module")
def doubtful(tmp_path_factory: pytest.TempPathFactory) -> sb.Diagnosis:
    """A diagnosis that demotes the effect it would name: the load, as if it were imitated."""
    extra = 0.15 * np.abs(LOAD) * np.sign(V)
    recording = record(tmp_path_factory.mktemp("search"), joint(extra))
    found = sb.diagnose(sb.fit("coulomb", recording, starts=2), brief=True)
    (load,) = [finding for finding in found.findings if finding.effect == "load"]
    told = replace(load, demoted="a torque on a wrong scale explains it as well", weight=0.4)
    return replace(found, findings=(), demoted=(told,), unexplained=STRUCTURE)


def test_what_is_demoted_is_tried_where_structure_remains(doubtful: sb.Diagnosis) -> None:
    tried = on_trial(doubtful)
    assert tried is not None and tried.effect == "load" and tried.demoted is None
    assert on_trial(replace(doubtful, unexplained=Unexplained(0.05, None))) is None
    assert on_trial(replace(doubtful, demoted=())) is None
    # A cause in the measurement needs no trial.
    gain = replace(doubtful.demoted[0], effect="gain")
    assert on_trial(replace(doubtful, demoted=(gain,))) is None


def test_what_gains_in_one_block_alone_is_tried_too(doubtful: sb.Diagnosis) -> None:
    """Elsewhere another cause may be large."""
    load = doubtful.demoted[0]
    held = replace(load, demoted=None)
    hidden = replace(doubtful, demoted=(), in_one_block=(held,))
    tried = on_trial(hidden)
    assert tried is not None and tried.effect == "load"
    assert on_trial(replace(hidden, unexplained=Unexplained(0.05, None))) is None

    found = evidence(load.before, load.fit)
    trial = Trial("load", load.fit, found)
    assert passes(trial, 20, 0.01) and not passes_in_one_block(trial, 20, 0.01)
    elsewhere = replace(trial, evidence=replace(found, everywhere=False))
    assert not passes(elsewhere, 20, 0.01) and passes_in_one_block(elsewhere, 20, 0.01)
    small = replace(found, everywhere=False, fall=0.005, fall_in_band=0.005)
    assert not passes_in_one_block(replace(trial, evidence=small), 20, 0.01)
    # It must pass in the end.
    assert judged(held, load.fit, 0.01, seed=0) is not None
    assert judged(held, load.fit, 2.0, seed=0) is None


def test_what_gains_no_more_than_chance_may_is_tried_too(doubtful: sb.Diagnosis) -> None:
    """Another cause may add as much as noise; this needs no structure."""
    load = replace(doubtful.demoted[0], demoted=None)
    hidden = replace(doubtful, demoted=(), uncertain=(load,), unexplained=Unexplained(0.0, None))
    tried = on_trial(hidden)
    assert tried is not None and tried.effect == "load"

    found = evidence(load.before, load.fit)
    trial = Trial("load", load.fit, found)
    assert not is_uncertain(trial, 20, 0.01)
    chance = replace(found, p_value=0.001)
    assert is_uncertain(replace(trial, evidence=chance), 20, 0.01)
    for change in (
        {"p_value": 0.0004},
        {"fall": 0.005, "fall_in_band": 0.005},
        {"fall_in_band": 0.0},
    ):
        assert not is_uncertain(replace(trial, evidence=replace(chance, **change)), 20, 0.01)
    assert not is_uncertain(replace(trial, evidence=replace(chance, everywhere=False)), 20, 0.01)


def test_what_takes_the_place_of_an_effect_on_trial_stays_where_it_stands(
    doubtful: sb.Diagnosis, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = on_trial(doubtful)
    assert told is not None
    other = replace(told, effect="position")
    path = ImprovementPath(doubtful.fit, doubtful)
    search = Search(0, 0.01, 8, (), (), lambda sentence: None)

    def ends(grown: ImprovementPath) -> list[str]:
        monkeypatch.setattr(Search, "_ends", lambda self, path: iter([grown]))
        return [step.finding.effect for step in search._tried(path, other).steps]

    assert ends(path.with_finding(told)) == ["load"]
    # A model that predicts no better, or an effect that does not stand in it, is left.
    assert ends(path.with_finding(replace(told, fit=doubtful.fit))) == []
    monkeypatch.setattr(search_module, "judged", lambda *_: None)
    assert ends(path.with_finding(told)) == []


def test_what_is_weak_is_not_tried(doubtful: sb.Diagnosis, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(provisional, "weak", lambda claim: "only 3 moves carry it")
    assert on_trial(doubtful) is None


def test_an_effect_on_trial_stays_where_it_stands(doubtful: sb.Diagnosis) -> None:
    tried = on_trial(doubtful)
    assert tried is not None
    stands = judged(tried, tried.fit, 0.01, seed=0)
    assert stands is not None and stands.weight == NARROW


def test_an_effect_on_trial_goes_where_it_does_not_stand(
    doubtful: sb.Diagnosis, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(provisional, "standing", lambda *_: Sifted())
    tried = on_trial(doubtful)
    assert tried is not None
    assert judged(tried, tried.fit, 0.01, seed=0) is None


@pytest.mark.slow
def test_the_search_returns_to_the_path_before_the_trial(
    doubtful: sb.Diagnosis, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    search = Search(0, 0.01, 8, (), (), told.append)
    path = ImprovementPath(doubtful.fit, doubtful)
    kept = list(search.paths(path))[-1]
    assert [step.finding.effect for step in kept.steps] == ["load"] and kept.last.demoted == ()
    monkeypatch.setattr(search_module, "judged", lambda *_: None)
    monkeypatch.setattr(search_module, "other_beginnings", lambda *_: ())
    back = list(search.paths(path))[-1]
    assert back.steps == () and back.last.demoted == doubtful.demoted
    assert told[-1] == "load does not stand beside the others: going back"


def test_what_is_on_trial_displaces_another_effect_only_in_a_better_model(
    doubtful: sb.Diagnosis, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = on_trial(doubtful)
    assert told is not None
    grown = ImprovementPath(doubtful.fit, doubtful).with_finding(told)
    monkeypatch.setattr(Search, "_ends", lambda self, path: iter([grown]))
    search = Search(0, 0.01, 8, (), (), lambda sentence: None)

    def ends(fitted: sb.Fit) -> list[str]:
        """The effects of a path to `fitted` by another effect, after the trial."""
        other = replace(told, effect="gain", fit=fitted)
        path = search._tried(ImprovementPath(doubtful.fit, doubtful).with_finding(other), told)
        return [step.finding.effect for step in path.steps]

    assert ends(doubtful.fit) == ["load"]
    assert ends(told.fit) == ["gain"]


def test_an_exchange_admits_no_friction_that_an_amplifier_imitates(
    tmp_path: Path, doubtful: sb.Diagnosis
) -> None:
    """Friction that seems to drift, where the torque's gain settles."""
    without = sb.fit("coulomb", record(tmp_path, joint(warm_up(0.06))), starts=2)
    after = sb.add(without, "drift", starts=2)
    trial = Trial("drift", after, evidence(without, after))
    assert standing(without, trial, (), 0.01).stand == ()
    fitted = sb.add(without, "gain", starts=2)
    gain = replace(doubtful.demoted[0], effect="gain", demoted=None, before=without, fit=fitted)
    found = exchanges([gain], [("drift",)], (), fitted, (), 0.01, 0)
    assert found.best is None and not found.ties


def test_a_lag_gives_way_where_its_simpler_part_and_another_effect_do_better(
    tmp_path: Path,
) -> None:
    """A Stribeck curve that lags, and a spring that explains more than the lag."""
    slow = np.roll(np.abs(V), 6)
    curve = 1.5 * np.sign(V) * np.exp(-((slow / 0.15) ** 2))
    before = sb.fit("coulomb", record(tmp_path, joint(curve + 2.5 * Q)), starts=2)
    lag = sb.add(before, "frictional_lag", starts=2)
    some = sb.diagnose(before, brief=True).findings[0]
    finding = replace(some, effect="frictional_lag", before=before, fit=lag)
    assert exchanges([finding], [()], (), lag, (), 0.01, 0).best is None
    best = exchanges([finding], [()], ("spring",), lag, (), 0.01, 0).best
    assert best is not None and best.by.effect == "stribeck"
    assert best.by.fit.model.effects == ("stribeck",) and best.apart > TIE


def test_effects_are_tried_again_once_an_imitation_has_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beside it, two effects that show only together may have been tried in vain."""
    tried: list[str] = []

    def beyond(_: Search, path: ImprovementPath, trials: object) -> ImprovementPath:
        tried.append(path.current.model.spec)
        return path

    monkeypatch.setattr(Search, "_beyond", beyond)
    monkeypatch.setattr(search_module, "trials_of", lambda found: [found])
    monkeypatch.setattr(search_module, "imitations", lambda found: [f.effect for f in found])
    sb.improve("coulomb", record(tmp_path, joint_with_stribeck_curve()), starts=1)
    assert tried[0] == "coulomb+stribeck"
    assert len(tried) == 2 and "stribeck" not in tried[1]
