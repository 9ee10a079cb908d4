"""Every vector makes a motion within the limits, from rest to rest, whatever the limits."""

from __future__ import annotations

import numpy as np
import pytest
from stribeck.base.errors import SpecError
from stribeck.motion.design.fourier import FourierMotions, extremes, series
from stribeck.motion.design.motion import Family, Limits
from stribeck.motion.design.passes import PassMotions

FAMILIES = ["fourier", "passes"]
RATE = 100.0


def drawn(kind: str, rng: np.random.Generator) -> tuple[Family, Limits]:
    """A family with limits of any size."""
    low = rng.uniform(-3.0, 3.0)
    limits = Limits(
        low,
        low + 10.0 ** rng.uniform(-3.0, 1.0),
        10.0 ** rng.uniform(-2.0, 1.0),
        10.0 ** rng.uniform(-1.0, 2.0),
    )
    duration = rng.uniform(5.0, 100.0)
    if kind == "fourier":
        return FourierMotions(limits, duration, RATE), limits
    return PassMotions(limits, duration), limits


@pytest.mark.parametrize("kind", FAMILIES)
def test_limits_are_held_by_every_sample(kind: str) -> None:
    rng = np.random.default_rng(11)
    for _ in range(300):
        family, limits = drawn(kind, rng)
        motion = family.motion(rng.random(family.variables), 3.0 * RATE)
        assert limits.hold(motion)
        assert np.ptp(motion.position) > 0


@pytest.mark.parametrize("kind", FAMILIES)
def test_corners_of_the_vector_hold_the_limits_too(kind: str) -> None:
    rng = np.random.default_rng(12)
    for _ in range(100):
        family, limits = drawn(kind, rng)
        assert limits.hold(family.motion(rng.integers(0, 2, family.variables).astype(float), RATE))


@pytest.mark.parametrize("kind", FAMILIES)
def test_motions_begin_and_end_at_rest(kind: str) -> None:
    rng = np.random.default_rng(13)
    for _ in range(30):
        family, limits = drawn(kind, rng)
        motion = family.motion(rng.random(family.variables), RATE)
        for channel, most in (
            (motion.velocity, limits.speed),
            (motion.acceleration, limits.acceleration),
        ):
            assert abs(channel[0]) < 1e-9 * most and abs(channel[-1]) < 1e-6 * most
        assert motion.position[-1] == pytest.approx(motion.position[0], abs=1e-9 * limits.stroke)


@pytest.mark.parametrize("kind", FAMILIES)
def test_derivatives_belong_to_the_position(kind: str) -> None:
    rng = np.random.default_rng(14)
    limits = Limits(-1.0, 1.0, 2.0, 10.0)
    family: Family = (
        FourierMotions(limits, 20.0, RATE) if kind == "fourier" else PassMotions(limits, 20.0)
    )
    motion = family.motion(rng.random(family.variables), 10000.0)
    t = motion.time
    assert np.abs(np.gradient(motion.position, t) - motion.velocity).max() < 1e-2
    wrong = np.abs(np.gradient(motion.velocity, t) - motion.acceleration)
    assert np.quantile(wrong, 0.99) < 1e-1


@pytest.mark.slow
def test_a_series_uses_one_of_its_limits_up() -> None:
    rng = np.random.default_rng(15)
    for _ in range(30):
        family, limits = drawn("fourier", rng)
        motion = family.motion(rng.random(family.variables), 50.0 * RATE)
        used = (
            np.ptp(motion.position) / limits.stroke,
            np.abs(motion.velocity).max() / limits.speed,
            np.abs(motion.acceleration).max() / limits.acceleration,
        )
        assert max(used) == pytest.approx(1.0, abs=2e-3)


def test_extremes_are_those_of_a_fine_grid() -> None:
    rng = np.random.default_rng(16)
    at = np.linspace(0.0, 2.0 * np.pi, 200001)
    for _ in range(20):
        sine, cosine = rng.standard_normal((2, 5))
        values = series(sine, cosine, 1.0, at)[0]
        low, high = extremes(sine, cosine)
        assert low == pytest.approx(values.min(), abs=1e-6) and low <= values.min() + 1e-12
        assert high == pytest.approx(values.max(), abs=1e-6) and high >= values.max() - 1e-12


def test_each_way_is_passed_in_both_directions_at_the_same_speeds() -> None:
    family = PassMotions(Limits(-1.0, 1.0, 2.0, 10.0), 40.0)
    motion = family.motion(np.random.default_rng(17).random(family.variables), 1000.0)
    v = motion.velocity
    forward, backward = np.sort(v[v > 0]), np.sort(-v[v < 0])
    assert abs(forward.size - backward.size) <= 2 * family.moves
    levels = np.linspace(0.05, 0.95, 19)
    np.testing.assert_allclose(
        np.quantile(forward, levels), np.quantile(backward, levels), rtol=0.05
    )


@pytest.mark.parametrize(
    "limits", [(1.0, 1.0, 1.0, 1.0), (0.0, 1.0, 0.0, 1.0), (0.0, 1.0, 1.0, -2.0), (0, np.nan, 1, 1)]
)
def test_limits_that_are_none(limits: tuple[float, float, float, float]) -> None:
    with pytest.raises(SpecError, match="give"):
        Limits(*limits)
