"""The largest compensation factor: against formulas, and never above what any point allows."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.base.errors import SpecError
from stribeck.models.model_file import ModelFile
from stribeck.motion.compensate.factor import largest_factor
from synthetic import joint, record

COLD = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
WARM = sb.model("coulomb", coulomb_friction=1.5, viscous_friction=0.2)
LOADED = sb.model(
    "coulomb+stribeck+load+temperature_viscous",
    constants={"reference_temperature": 30.0, "reference_load": 10.0},
    coulomb_friction=5.0,
    viscous_friction=3.0,
    stribeck_height=2.0,
    stribeck_velocity=0.1,
    stribeck_exponent=1.4,
    load_coulomb=0.1,
    load_exponent=1.0,
    load_stribeck=0.02,
    load_stribeck_ratio=1.0,
    temperature_viscous_slope=0.02,
    temperature_viscous_curvature=0.0,
)
BOX = {"velocity": (-1.0, 1.0), "temperature": (20.0, 50.0), "load_torque": (-30.0, 30.0)}


def test_exact_parameters_allow_all_of_it() -> None:
    assert largest_factor(COLD, box={"velocity": (-1.0, 1.0)}).bound == pytest.approx(1.0, abs=2e-3)


def test_the_least_ratio_of_two_frictions() -> None:
    factor = largest_factor(COLD, WARM, {"velocity": (-1.0, 1.0)})
    assert factor.value == pytest.approx(1.7 / 2.5, rel=5e-3)
    assert factor.value <= 1.7 / 2.5
    assert factor.point is not None
    assert abs(factor.point["velocity"]) == pytest.approx(1.0, rel=0.1)


def test_the_width_of_the_intervals_counts() -> None:
    file = ModelFile(COLD, {"coulomb_friction": 0.2, "viscous_friction": 0.0})
    factor = largest_factor(file, box={"velocity": (-1.0, 1.0)})
    # At rest all is Coulomb friction: (2 - 1.96 * 0.2)/2.
    assert factor.value == pytest.approx((2.0 - 1.96 * 0.2) / 2.0, rel=5e-3)


def with_interval(folder: Path, low: float, high: float) -> sb.Fit:
    """`COLD` on a recording, with this interval of its Coulomb friction."""
    fit = sb.evaluate(COLD, record(folder, joint()))
    estimate = replace(fit.estimates["coulomb_friction"], ci95=(low, high))
    return replace(fit, errors="profile", estimates={**fit.estimates, estimate.name: estimate})


def test_an_asymmetric_interval_counts_on_its_own_side(tmp_path: Path) -> None:
    """Only friction that is smaller than modelled limits the factor."""
    for high in (2.1, 9.0):
        fit = with_interval(tmp_path, 1.5, high)
        factor = largest_factor(fit, box={"velocity": (-1.0, 1.0)})
        assert factor.value == pytest.approx(1.5 / 2.0, rel=5e-3)


def test_an_infinite_interval_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="coulomb_friction is infinite"):
        largest_factor(with_interval(tmp_path, 1.5, np.inf), box={"velocity": (-1.0, 1.0)})


def test_no_friction_within_the_intervals_is_exceeded() -> None:
    rng = np.random.default_rng(0)
    errors = {n: 0.01 * abs(v) for n, v in zip(LOADED.names, LOADED.values, strict=True)}
    errors["viscous_friction"] *= 10.0
    factor = largest_factor(ModelFile(LOADED, errors), box=BOX)
    assert 0.5 < factor.value < 1.0
    points = {name: rng.uniform(*side, 2000) for name, side in BOX.items()}
    compensation = factor.value * LOADED.torque(**points)
    for _ in range(50):
        reach = 1.96 * np.array([errors[n] for n in LOADED.names])
        true = LOADED.with_values(LOADED.values + reach * rng.choice([-1.0, 0.3, 1.0], reach.size))
        left = (true.torque(**points) - compensation) * np.sign(points["velocity"])
        assert left.min() >= 0.0


def test_a_model_that_knows_less_may_cancel_less() -> None:
    blind = sb.model("coulomb", coulomb_friction=8.0, viscous_friction=3.0)
    knowing = largest_factor(LOADED, LOADED, BOX)
    factor = largest_factor(blind, LOADED, BOX)
    assert factor.value < 0.8 < knowing.value
    assert "load_torque" in factor.box


def test_a_friction_that_pushes_allows_none() -> None:
    pushes = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=-4.0)
    assert largest_factor(COLD, pushes, {"velocity": (-1.0, 1.0)}).value == 0.0


def test_what_has_no_error_is_said() -> None:
    assert largest_factor(COLD, WARM, {"velocity": (-1.0, 1.0)}).exact == tuple(WARM.names)


def test_a_missing_side_is_refused() -> None:
    with pytest.raises(SpecError, match="no temperature"):
        largest_factor(COLD, LOADED, {"velocity": (-1.0, 1.0)})
    with pytest.raises(SpecError, match="cannot have 'speed'"):
        largest_factor(COLD, WARM, {"speed": (-1.0, 1.0)})
