"""Where searches start: within the range to expect, the same for the same seed."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from searched import problem_of
from stribeck.identify.scaling import scaled_parameters
from stribeck.identify.search.reduced import squares
from stribeck.identify.search.space import Polynomial
from stribeck.identify.search.starts import starts_between_bounds
from synthetic import joint_with_stribeck_curve, record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve that warms up."""
    return record(tmp_path_factory.mktemp("starts"), joint_with_stribeck_curve())


def test_a_start_depends_on_the_seed_and_its_number_alone(recording: sb.Recording) -> None:
    problem, space, first = problem_of(recording, "bittencourt_a")

    def starts(count: int, seed: int) -> np.ndarray:
        return starts_between_bounds(problem, space, first, space.sought, count, seed)

    many = starts(20, 3)
    np.testing.assert_array_equal(many[0], first)
    np.testing.assert_array_equal(starts(7, 3), many[:7])
    np.testing.assert_array_equal(starts(20, 3), many)
    assert not np.array_equal(starts(20, 4)[1:], many[1:])
    assert np.unique(many, axis=0).shape[0] == 20


def test_plain_starts_fill_the_range_to_expect(recording: sb.Recording) -> None:
    problem, space, first = problem_of(recording, "bittencourt_a")
    starts = starts_between_bounds(problem, space, first, space.sought, 601, 0)
    k = problem.model.names.index("stribeck_velocity")
    low, high = scaled_parameters(problem.model, recording)[k].drawn
    assert space.lower[k] < low and high < space.upper[k]
    share = np.log(starts[2::3, k] / low) / np.log(high / low)
    assert share.min() >= 0.0 and share.max() <= 1.0
    # Points of low discrepancy: far more even than random ones.
    np.testing.assert_allclose(np.sort(share), (np.arange(200) + 0.5) / 200, atol=0.02)


def test_screened_starts_are_better_than_others(recording: sb.Recording) -> None:
    problem, space, first = problem_of(recording, "bittencourt_a")
    starts = starts_between_bounds(problem, space, first, space.sought, 61, 0)
    found = squares(problem, starts, space.lower, space.upper)
    assert np.median(found[1::3]) < np.median(found[2::3])


def test_a_polynomial_in_temperature_is_converted_both_ways() -> None:
    polynomial = Polynomial((0, 2, 3), 31.0, 6.0)
    values = np.array([0.4, 7.0, -0.03, 0.002])
    centred = polynomial.centred(values)
    temperature = np.array([28.0, 31.0, 34.0])
    quantity = values[0] + values[2] * temperature + values[3] * temperature**2
    np.testing.assert_allclose(centred[0] - centred[1] + centred[2], quantity[0], rtol=1e-12)
    np.testing.assert_allclose(centred[0], quantity[1], rtol=1e-12)
    np.testing.assert_allclose(centred.sum(), quantity[2], rtol=1e-12)
    np.testing.assert_allclose(polynomial.raw(centred), values[[0, 2, 3]], rtol=1e-12)


def test_the_coefficients_of_a_quantity_are_found_by_name(recording: sb.Recording) -> None:
    problem, space, _ = problem_of(recording, "iskandar")
    found = {tuple(problem.model.names[k] for k in p.indices) for p in space.polynomials}
    assert found == {
        tuple(f"{name}{end}" for end in ("", "_slope", "_square"))
        for name in ("stribeck_velocity", "power_exponent")
    }


def test_a_step_of_zero_stays(recording: sb.Recording) -> None:
    _, space, first = problem_of(recording, "iskandar")
    stayed = space.moved(first, np.zeros(int(space.nonlinear.sum())))
    np.testing.assert_allclose(stayed, first, rtol=1e-9, atol=1e-12)
