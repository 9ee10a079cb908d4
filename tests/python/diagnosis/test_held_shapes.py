"""A shape that a recording does not determine is held at its usual value."""

from __future__ import annotations

import pytest
import stribeck as sb
from stribeck.benchmark.cases import Case
from stribeck.diagnosis.plausibility.shape import usual_shape
from stribeck.diagnosis.trials.screening import screened
from stribeck.diagnosis.trials.trial import Trial, try_effect
from stribeck.effect.describe import where


@pytest.fixture(scope="module")
def before(tmp_path_factory: pytest.TempPathFactory) -> sb.Fit:
    """A joint with a Stribeck curve whose flanks are longer than those of the law."""
    path = tmp_path_factory.mktemp("held") / "recording.parquet"
    hidden = ("stribeck", "temperature_viscous")
    nuisances = ("current_filter", "velocity_filter")
    case = Case("two", "open_loop", hidden, 422155000, 2.0, nuisances=nuisances)
    case.make().frame.write_parquet(path)
    return sb.fit("coulomb+temperature_viscous", sb.read(path))


@pytest.fixture(scope="module")
def trial(before: sb.Fit) -> Trial:
    """The trial of a Stribeck curve."""
    found = screened(before, "stribeck")
    assert found is not None
    made = try_effect(before, found)
    assert made is not None
    return made


def test_a_free_shape_would_end_at_its_bound_below_what_is_scored(before: sb.Fit) -> None:
    free = sb.add(before, "stribeck", starts=4)
    assert list(usual_shape("stribeck", free)) == ["stribeck_exponent"]
    assert free.model.value("stribeck_velocity") < 0.2 * before.recording.velocity_threshold


def test_it_is_held_and_the_rest_is_determined(before: sb.Fit, trial: Trial) -> None:
    model = trial.fit.model
    assert model.limits["stribeck_exponent"] == (2.0, 2.0)
    assert model.value("stribeck_velocity") > before.recording.velocity_threshold
    assert trial.evidence.fall > 0.08
    assert usual_shape("stribeck", trial.fit) == {}


def test_the_sentence_says_so(before: sb.Fit, trial: Trial) -> None:
    said = where("stribeck", before, trial.fit)
    assert said.endswith(
        ". This data does not determine the shape: it is held, stribeck_exponent at 2"
    )


def test_what_the_user_holds_is_not_said(before: sb.Fit) -> None:
    chosen = sb.fit("coulomb", before.recording, starts=1)
    held = sb.fit("coulomb+stribeck", before.recording, starts=2, fix={"stribeck_exponent": 2.0})
    asked = sb.improve(
        "coulomb", before.recording, starts=1, most_steps=0, fix={"stribeck_exponent": 2.0}
    )
    assert "This data does not determine" in where("stribeck", chosen, held)
    assert "This data does not determine" not in where("stribeck", asked.base, held)


def test_bounds_of_the_user_stand(before: sb.Fit) -> None:
    bounds = {"stribeck_exponent": (0.5, 4.0)}
    begun = sb.improve(
        "coulomb+temperature_viscous", before.recording, starts=1, most_steps=0, bounds=bounds
    )
    found = screened(begun.base, "stribeck")
    made = None if found is None else try_effect(begun.base, found)
    assert made is not None
    assert made.fit.model.limits["stribeck_exponent"] == (0.5, 4.0)
