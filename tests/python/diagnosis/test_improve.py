"""The way from a base model to noise: its steps, its JSON, and what it never adds."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.residual.noise_floor import noise_floor
from synthetic import joint, motion, record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve and a load dependence."""
    load, v = joint()["load_torque"].to_numpy(), motion()[2]
    curve = 1.2 / (1.0 + (v / 0.12) ** 2)
    frame = joint((curve + 0.06 * np.abs(load)) * np.sign(v), noise=0.05, rho=0.5)
    return record(tmp_path_factory.mktemp("improve"), frame)


@pytest.fixture(scope="module")
def improvement(recording: sb.Recording) -> sb.Improvement:
    """The whole way, once."""
    return sb.improve("coulomb", recording)


def test_both_causes_are_found_and_noise_is_left(improvement: sb.Improvement) -> None:
    assert {step.finding.effect for step in improvement.steps} == {"stribeck", "load"}
    assert improvement.final.rmse_held_out == pytest.approx(0.05, rel=0.05)
    assert improvement.stopped == "noise_floor"


def test_each_step_lowers_the_error(improvement: sb.Improvement) -> None:
    steps = improvement.steps
    for step in steps:
        assert step.after.rmse < step.before.rmse
        assert step.after.rmse_held_out < step.before.rmse_held_out
    for one, next_one in pairwise(steps):
        assert next_one.before is one.after
    assert steps[0].before is improvement.base and steps[-1].after is improvement.final
    # The same rows serve every step, and the target is never touched.
    for step in steps:
        assert np.array_equal(step.before.rows, step.after.rows)
        assert step.after.recording is improvement.base.recording


def test_no_error_is_below_the_noise(improvement: sb.Improvement) -> None:
    """An RMSE below the noise would be a defect."""
    assert improvement.final.rmse > 0.95 * 0.05
    assert improvement.noise_floor.value is not None
    assert improvement.noise_floor.value == pytest.approx(0.05, rel=0.1)


def test_contract_keys(improvement: sb.Improvement) -> None:
    answer = json.loads(json.dumps(improvement.to_dict()))
    assert {
        "base",
        "noise_floor",
        "steps",
        "final",
        "stopped",
        "untestable",
        "unexplained",
        "scored",
    } <= set(answer)
    for step in answer["steps"]:
        assert {
            "effect",
            "confidence",
            "rmse_before",
            "rmse_after",
            "rmse_held_out_before",
            "rmse_held_out_after",
            "indistinguishable_from",
            "parameters",
        } <= set(step)
    assert {"model", "rmse", "rmse_held_out", "relative_residual"} <= set(answer["final"])
    assert answer["base"] == "coulomb" and answer["final"]["model"] == "coulomb+stribeck+load"
    assert answer["stopped"] in ("noise_floor", "nothing_passes", "max_steps")
    assert improvement.to_frame().height == 1 + len(improvement.steps)


@pytest.mark.parametrize("seed", [21, 22])
def test_an_effect_that_the_data_lacks_is_never_added(tmp_path: Path, seed: int) -> None:
    """Only the base, and noise with a memory."""
    frame = joint(seed=seed, noise=0.1, rho=0.9)
    answer = sb.improve("coulomb", record(tmp_path, frame)).to_dict()
    assert answer["steps"] == [] and answer["stopped"] == "noise_floor"
    assert answer["final"]["model"] == "coulomb"


def test_a_base_with_the_effects_needs_nothing(
    recording: sb.Recording, improvement: sb.Improvement
) -> None:
    again = sb.improve(improvement.final.model, recording, starts=4)
    assert again.steps == ()


def test_fewest_steps_and_rejected_effects(recording: sb.Recording) -> None:
    none = sb.improve("coulomb", recording, most_steps=0)
    assert none.steps == () and none.stopped == "max_steps"
    assert "No effect was added to the model coulomb, as none may be; what it lacks" in str(none)
    without = sb.improve("coulomb", recording, rejected=("load", "stribeck"), most_steps=1)
    assert not {"load", "stribeck"} & {s.finding.effect for s in without.steps}


def test_progress_is_told(tmp_path: Path, plain: sb.Recording) -> None:
    told: list[str] = []
    sb.improve("coulomb", plain, progress=told.append)
    assert told and told[0] == "fitting coulomb"


