"""A gain is the same as an inertia and a weight where these make up the load torque."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnosis.trials.candidates import candidates_for
from stribeck.diagnosis.trials.screening import screened
from stribeck.effect.load_parts import LoadParts
from stribeck.effect.registry import of_catalog
from stribeck.models.model import Model
from synthetic import COULOMB, VISCOUS, joint, motion, record

RATE, INERTIA, WEIGHT = 100.0, 0.8, 6.0


def loaded(gain: float, weight: float) -> pl.DataFrame:
    """A joint whose torque channel shows `gain` too much, and the load torque that is right."""
    rng = np.random.default_rng(7)
    t, q, v, a = motion(6000, RATE)
    load = INERTIA * a + weight * np.sin(q + 0.4)
    torque = (1.0 + gain) * (COULOMB * np.sign(v) + VISCOUS * v + load)
    return pl.DataFrame(
        {
            "time": t,
            "position": q,
            "velocity": v,
            "torque": torque + 0.1 * rng.standard_normal(t.size),
            "load_torque": load,
        }
    )


def test_the_parts_of_a_load_torque(tmp_path: Path) -> None:
    assert LoadParts.of(record(tmp_path, joint())).effects == ()
    assert LoadParts.of(record(tmp_path, loaded(0.0, 0.0))).effects == ("inertia",)
    parts = LoadParts.of(record(tmp_path, loaded(0.0, WEIGHT)))
    assert parts.effects == ("inertia", "gravity")
    expected = WEIGHT * np.array([np.sin(0.4), np.cos(0.4)])
    np.testing.assert_allclose(parts.weight, expected, rtol=0.01)


@pytest.mark.parametrize(
    ("effect", "beside", "hidden"),
    [
        ("gain", "inertia+gravity", True),
        ("gain", "inertia+spring", True),
        ("inertia", "gain+gravity", True),
        ("gravity", "gain+inertia", True),
        ("spring", "gain+inertia", True),
        ("gain", "inertia", False),
        ("gravity", "inertia", False),
        ("stribeck", "gain+inertia", False),
    ],
)
def test_the_last_of_the_three_is_not_tried(
    effect: str, beside: str, hidden: bool, tmp_path: Path
) -> None:
    model = Model("coulomb", effects=tuple(beside.split("+")))
    found = of_catalog(effect).absorbed(model, record(tmp_path, loaded(0.0, WEIGHT)))
    assert (found is not None) is hidden
    # A payload that changes is no inertia, nor a weight.
    assert of_catalog(effect).absorbed(model, record(tmp_path, joint(), "payload")) is None


@pytest.mark.slow
@pytest.mark.parametrize("effect", ["gain", "inertia"])
def test_without_a_weight_either_may_be_the_cause(effect: str, tmp_path: Path) -> None:
    frame = loaded(0.15, 0.0)
    if effect == "inertia":
        frame = loaded(0.0, 0.0).with_columns(load_torque=0.8 * pl.col("load_torque"))
    found = sb.improve("coulomb", record(tmp_path, frame), starts=2)
    (step,) = found.steps
    named = {step.finding.effect, *step.finding.indistinguishable_from}
    assert named >= {"gain", "inertia"}
    assert step.finding.confidence <= 0.5


@pytest.mark.slow
def test_a_wrong_scale_of_both_is_named_as_a_tie(tmp_path: Path) -> None:
    """A torque constant that is wrong by 8 %, or a mass: both are wrong by that share."""
    found = sb.improve("coulomb", record(tmp_path, loaded(0.08, WEIGHT)), starts=2)
    for step in found.steps:
        named = {step.finding.effect, *step.finding.indistinguishable_from}
        assert "gain" in named and step.finding.confidence <= 0.5


def test_a_gain_is_not_tried_beside_both(tmp_path: Path) -> None:
    """The filter of a load torque may fit better where half of it is that of another inertia."""
    fitted = sb.fit("coulomb+inertia+gravity", record(tmp_path, loaded(0.1, WEIGHT)), starts=1)
    assert screened(fitted, "gain") is None
    assert "gain" in {row.effect for row in candidates_for(fitted, (), ()).untestable}
    with_payload = sb.fit("coulomb+inertia+gravity", record(tmp_path, joint(), "payload"), starts=1)
    assert screened(with_payload, "gain") is not None


def test_an_inertia_and_a_weight_that_are_wrong_may_be_a_gain(tmp_path: Path) -> None:
    fitted = sb.fit("coulomb+inertia+gravity", record(tmp_path, loaded(0.1, WEIGHT)), starts=1)
    for effect in ("inertia", "gravity"):
        assert of_catalog(effect).alike(fitted, fitted) == ("gain",)
    # A weight of another direction is none.
    shifted = loaded(0.0, WEIGHT).with_columns(
        torque=pl.col("torque") + (pl.col("position") + 1.4).cos()
    )
    other = sb.fit("coulomb+inertia+gravity", record(tmp_path, shifted, "other"), starts=1)
    assert of_catalog("gravity").alike(other, other) == ()
