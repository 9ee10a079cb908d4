"""Combinations that are determined although their parameters are not."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.identify.errors.confounded import Combination
from stribeck.identify.errors.directions import Directions
from synthetic import COULOMB, VISCOUS, Array, joint, motion, record

APART = 1e-4


def found(*columns: Array) -> list[list[float]]:
    jacobian = np.column_stack(columns)
    directions = Directions.of(jacobian, np.ones(len(columns), dtype=bool))
    return directions.combinations(APART, len(columns)).round(9).tolist()


@pytest.fixture(scope="module")
def columns() -> Array:
    """Four columns without relation, [4, 1000]."""
    return np.random.default_rng(5).standard_normal((4, 1000))


def test_equal_columns_determine_the_sum(columns: Array) -> None:
    a, b = columns[:2]
    assert found(a, b, a) == [[1.0, 0.0, 1.0]]


def test_proportional_columns_keep_their_factor(columns: Array) -> None:
    a, b = columns[:2]
    assert found(2.0 * a, b, a) == [[1.0, 0.0, 0.5]]
    assert found(1e6 * a, b, a) == [[1.0, 0.0, 1e-6]]
    assert found(a, b, -a) == [[1.0, 0.0, -1.0]]


def test_a_sum_of_two_columns_determines_two_combinations(columns: Array) -> None:
    """With c = a + b the torque is (x + z) a + (y + z) b."""
    a, b, c = columns[:3]
    assert found(a, b, c, a + b) == [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]]


def test_two_separate_pairs_stay_separate(columns: Array) -> None:
    a, b = columns[:2]
    assert found(a, b, a, 3.0 * b) == [[1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 3.0]]


def test_nothing_is_combined_without_need(columns: Array) -> None:
    assert found(*columns) == []
    # A parameter without effect is not determined, and in no combination.
    assert found(columns[0], 0.0 * columns[0]) == []


def test_nearly_equal_columns_are_equal(columns: Array) -> None:
    a, b = columns[:2]
    (row,) = found(a, a + 1e-6 * b, columns[2])
    assert found(a, a + 1e-2 * b, columns[2]) == []
    assert row == [1.0, pytest.approx(1.0, abs=1e-5), 0.0]


@pytest.mark.parametrize(
    ("coefficients", "same_unit", "text"),
    [
        ({"a": 1.0, "b": 1.0000004}, True, "a + b"),
        ({"a": 1.0, "b": 0.5}, True, "2 a + b"),
        ({"a": 1.0, "b": -2.0 / 3.0}, True, "3 a - 2 b"),
        ({"a": 1.0, "b": 0.5, "c": 1.0 / 3.0}, True, "6 a + 3 b + 2 c"),
        ({"a": 1.0, "b": 0.5}, False, "a + 0.5 b"),
        ({"a": 1.0, "b": 0.123456}, True, "a + 0.123 b"),
    ],
)
def test_the_text_shows_simple_factors(
    coefficients: dict[str, float], same_unit: bool, text: str
) -> None:
    made = Combination(coefficients, 3.0, 0.1, "N m", same_unit, False)
    assert made.text == text
    said = made.to_dict()
    assert said["combination"] == text
    assert said["value"] == pytest.approx(3.0 * made.factor)
    assert said["stderr"] == pytest.approx(0.1 * made.factor)


def one_way(speed: Array | float, noise: float = 0.03) -> pl.DataFrame:
    """A joint that turns in one direction, whose load is known to be zero."""
    t = motion()[0]
    v = speed + np.zeros_like(t)
    rng = np.random.default_rng(0)
    return joint().with_columns(
        position=pl.Series(np.cumsum(v) * (t[1] - t[0])),
        velocity=pl.Series(v + 1e-7 * rng.standard_normal(t.size)),
        acceleration=pl.Series(np.gradient(v, t)),
        load_torque=pl.lit(0.0),
        torque=pl.Series(COULOMB + VISCOUS * v + noise * rng.standard_normal(t.size)),
    )


def test_in_one_direction_an_offset_adds_to_coulomb_friction(tmp_path: Path) -> None:
    speed = 0.5 + 0.4 * np.sin(1.3 * motion()[0])
    fit = sb.fit("coulomb+offset", record(tmp_path, one_way(speed)))
    (one,) = fit.combinations
    assert one.text == "coulomb_friction + offset"
    assert one.unit == "N m" and not one.local
    assert abs(one.value - COULOMB) < 4.0 * one.stderr
    assert not fit.estimates["coulomb_friction"].identifiable
    # The standard error of viscous friction allows for the unknown sum: that of two columns.
    columns = np.column_stack([np.ones(speed.size), speed])
    expected = 0.03 * np.sqrt(np.linalg.inv(columns.T @ columns).diagonal())
    assert one.stderr == pytest.approx(expected[0], rel=0.3)
    assert fit.estimates["viscous_friction"].stderr == pytest.approx(expected[1], rel=0.3)
    assert fit.covariance is not None and fit.covariance.names == ("viscous_friction",)


def test_at_one_speed_the_coefficient_is_the_speed(tmp_path: Path) -> None:
    fit = sb.fit("coulomb", record(tmp_path, one_way(0.37)))
    (one,) = fit.combinations
    assert one.text == "coulomb_friction + 0.37 viscous_friction"
    assert one.value == pytest.approx(COULOMB + 0.37 * VISCOUS, abs=0.01)
    assert fit.covariance is not None and fit.covariance.names == ()


def test_a_curve_of_height_zero_has_no_combination(tmp_path: Path) -> None:
    """Its velocity and exponent have no effect: nothing of them is determined."""
    fit = sb.fit("coulomb+stribeck", record(tmp_path, joint()), fix={"stribeck_height": 0.0})
    for name in ("stribeck_velocity", "stribeck_exponent"):
        assert not fit.estimates[name].identifiable
    assert fit.combinations == ()
    assert fit.to_dict()["determined_combinations"] == []


def test_a_combination_of_nonlinear_parameters_is_local(tmp_path: Path) -> None:
    """The torque of c1 v + tanh((c2 + c3) v) determines c2 + c3 alone."""
    v = motion()[2]
    frame = joint(np.tanh(2.0 * v) - COULOMB * np.sign(v))
    law = sb.law("c1*v + tanh((c2 + c3)*v)")
    start = {"c2": 1.0, "c3": 0.5}
    (one,) = sb.fit(law, record(tmp_path, frame), start=start).combinations
    assert one.text == "c2 + c3" and one.local
    assert one.value == pytest.approx(2.0, abs=0.05)


def test_the_command_names_the_combination(tmp_path: Path) -> None:
    speed = 0.5 + 0.4 * np.sin(1.3 * motion()[0])
    one_way(speed).write_parquet(tmp_path / "one_way.parquet")

    def run(*words: str) -> str:
        command = [sys.executable, "-m", "stribeck", "fit", "one_way.parquet", *words]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
        return done.stdout

    options = ("--model", "coulomb+offset", "--joint-kind", "revolute")
    assert "Only this combination is determined: coulomb_friction + offset = 3." in run(*options)
    said = json.loads(run(*options, "--json"))
    (one,) = said["determined_combinations"]
    assert one["combination"] == "coulomb_friction + offset"
    assert one["coefficients"] == pytest.approx({"coulomb_friction": 1.0, "offset": 1.0})
    assert one["value"] == pytest.approx(
        sum(said["parameters"][n]["value"] for n in one["coefficients"])
    )
    assert said["correlation"] == {"parameters": ["viscous_friction"], "matrix": [[1.0]]}
