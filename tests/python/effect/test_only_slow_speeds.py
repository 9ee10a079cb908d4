"""Nonlinear viscous friction that only changes the slowest speeds is no viscous friction."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.effect.registry import of_catalog
from synthetic import Array, joint, motion, record

RULE = of_catalog("nonlinear_viscous").out_of_reach


def levels_off(v: Array, speed: float) -> Array:
    """Friction of 2 N m that it reaches around a speed."""
    return 2.0 * np.abs(v) / (np.abs(v) + speed) * np.sign(v)


@pytest.mark.parametrize(("speed", "is_slow"), [(0.01, True), (0.5, False)])
def test_friction_that_levels_off_at_once_is_dry(
    tmp_path: Path, speed: float, is_slow: bool
) -> None:
    frame = joint(levels_off(motion()[2], speed))
    fit = sb.fit("coulomb+nonlinear_viscous", record(tmp_path, frame), starts=2)
    reason = RULE(fit)
    assert (reason is not None) == is_slow
    if reason is not None:
        assert "the slowest 10 % of the samples, and is dry friction above" in reason


def test_friction_that_rises_faster_than_the_speed_is_viscous(tmp_path: Path) -> None:
    v = motion()[2]
    fit = sb.fit("coulomb+nonlinear_viscous", record(tmp_path, joint(0.4 * v * np.abs(v))))
    assert RULE(fit) is None


def test_friction_that_also_bends_above_the_slowest_speeds_is_viscous(tmp_path: Path) -> None:
    """Thermally activated slip (Eyring) rises with the logarithm of the speed, over decades."""
    v = motion()[2]
    frame = joint(0.3 * np.arcsinh(v / 0.001))
    assert RULE(sb.fit("coulomb+nonlinear_viscous", record(tmp_path, frame), starts=2)) is None


def test_a_curve_below_the_noise_that_all_speeds_follow_is_viscous(tmp_path: Path) -> None:
    v = motion()[2]
    noise = 0.15 * np.random.default_rng(6).standard_normal(v.size)
    frame = joint(0.5 * np.sign(v) * np.abs(v) ** 0.4 + noise)
    fit = sb.fit("coulomb+nonlinear_viscous", record(tmp_path, frame), starts=2)
    assert RULE(fit) is None