@pytest.mark.slow
def test_seed_gives_the_same_bits(recording: sb.Recording, improvement: sb.Improvement) -> None:
    again = sb.improve("coulomb", recording)
    assert again.final.model.values.tobytes() == improvement.final.model.values.tobytes()
    assert [s.finding.confidence for s in again.steps] == [
        s.finding.confidence for s in improvement.steps
    ]


def test_add_refits_with_one_more_effect(recording: sb.Recording) -> None:
    before = sb.fit("coulomb", recording)
    after = sb.add(before, "load", recording)
    assert after.model.spec == "coulomb+load" and after.rmse < before.rmse
    addition = sb.Addition("load", before, after).to_dict()
    assert {
        "model",
        "effect",
        "rmse_before",
        "rmse_after",
        "rmse_held_out_before",
        "rmse_held_out_after",
        "parameters",
    } <= set(addition)
    # A wider model never fits worse than the one it contains. A bristle contains none: it is
    # carried by the mean velocity of a step, sgn v by the velocity at its end.
    # A thermometer that lags has no influence without friction that depends on temperature.
    for effect in set(sb.effects()["id"]) - {"presliding", "thermometer_lag"}:
        assert sb.add(before, effect, starts=2).rmse <= before.rmse * (1.0 + 1e-9), effect


def test_what_cannot_be_added_is_refused(recording: sb.Recording) -> None:
    fit = sb.fit("coulomb+load", recording)
    with pytest.raises(sb.SpecError, match="already"):
        sb.add(fit, "load")
    with pytest.raises(sb.SpecError, match="did you mean 'gravity'"):
        sb.add(fit, "gravty")


def test_ctrl_c_keeps_the_steps_that_were_made(recording: sb.Recording) -> None:
    """It comes while the model of the first step is diagnosed, or before there is a step."""
    told: list[str] = []

    def stopped_at(search: int) -> Callable[[str], None]:
        def tell(sentence: str) -> None:
            told.append(sentence)
            if (
                sentence.startswith("searching")
                and len([said for said in told if said.startswith("searching")]) == search
            ):
                raise KeyboardInterrupt

        return tell

    found = sb.improve("coulomb", recording, progress=stopped_at(2), keep_when_stopped=True)
    assert found.stopped == "interrupted" and len(found.steps) == 1
    assert found.final is found.steps[0].after
    assert "Stopped by Ctrl-C" in repr(found)
    fitted = [said for said in told if said.startswith("  fitted ")]
    assert fitted and fitted[0].startswith("  fitted 1 of ")
    for search, keep in ((1, True), (2, False)):
        told.clear()
        with pytest.raises(KeyboardInterrupt):
            sb.improve("coulomb", recording, progress=stopped_at(search), keep_when_stopped=keep)


def test_an_argument_of_another_name_is_refused(recording: sb.Recording) -> None:
    with pytest.raises(sb.SpecError, match="no argument `max_steps`; did you mean 'most_steps'"):
        sb.improve("coulomb", recording, max_steps=1)  # type: ignore[call-arg]
    with pytest.raises(sb.SpecError, match="no argument `fixed`; did you mean 'fix'"):
        sb.fit("coulomb", recording, fixed={"a1": 9.0})  # type: ignore[call-arg]


def test_a_diagnosis_states_the_floor_of_all_samples(recording: sb.Recording) -> None:
    fitted = sb.fit("coulomb", recording, starts=2)
    for brief in (True, False):
        found = sb.diagnose(fitted, sample_rows=recording.rows // 2, brief=brief)
        best = found.findings[0].fit
        assert best.recording is recording
        assert found.noise_floor == noise_floor(best)


@pytest.mark.slow
def test_what_remains_is_that_of_all_samples(recording: sb.Recording) -> None:
    """The models are identified on all samples, and the errors are theirs."""
    found = sb.improve("coulomb", recording, sample_rows=recording.rows // 2, starts=2)
    final = found.final.rmse_held_out
    assert final is not None and found.noise_floor.value is not None
    assert found.noise_floor == noise_floor(found.final)
    assert found.last.explainable is not None
    left = (1.0 - found.last.explainable.left) ** 0.5 * final
    assert found.last.explainable.rmse == pytest.approx(left, rel=0.1)
