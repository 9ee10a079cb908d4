"""One start: where it sets out, where it ends, and what a failure leaves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import stribeck as sb
from stribeck.base.errors import FitError
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds, model_for
from stribeck.scale.study import trial as trial_module
from stribeck.scale.study.plan import Job
from stribeck.scale.study.trial import EFFORT, Trial, run_trials, start_model
from synthetic import joint, motion, record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve."""
    v = motion(1500)[2]
    bent = 1.5 * np.sign(v) * np.exp(-((v / 0.1) ** 2))
    return record(tmp_path_factory.mktemp("trial"), joint(bent, rows=1500))


def run(law: str, recording: sb.Recording, starts: int) -> list[Trial]:
    jobs = [Job(None, law, k) for k in range(starts)]
    return run_trials(jobs, recording, np.zeros(recording.rows, dtype=bool), seed=0)


def test_the_first_start_is_the_catalogs(recording: sb.Recording) -> None:
    model = model_for("bittencourt_a", recording)
    _, _, first = bounds(model, recording)
    made = start_model("bittencourt_a", recording, 0, seed=7)
    nonlinear = np.array([not p.linear for p in model.parameters])
    np.testing.assert_array_equal(made.values[nonlinear], first[nonlinear])
    assert np.isnan(made.values[~nonlinear]).all()


def test_random_starts_fill_the_bounds_and_come_from_the_seed(recording: sb.Recording) -> None:
    model = model_for("bittencourt_a", recording)
    lower, upper, _ = bounds(model, recording)
    k = model.names.index("stribeck_velocity")

    def speeds(seed: int) -> np.ndarray:
        return np.array(
            [start_model("bittencourt_a", recording, n, seed).values[k] for n in range(1, 201)]
        )

    drawn = speeds(0)
    assert drawn.min() >= lower[k] and drawn.max() <= upper[k]
    share = np.log(drawn / lower[k]) / np.log(upper[k] / lower[k])
    # Evenly by the logarithm: four sigmas of the mean of 200 uniform numbers.
    assert abs(share.mean() - 0.5) < 4.0 * np.sqrt(1.0 / 12.0 / 200.0)
    assert np.array_equal(drawn, speeds(0)) and not np.array_equal(drawn, speeds(1))


def test_the_best_of_the_starts_is_what_fit_finds(recording: sb.Recording) -> None:
    trials = run("bittencourt_a", recording, starts=6)
    best = min(trials, key=lambda t: t.rmse)
    fitted = sb.fit("bittencourt_a", recording, starts=6)
    assert best.rmse == pytest.approx(fitted.rmse, rel=1e-3)
    # The held-out figure is that of the linearised refits.
    assert best.rmse_held_out == pytest.approx(fitted.rmse_held_out, rel=0.02)
    again = sb.evaluate(best.model(recording), recording)
    assert again.rmse == pytest.approx(best.rmse, rel=1e-12)


@pytest.mark.parametrize("law", ["bittencourt_a", "lugre"])
def test_starts_that_come_together_end_where_each_would_alone(
    recording: sb.Recording, law: str
) -> None:
    together = run(law, recording, starts=12)
    led = [trial for trial in together if "merged with start" in trial.outcome]
    assert led, "no two starts came together"
    # Where a start ends depends on none after it.
    fewer = run(law, recording, starts=7)
    for one, other in zip(fewer, together, strict=False):
        assert replace(one, seconds=0.0) == replace(other, seconds=0.0)
    for trial in led:
        start = start_model(law, recording, trial.job.start, seed=0)
        alone = sb.fit(start, recording, starts=1, effort=EFFORT)
        if is_blind(alone.model, recording):
            # No start before it said that there is a curve to be seen.
            assert trial.rmse < alone.rmse
            continue
        assert trial.rmse == pytest.approx(alone.rmse, rel=1e-4)
        assert trial.evaluations < alone.evaluations


def is_blind(model: sb.Model, recording: sb.Recording) -> bool:
    """Whether the torque does not depend on a nonlinear parameter of `model` at all."""
    rows = np.flatnonzero(recording.moving)
    _, jacobian = Problem(recording, model, rows).linearise(model.values)
    nonlinear = np.array([not p.linear for p in model.parameters])
    return bool(np.any(np.all(jacobian[:, nonlinear] == 0.0, axis=0)))


def test_a_fit_that_fails_is_said_and_not_raised(
    recording: sb.Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise FitError("the bristle is slack at t = 3 s")

    monkeypatch.setattr(trial_module, "fit_each", refuse)
    made = run("lugre", recording, starts=2)[1]
    assert made.rmse is None and not made.converged
    assert made.failure == "the bristle is slack at t = 3 s"


def test_a_defect_in_one_fit_is_listed_with_its_kind(
    recording: sb.Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    def break_down(*_: object, **__: object) -> None:
        raise ZeroDivisionError("float division by zero")

    monkeypatch.setattr(trial_module, "fit_each", break_down)
    made = run("lugre", recording, starts=2)[1]
    assert "unexpected ZeroDivisionError" in made.failure and "report it" in made.failure
