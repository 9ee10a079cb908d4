"""Data made from the parameter sets of the papers is fitted to its noise, with default bounds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from laws.published import M_STAR, TABLE_7, direct_drive
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds, model_for

#: RMS of the noise, N m: about 0.3 % of the friction of table 7.
NOISE = 0.1
#: Largest speeds, rad/s, of the recordings of a law.
SPEEDS = {"m_star": (200.0,), "indri_static": (1.0,)}
#: Laws that are searched for more than a second.
SLOW = (
    "tadese_full",
    "bittencourt_b",
    "iskandar",
    "dahl",
    "lugre",
    "indri_b",
    "tadese_t",
    "m_star",
    "zhou",
)


def recorded(folder: Path, speed: float, torque: np.ndarray | None, name: str) -> sb.Recording:
    """A warming joint under load; without a torque, that of the load."""
    t = np.arange(8000) / 500.0
    slow = np.sin(2.0 * np.pi * 0.11 * t) * np.sin(2.0 * np.pi * 0.037 * t + 0.4)
    v = speed * (slow + 0.05 * np.sin(2.0 * np.pi * 1.3 * t))
    load = 20.0 * np.sin(0.31 * t + 1.0) + 8.0 * np.sin(1.1 * t)
    temperature = 26.0 + 10.0 * (1.0 - np.exp(-t / 6.0)) + np.sin(0.9 * t)
    frame = pl.DataFrame(
        {
            "time": t,
            "position": np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1])) / 500.0]),
            "velocity": v,
            "acceleration": np.gradient(v, t),
            "temperature": temperature,
            "load_torque": load,
            "torque": load if torque is None else torque,
        }
    )
    path = folder / f"{name}.parquet"
    frame.write_parquet(path)
    return sb.read(path, joint_kind="revolute", trust=True)


def true_model(law: str, printed: dict[str, float], recording: sb.Recording) -> sb.Model:
    """The printed set: where only a size has an effect, it is positive."""
    model = model_for(law, recording)
    lower, upper, start = bounds(model, recording)
    values = [
        first if low == high else abs(printed[p.symbol]) if low >= 0.0 else printed[p.symbol]
        for p, low, high, first in zip(model.parameters, lower, upper, start, strict=True)
    ]
    return model.with_values(values)


#: Tadese et al. 2021 print stiffness and damping of the bristle (table 2, here joint 2); the other
#: values are those of their curves in size, with the signs of each quadrant.
TADESE_FULL = {
    "s0": 12930.0,
    "s1": 233.0,
    "vd": 0.05,
    **{"Fc_plus": 12.0, "Fc_minus": 13.0},
    **{"s20_plus": 40.0, "s2T_plus": -0.4, "s30_plus": 0.9, "s3T_plus": 0.01},
    **{"s20_minus": 38.0, "s2T_minus": -0.35, "s30_minus": 0.8, "s3T_minus": 0.012},
    **{"g1_1": 3.0, "g2_1": 2.0, "g3_1": 0.5, "l1_1": 0.15, "l2_1": 0.02},
    **{"g1_2": -1.0, "g2_2": 1.5, "g3_2": -0.3, "l1_2": 0.02, "l2_2": 0.005},
    **{"g1_3": -2.5, "g2_3": 2.5, "g3_3": -0.6, "l1_3": 0.12, "l2_3": -0.015},
    **{"g1_4": 0.8, "g2_4": 1.2, "g3_4": 0.2, "l1_4": 0.03, "l2_4": 0.004},
}

SETS = {"tadese_full": TADESE_FULL, **TABLE_7, "m_star": M_STAR, "indri_static": direct_drive(1)}


@pytest.mark.parametrize(
    "law", [pytest.param(law, marks=[pytest.mark.slow] if law in SLOW else []) for law in SETS]
)
def test_the_fit_is_as_good_as_the_printed_set(law: str, tmp_path: Path) -> None:
    for speed in SPEEDS.get(law, (0.7, 2.5)):
        empty = recorded(tmp_path, speed, None, "empty")
        model = true_model(law, SETS[law], empty)
        rows = np.flatnonzero(empty.moving)
        exact = Problem(empty, model, rows).predict(model.values)
        noise = NOISE * np.random.default_rng(1).standard_normal(exact.size)
        recording = recorded(tmp_path, speed, exact + noise, "made")
        fitted = sb.fit(law, recording)
        same = true_model(law, SETS[law], recording)
        true = recording.torque - Problem(recording, same, rows).predict(same.values)

        def rms(residual: np.ndarray, at: np.ndarray = fitted.rows) -> float:
            return float(np.sqrt(np.mean(residual[at] ** 2)))

        assert rms(fitted.residual) <= 1.0001 * rms(true), speed


#: exp(-a5 T) is zero long before the printed 309.89 per kelvin.
WITHOUT_INFLUENCE = {"nevmerzhitskiy": {"a5"}}


@pytest.mark.parametrize("law", [law for law in SETS if law != "tadese_full"])
def test_default_bounds_admit_the_printed_set(law: str, tmp_path: Path) -> None:
    speed = SPEEDS.get(law, (2.5,))[0]
    recording = recorded(tmp_path, speed, None, "empty")
    model = true_model(law, SETS[law], recording)
    rows = np.flatnonzero(recording.moving)
    torque = Problem(recording, model, rows).predict(model.values)
    recording = recorded(tmp_path, speed, torque, "made")
    model = true_model(law, SETS[law], recording)
    lower, upper, _ = bounds(model, recording)
    for p, low, high in zip(model.parameters, lower, upper, strict=True):
        value = SETS[law].get(p.symbol, p.start)
        if p.role != "held" and p.symbol not in WITHOUT_INFLUENCE.get(law, ()):
            # A parameter that acts by its size alone has no bound below zero.
            size = abs(value) if low >= 0.0 else value
            assert low <= size <= high, (p.symbol, low, high)
