"""Regression in a grid with least absolute error: M0 of Bittencourt et al. 2010."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from scipy.optimize import minimize
from stribeck.base.errors import FitError, SpecError
from stribeck.fitting.methods.grid import Axis, grid_fit
from stribeck.fitting.methods.least_absolute import least_absolute, least_total, standard_errors

#: Section II-A: torques as shares of the largest manipulation torque, motor speeds in rad/s.
M0 = {
    "coulomb_friction": 3.24e-2,
    "stribeck_height": 3.84e-2,
    "viscous_friction": 4.04e-4,
    "stribeck_velocity": 13.80,
    "stribeck_exponent": 1.91,
}


def friction(v: np.ndarray) -> np.ndarray:
    dry = M0["coulomb_friction"] + M0["stribeck_height"] * np.exp(
        -(np.abs(v / M0["stribeck_velocity"]) ** M0["stribeck_exponent"])
    )
    return np.sign(v) * dry + M0["viscous_friction"] * v


def points(folder: Path, *, noise: float, outliers: int = 0, seed: int = 1) -> sb.Recording:
    """Both directions at twelve speeds, four times; `outliers` of them far too high."""
    rng = np.random.default_rng(seed)
    v = np.repeat(np.geomspace(2.0, 280.0, 12), 8) * np.tile([1.0, -1.0], 48)
    f = friction(v) + noise * rng.standard_normal(v.size)
    f[rng.choice(v.size, outliers, replace=False)] *= 2.5
    path = folder / "points.csv"
    pl.DataFrame({"run": np.arange(v.size), "velocity": v, "friction_torque": f}).write_csv(path)
    return sb.read(path, average="run", joint_kind="revolute")


def curve_error(fit: sb.Fit) -> float:
    """Largest error of the curve, as a share of the Coulomb friction."""
    v = np.geomspace(2.0, 280.0, 200)
    return float(np.abs(fit.model.torque(v) - friction(v)).max()) / M0["coulomb_friction"]


def test_m0_comes_back_from_clean_points(tmp_path: Path) -> None:
    fit = grid_fit("bittencourt_a", points(tmp_path, noise=0.0))
    for name, value in M0.items():
        assert fit.model.value(name) == pytest.approx(value, rel=2e-3), name


def test_m0_comes_back_to_its_standard_errors(tmp_path: Path) -> None:
    fit = grid_fit("bittencourt_a", points(tmp_path, noise=5e-4))
    for name, value in M0.items():
        estimate = fit.estimates[name]
        assert estimate.stderr is not None and estimate.stderr < 0.05 * value
        assert abs(estimate.value - value) < 4.0 * estimate.stderr, name
    assert fit.rmse_held_out is not None
    assert 4e-4 < fit.rmse < fit.rmse_held_out < 7e-4


def test_m0_with_its_exponent_of_1_3(tmp_path: Path) -> None:
    """Section III-D: the instance of M0 that the paper compares M* with."""
    truth = {
        "coulomb_friction": 4.90e-2,
        "stribeck_height": 8.44e-2,
        "viscous_friction": 5.00e-4,
        "stribeck_velocity": 6.50,
    }
    rng = np.random.default_rng(6)
    v = np.repeat(np.geomspace(1.0, 280.0, 24), 4)
    dry = truth["coulomb_friction"] + truth["stribeck_height"] * np.exp(-((v / 6.50) ** 1.3))
    f = dry + truth["viscous_friction"] * v + 3e-4 * rng.standard_normal(v.size)
    path = tmp_path / "m0.csv"
    pl.DataFrame({"run": np.arange(v.size), "velocity": v, "friction_torque": f}).write_csv(path)
    fit = grid_fit("m0", sb.read(path, average="run", joint_kind="revolute"))
    for name, value in truth.items():
        assert fit.model.value(name) == pytest.approx(value, rel=0.02), name


@pytest.mark.slow
def test_m0_frees_its_exponent_when_asked(tmp_path: Path) -> None:
    """Section II-A searches the Stribeck velocity and the exponent."""
    recording = points(tmp_path, noise=5e-4)
    held = grid_fit("m0", recording)
    freed = grid_fit("m0", recording, grid={"stribeck_exponent": Axis(0.5, 3.0, 20)})
    assert held.model.value("stribeck_exponent") == 1.3
    for name, value in M0.items():
        estimate = freed.estimates[name]
        assert estimate.stderr is not None
        assert abs(estimate.value - value) < 4.0 * estimate.stderr, name
    bounded = sb.fit("m0", recording, bounds={"stribeck_exponent": (0.5, 3.0)}, starts=3)
    assert bounded.model.value("stribeck_exponent") == pytest.approx(1.91, abs=0.3)


@pytest.mark.slow
def test_m_star_needs_no_ranges(tmp_path: Path) -> None:
    """Four nonlinear parameters: the printed set comes back from noisy points."""
    rng = np.random.default_rng(0)
    speeds = np.geomspace(1.0, 270.0, 10)
    v = np.repeat(np.concatenate([speeds, -speeds]), 12)
    temperature = np.tile(rng.uniform(38.0, 80.0, 12), 20)
    load = np.tile(rng.uniform(-0.73, 0.44, 12), 20)
    law = sb.published("bittencourt/tables_1_2/m_star")
    f = law.torque(v, temperature=temperature, load_torque=load)
    frame = pl.DataFrame(
        {
            "run": np.arange(v.size),
            "velocity": v,
            "temperature": temperature,
            "load_torque": load,
            "friction_torque": f + 5e-4 * rng.standard_normal(v.size),
        }
    )
    path = tmp_path / "m_star.csv"
    frame.write_csv(path)
    fit = grid_fit("m_star", sb.read(path, average="run", joint_kind="revolute"))
    found = fit.model.torque(v, temperature=temperature, load_torque=load)
    assert np.sqrt(np.mean((found - f) ** 2)) < 3e-4


def test_outliers_move_squared_error_and_not_absolute_error(tmp_path: Path) -> None:
    recording = points(tmp_path, noise=5e-4, outliers=12)
    absolute, squared = grid_fit("bittencourt_a", recording), sb.fit("bittencourt_a", recording)
    assert curve_error(absolute) < 0.03
    assert curve_error(squared) > 5.0 * curve_error(absolute)


def test_a_parameter_that_is_held_stays(tmp_path: Path) -> None:
    """Simoni's a5 scales four others: it is held, and the grid is over a6 alone."""
    rng = np.random.default_rng(3)
    v, temperature = rng.uniform(-2.0, 2.0, 120), rng.uniform(20.0, 50.0, 120)
    f = (3.0 * np.sign(v) + 1.5 * v) * (1.0 - 0.01 * (temperature - 20.0))
    path = tmp_path / "warm.csv"
    pl.DataFrame(
        {"run": np.arange(120), "velocity": v, "temperature": temperature, "friction_torque": f}
    ).write_csv(path)
    fit = grid_fit("simoni", sb.read(path, average="run", joint_kind="revolute"))
    assert fit.model.value("scale") == 1.0
    assert np.abs(fit.residual).max() < 0.01


