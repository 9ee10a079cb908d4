"""Friction that varies for no recorded reason, distinguished from slow noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from made_fits import Array, Moved, left
from scipy.stats import pearsonr
from stribeck.diagnosis.residual.varying_friction import (
    FEWEST_ROWS,
    FEWEST_STRETCHES,
    SIGNIFICANCE,
    STRETCHES,
    SUSPECTED,
    varying_friction,
)
from synthetic import ar1, record


def moved(seed: int, swing: float, slow_noise: float) -> pl.DataFrame:
    """Strokes to and fro; dry friction varies by `swing`, noise is correlated over a second."""
    rng = np.random.default_rng(seed)
    t = np.arange(12000) / 100.0
    v = np.cos(2 * np.pi * t / 1.3) + 0.3 * np.cos(2 * np.pi * t / 2.9)
    varying = swing * np.sqrt(2.0) * np.sin(2 * np.pi * t / 31.0 + seed)
    noise = ar1(rng, t.size, 0.99, slow_noise) + 0.05 * rng.standard_normal(t.size)
    torque = (3.0 + varying) * np.sign(v) + 1.5 * v + noise
    return pl.DataFrame(
        {
            "time": t,
            "velocity": v + 1e-4 * rng.standard_normal(t.size),
            "torque": torque,
            "load_torque": np.zeros_like(t),
        }
    )


@pytest.mark.parametrize("seed", range(3))
def test_varying_friction_is_measured(tmp_path: Path, seed: int) -> None:
    fit = sb.fit("coulomb", record(tmp_path, moved(seed, 0.2, 0.05)))
    assert varying_friction(fit).rms == pytest.approx(0.2, rel=0.15)


@pytest.mark.parametrize("seed", range(6))
def test_slow_noise_is_no_friction(tmp_path: Path, seed: int) -> None:
    fit = sb.fit("coulomb", record(tmp_path, moved(seed, 0.0, 0.2)))
    assert varying_friction(fit).rms == 0.0


def test_a_diagnosis_says_so(tmp_path: Path) -> None:
    fit = sb.fit("coulomb", record(tmp_path, moved(1, 0.3, 0.02)))
    found = sb.diagnose(fit, rejected=["drift"])
    assert found.verdict == "unexplained"
    assert "no effect of the catalog explains it" in str(found.unexplained.where)


def test_one_direction_says_nothing(tmp_path: Path) -> None:
    frame = moved(0, 0.3, 0.02).with_columns(pl.col("velocity") + 2.0)
    assert varying_friction(sb.fit("coulomb", record(tmp_path, frame))).rms == 0.0


PER_STRETCH = 4 * FEWEST_ROWS


def leaves(forward: Array, backward: Array, behind: int = 2 * FEWEST_ROWS) -> sb.Fit:
    """A residual that is, in every stretch, one number forward and one number backward.

    `behind` samples of each stretch are backward. The residual backward has the other sign.
    """
    at = np.arange(PER_STRETCH)
    velocity = np.tile(np.where(at < behind, -1.0, 1.0), forward.size)
    ahead, back = np.repeat(forward, PER_STRETCH), np.repeat(backward, PER_STRETCH)
    return left(Moved(velocity), np.where(velocity > 0.0, ahead, -back))


def two_curves(size: int = STRETCHES) -> tuple[Array, Array]:
    """Two curves of mean 0 and of variance 1, without a correlation."""
    rng = np.random.default_rng(5)
    made, _ = np.linalg.qr(np.column_stack([np.ones(size), *rng.standard_normal((2, size))]))
    return made[:, 1] * np.sqrt(size - 1.0), made[:, 2] * np.sqrt(size - 1.0)


def test_the_common_part_of_both_directions_is_measured() -> None:
    common, own = two_curves()
    both = leaves(0.3 * common + 0.1 * own + 7.0, 0.3 * common - 0.1 * own - 2.0)
    assert varying_friction(both).rms == pytest.approx(np.sqrt(0.09 - 0.01))
    # The opposite sign in both directions is a torque of its own, and no friction.
    assert varying_friction(leaves(common, -common)).rms == 0.0


def test_a_correlation_must_be_significant_and_less_so_where_something_is_missing() -> None:
    common, own = two_curves()
    for correlation in np.linspace(0.05, 0.6, 12):
        other = correlation * common + np.sqrt(1.0 - correlation**2) * own
        chance = pearsonr(common, other, alternative="greater").pvalue
        found = pytest.approx(np.sqrt(correlation))
        fit = leaves(common, other)
        assert varying_friction(fit).rms == (found if chance <= SIGNIFICANCE else 0.0)
        said = varying_friction(fit, suspected=True).rms
        assert said == (found if chance <= SUSPECTED else 0.0)


@pytest.mark.parametrize(("behind", "seen"), [(FEWEST_ROWS - 1, False), (FEWEST_ROWS, True)])
def test_a_stretch_needs_samples_of_both_directions(behind: int, seen: bool) -> None:
    common, _ = two_curves()
    assert (varying_friction(leaves(common, common, behind)).rms > 0.0) == seen
    assert (varying_friction(leaves(common, common, PER_STRETCH - behind)).rms > 0.0) == seen


def test_few_stretches_say_nothing() -> None:
    """Only the first stretches of a recording move in both directions."""
    common, _ = two_curves()
    fit = leaves(common, common)
    stretch = np.arange(fit.residual.size) // PER_STRETCH
    for count, seen in ((FEWEST_STRETCHES - 1, False), (FEWEST_STRETCHES, True)):
        one_way = stretch >= count
        velocity = np.where(one_way, 1.0, fit.recording.velocity)
        some = varying_friction(left(Moved(velocity), fit.residual)).rms
        assert (some > 0.0) == seen


def test_what_is_constant_in_a_direction_does_not_vary() -> None:
    common, _ = two_curves()
    same = np.ones(STRETCHES)
    for forward, backward in ((same, common), (common, same), (same, same)):
        assert varying_friction(leaves(forward, backward)).rms == 0.0
