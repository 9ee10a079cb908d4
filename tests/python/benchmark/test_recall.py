"""What the generator's own model detects, and how much of it is named."""

from __future__ import annotations

import numpy as np
import pytest
from stribeck.benchmark.answer import CaseAnswer, NamedEffect
from stribeck.benchmark.cases import Case
from stribeck.benchmark.distortion import distorted
from stribeck.benchmark.open_loop import sample
from stribeck.benchmark.oracle import detection
from stribeck.benchmark.recall import recalls
from stribeck.benchmark.sample import Oracle, Sample
from stribeck.benchmark.score import score
from stribeck.benchmark.share import Share
from stribeck.benchmark.text import score_text


def linear_oracle(shapes: dict[str, np.ndarray], **rest: object) -> Oracle:
    prediction = np.sum(list(shapes.values()), axis=0)
    return Oracle(prediction, shapes, {"load": shapes["load"]}, **rest)


@pytest.mark.parametrize("noise", [0.1, 1.0])
def test_detection_is_the_size_over_its_standard_error(noise: float) -> None:
    rng = np.random.default_rng(1)
    n = 20_000
    direction = np.sign(np.sin(np.arange(n) / 50.0))
    effect = 0.05 * rng.standard_normal(n)
    # Only the part of its torque that dry friction cannot replace counts.
    oracle = linear_oracle({"coulomb": direction, "load": effect + 2.0 * direction})
    torque = oracle.prediction + noise * rng.standard_normal(n)
    z = detection(oracle, "load", torque, np.ones(n, bool))
    assert z == pytest.approx(np.linalg.norm(effect) / noise, rel=0.15)


def test_an_effect_that_a_nuisance_replaces_is_not_detected() -> None:
    rng = np.random.default_rng(2)
    shapes = {"coulomb": np.sign(rng.standard_normal(5000)), "load": rng.standard_normal(5000)}
    torque = np.sum(list(shapes.values()), axis=0) + 0.1 * rng.standard_normal(5000)
    rows = np.ones(5000, bool)
    assert detection(linear_oracle(shapes), "load", torque, rows) > 100.0
    known = linear_oracle(shapes, nuisances=(3.0 * shapes["load"],))
    assert detection(known, "load", torque, rows) == 0.0


@pytest.fixture(scope="module")
def wrong_gain() -> Sample:
    return sample(("gain",), 11)


def test_a_wrong_scale_of_the_load_hides_a_wrong_torque_constant(wrong_gain: Sample) -> None:
    def z(made: Sample) -> float:
        frame = made.frame
        moving = np.abs(frame["velocity"].to_numpy()) > 5 * made.truth["velocity_noise"]
        return detection(made.oracle, "gain", frame["torque"].to_numpy(), moving)

    assert z(wrong_gain) > 20.0
    assert z(distorted(wrong_gain, ("current_filter",), 11)) > 20.0
    assert z(distorted(wrong_gain, ("load_scale",), 11)) < 5.0


def answered(
    z: float,
    *steps: NamedEffect,
    nuisances: tuple[str, ...] = (),
    apart: float | None = None,
) -> CaseAnswer:
    case = Case("one", "open_loop", ("load",), int(10 * z), 1.0, nuisances=nuisances)
    return CaseAnswer(
        case, hidden=("load",), detectable=(z,), apart=(apart,), steps=steps, verdict="none"
    )


def test_recall_counts_what_is_detectable_and_surely_named() -> None:
    answers = [
        answered(8.0, NamedEffect("load", 0.95)),
        answered(9.0, NamedEffect("load", 0.6)),
        answered(10.0, NamedEffect("gain", 0.5, ("load",))),
        answered(11.0, NamedEffect("gain", 0.99)),
        answered(4.0),
    ]
    (recall,) = recalls(answers)
    assert recall.title == "one effect, no nuisances"
    assert recall.named == Share(1, 4)
    assert recall.found == Share(3, 4)
    assert recall.too_small == 1
    assert not recall.passed
    with_others = [*answers, answered(8.0, NamedEffect("load", 1.0), nuisances=("load_scale",))]
    assert [r.named for r in recalls(with_others)] == [Share(1, 4), Share(1, 1)]
    said = score(with_others)
    assert "one effect, with nuisances" in score_text(said)
    assert said.to_dict()["recall"][0]["right"] == 1


def test_a_tie_counts_where_the_recording_decides_nothing() -> None:
    tie = NamedEffect("gain", 0.5, ("load",))
    many = NamedEffect("gain", 0.2, ("load", "offset", "gravity"))
    answers = [
        answered(10.0, tie, apart=1.2),
        answered(11.0, tie, apart=8.0),
        answered(12.0, many, apart=1.2),
        answered(13.0, NamedEffect("load", 0.95, ("gain",)), apart=1.2),
    ]
    (recall,) = recalls(answers)
    assert (recall.named, recall.ties) == (Share(2, 4), 1)


def test_what_another_model_replaces_is_not_told_apart() -> None:
    rng = np.random.default_rng(3)
    shapes = {"coulomb": np.sign(rng.standard_normal(5000)), "load": rng.standard_normal(5000)}
    oracle = linear_oracle(shapes)
    torque = oracle.prediction + 0.1 * rng.standard_normal(5000)
    rows = np.ones(5000, bool)
    rival = shapes["load"][:, None] + 0.001 * rng.standard_normal((5000, 1))
    assert detection(oracle, "load", torque, rows, rival) < 5.0
    other = rng.standard_normal((5000, 1))
    assert detection(oracle, "load", torque, rows, other) > 100.0
