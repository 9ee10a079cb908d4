"""Friction that varies for no recorded reason, distinguished from slow noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnosis.residual.varying_friction import varying_friction
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
    assert "no recorded channel explains it" in str(found.unexplained.where)


def test_one_direction_says_nothing(tmp_path: Path) -> None:
    frame = moved(0, 0.3, 0.02).with_columns(pl.col("velocity") + 2.0)
    assert varying_friction(sb.fit("coulomb", record(tmp_path, frame))).rms == 0.0