def test_a_grid_too_large_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FitError, match="30000 points"):
        grid_fit(
            "bittencourt_a",
            points(tmp_path, noise=0.0),
            grid={"a3": Axis(1.0, 50.0, 300), "a4": Axis(0.5, 3.0, 100)},
        )


def test_the_grid_is_the_users(tmp_path: Path) -> None:
    recording = points(tmp_path, noise=0.0)
    narrow = grid_fit("bittencourt_a", recording, grid={"a3": Axis(1.0, 8.0, 20)})
    assert narrow.estimates["stribeck_velocity"].at_bound
    assert narrow.model.value("stribeck_velocity") == pytest.approx(8.0)


def test_the_answer_is_the_best_of_the_whole_grid(tmp_path: Path) -> None:
    recording = points(tmp_path, noise=2e-3, outliers=5)
    fit = grid_fit("bittencourt_a", recording)
    reached = np.abs(fit.residual).sum()
    v, f = recording.velocity, recording.torque
    free = np.full(3, np.inf)
    for speed in np.geomspace(1.0, 200.0, 9):
        for exponent in np.linspace(0.6, 3.0, 5):
            shape = np.exp(-(np.abs(v / speed) ** exponent))
            columns = np.column_stack([np.sign(v), np.sign(v) * shape, v])
            assert least_absolute(columns, f, np.zeros(3), free).total >= reached * (1 - 1e-9)


def test_a_linear_law_is_one_regression(tmp_path: Path) -> None:
    fit = grid_fit("coulomb", points(tmp_path, noise=5e-4))
    assert fit.evaluations == 1
    assert fit.converged


def test_least_absolute_is_exact() -> None:
    rng = np.random.default_rng(2)
    columns = rng.standard_normal((60, 3))
    target = columns @ [1.0, -2.0, 0.5] + rng.standard_cauchy(60)
    free = np.full(3, np.inf)
    solved = least_absolute(columns, target, -free, free)
    # At the optimum three errors vanish, and no descent from there finds less.
    assert np.sum(np.abs(target - columns @ solved.values) < 1e-9) == 3
    other = minimize(
        lambda x: np.abs(target - columns @ x).sum(), solved.values, method="Nelder-Mead"
    )
    assert solved.total <= other.fun + 1e-12
    least, reached = least_total(columns, target)
    assert 0.5 * solved.total < least <= solved.total <= reached < 1.05 * solved.total


def test_least_absolute_keeps_its_bounds() -> None:
    columns, target = np.ones((9, 1)), np.arange(9.0)
    solved = least_absolute(columns, target, np.array([0.0]), np.array([2.5]))
    assert solved.values == pytest.approx([2.5])


def test_standard_errors_of_a_median() -> None:
    spread = [np.median(np.random.default_rng(k).standard_normal(400)) for k in range(400)]
    stated = [
        standard_errors(np.ones((400, 1)), x - np.median(x), np.array([True]))[0]
        for x in np.random.default_rng(7).standard_normal((20, 400))
    ]
    assert np.mean(stated) == pytest.approx(np.std(spread), rel=0.15)


@pytest.mark.parametrize(
    ("grid", "said"),
    [
        ({"stribeck_sped": Axis(1.0, 2.0, 5)}, "did you mean 'stribeck_velocity'"),
        ({"viscous_friction": Axis(1.0, 2.0, 5)}, "not a nonlinear parameter"),
        ({"a3": Axis(2.0, 1.0, 5)}, "empty"),
        ({"a3": Axis(1.0, 2.0, 1)}, "1 points"),
    ],
)
def test_a_grid_that_makes_no_sense_is_refused(
    tmp_path: Path, grid: dict[str, Axis], said: str
) -> None:
    with pytest.raises(SpecError, match=said):
        grid_fit("bittencourt_a", points(tmp_path, noise=0.0), grid=grid)


def test_a_law_with_a_state_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FitError, match="depends on the past motion"):
        grid_fit("lugre", points(tmp_path, noise=0.0))


def test_too_few_points_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "few.csv"
    path.write_text("run,velocity,friction_torque\n1,1.0,2.0\n2,2.0,2.1\n3,-1.0,-2.0\n")
    recording = sb.read(path, average="run", joint_kind="revolute")
    with pytest.raises(FitError, match="3 moving samples"):
        grid_fit("bittencourt_a", recording)
