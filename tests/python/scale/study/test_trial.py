"""One start: where it sets out, where it ends, and what a failure leaves."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from stribeck.base.errors import FitError
from stribeck.fitting.each_start import LEFT
from stribeck.scale.study import trial as trial_module
from stribeck.scale.study.plan import Job
from stribeck.scale.study.trial import Trial, run_trials
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


def test_the_best_of_the_starts_is_what_fit_finds(recording: sb.Recording) -> None:
    trials = run("bittencourt_a", recording, starts=6)
    best = min(trials, key=lambda t: t.rmse)
    fitted = sb.fit("bittencourt_a", recording, starts=6)
    assert best.rmse == pytest.approx(fitted.rmse, rel=1e-9)
    # The held-out figure is that of the linearised refits.
    assert best.rmse_held_out == pytest.approx(fitted.rmse_held_out, rel=0.02)
    again = sb.evaluate(best.model(recording), recording)
    assert again.rmse == pytest.approx(best.rmse, rel=1e-12)


@pytest.mark.parametrize("law", ["bittencourt_a", "lugre"])
def test_starts_that_come_together_end_as_their_leader(recording: sb.Recording, law: str) -> None:
    trials = run(law, recording, starts=12)
    merged = [trial for trial in trials if "merged with start" in trial.outcome]
    assert merged, "no two starts came together"
    for trial in merged:
        leader = trials[int(trial.outcome.split()[3].rstrip(":"))]
        assert trial.rmse == leader.rmse and trial.parameters == leader.parameters
        assert trial.job.start > leader.job.start
    # A start that was left has an error, but no held-out error.
    for trial in trials:
        if trial.outcome.endswith(LEFT):
            assert trial.rmse_held_out is None and not trial.converged


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
