"""Nuisances distort what they name, and nothing else; the oracle knows them."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from stribeck.base.errors import StribeckError
from stribeck.benchmark import closed_loop
from stribeck.benchmark.answer import CaseAnswer, NamedEffect
from stribeck.benchmark.cases import WITH_NUISANCES, Case, cases
from stribeck.benchmark.distortion import EVERY, distorted, drawn
from stribeck.benchmark.judge import judge
from stribeck.benchmark.nuisances.table import NUISANCES
from stribeck.benchmark.sample import Sample
from stribeck.benchmark.score import score
from stribeck.benchmark.sealed.table import SEALED
from stribeck.benchmark.text import score_text

#: The channels that each nuisance distorts; every other one distorts the torque.
OF_CHANNELS = {
    "load_scale": {"load_torque"},
    "sensor_lag": {"load_torque"},
    "velocity_filter": {"position", "velocity", "acceleration"},
    "encoder_eccentricity": {"position", "velocity", "acceleration"},
    "lagging_thermometer": {"temperature"},
    "time_jitter": {"torque", "time"},
}


@pytest.fixture(scope="module")
def made() -> Sample:
    return closed_loop.sample(("none",), 8)


def moving(sample: Sample) -> np.ndarray:
    speed = np.abs(sample.frame["velocity"].to_numpy())
    return speed > 0.05 * speed.max()


@pytest.mark.parametrize("name", EVERY)
def test_a_nuisance_distorts_its_channels_alone(made: Sample, name: str) -> None:
    seen = distorted(made, (name,), 8)
    assert seen.truth["nuisances"] == [name]
    assert np.all(np.diff(seen.frame["time"].to_numpy()) > 0)
    if seen.frame.height < made.frame.height:
        assert name == "time_jitter" and seen.frame.height > 0.95 * made.frame.height
        return
    changed = {c for c in made.frame.columns if not seen.frame[c].equals(made.frame[c])}
    assert changed == OF_CHANNELS.get(name, {"torque"})
    assert all(np.all(np.isfinite(seen.frame[c].to_numpy())) for c in changed)


@pytest.mark.parametrize("name", EVERY)
def test_the_oracle_knows_what_acts_on_the_torque(made: Sample, name: str) -> None:
    """Its residual stays that of the noise, although the torque is further off."""
    seen = distorted(made, (name,), 8)
    on = moving(seen)
    left = (seen.frame["torque"].to_numpy() - seen.oracle.prediction)[on]
    assert np.sqrt(np.mean(left**2)) < 1.1 * made.truth["noise_rms"]
    assert all(column.shape == (seen.frame.height,) for column in seen.oracle.tangents.values())


def test_a_nuisance_is_the_same_with_others(made: Sample) -> None:
    alone = distorted(made, ("load_scale",), 8).frame["load_torque"]
    both = distorted(made, ("structural_mode", "load_scale"), 8).frame["load_torque"]
    assert alone.equals(both)


def test_names_are_drawn_once_for_a_recording() -> None:
    chosen = drawn(NUISANCES, 3, 5, ("time_jitter",))
    assert len(set(chosen)) == 3 and "time_jitter" in chosen
    assert chosen == drawn(NUISANCES, 3, 5, ("time_jitter",))
    assert {name for seed in range(200) for name in drawn(NUISANCES, 1, seed)} == set(NUISANCES)


def test_cases_with_nuisances_are_those_without() -> None:
    plain = [c for c in cases(1, quick=True) if c.group in WITH_NUISANCES]
    two = cases(1, quick=True, realism=2)
    assert [(c.generator, c.effects, c.seed) for c in plain] == [
        (c.generator, c.effects, c.seed) for c in two
    ]
    assert all(len(c.nuisances) == 2 and not set(c.nuisances) & set(SEALED) for c in two)
    assert all(c.nuisances == ("load_scale",) for c in cases(1, nuisance="load_scale"))
    assert all(set(c.nuisances) <= set(SEALED) for c in cases(1, sealed=True, realism=2))
    assert len({c.name for c in (*plain, *two)}) == len(plain) + len(two)
    with pytest.raises(StribeckError, match="did you mean 'load_scale'"):
        cases(1, nuisance="load_scal")


def test_channels_that_are_not_recorded() -> None:
    chosen = cases(1, quick=True, realism=1, without=("acceleration", "velocity"))
    assert all(c.without == ("acceleration", "velocity") for c in chosen)
    case = next(c for c in chosen if c.generator == "closed_loop" and c.group == "none")
    assert case.name.endswith("-no_acceleration-no_velocity-" + str(case.seed))
    whole = replace(case, without=()).make()
    left_out = case.make()
    assert left_out.frame.equals(whole.frame.drop("acceleration", "velocity"))
    assert np.array_equal(left_out.oracle.prediction, whole.oracle.prediction)
    stored = CaseAnswer(case).to_dict()
    assert CaseAnswer.from_dict(json.loads(json.dumps(stored))).case == case
    assert {c.group for c in cases(1, without=("velocity",))} == {
        *("one", "two", "three", "none", "limited", "outside")
    }
    with pytest.raises(StribeckError, match="'torque' cannot be left out"):
        cases(1, without=("torque",))


def answered(hidden: tuple[str, ...], *steps: NamedEffect) -> CaseAnswer:
    group = "one" if hidden else "none"
    case = Case(group, "open_loop", hidden or ("none",), 1, nuisances=("current_filter",))
    return CaseAnswer(case, hidden=hidden, steps=steps, verdict="none")


@pytest.mark.parametrize(
    ("answer", "problem"),
    [
        (answered((), NamedEffect("delay", 0.99)), ""),
        (answered((), NamedEffect("presliding", 0.6, ("delay",))), ""),
        (answered((), NamedEffect("presliding", 0.99)), "claimed presliding, which is not hidden"),
        (answered(("load",), NamedEffect("delay", 0.99), NamedEffect("load", 0.99)), ""),
        (answered(("load",), NamedEffect("delay", 0.99)), "missed load"),
        (
            answered(("load",), NamedEffect("load", 0.99), NamedEffect("position", 0.99)),
            "claimed position, which is not hidden",
        ),
    ],
)
def test_with_nuisances_other_causes_may_be_named(answer: CaseAnswer, problem: str) -> None:
    assert judge(answer).problem == problem


def test_the_score_has_a_row_for_each_nuisance() -> None:
    made = score([answered((), NamedEffect("presliding", 0.99)), answered(("load",))])
    (row,) = made.nuisances
    assert (row.nuisance, row.controls.count, row.effects.count) == ("current_filter", 0, 0)
    assert row.claimed == (("presliding", 1),)
    assert "presliding 1" in score_text(made)
