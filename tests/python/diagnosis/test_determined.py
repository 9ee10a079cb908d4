"""What a final model says of parameters that its recording does not determine, and of passivity."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.loop.determined import known_combinations, undetermined
from stribeck.diagnosis.loop.passive import cost_of_passivity
from stribeck.identify.errors.matrix import ParameterMatrix
from synthetic import joint, motion, record


@pytest.fixture(scope="module")
def fitted(tmp_path_factory: pytest.TempPathFactory) -> sb.Fit:
    """A plain joint."""
    return sb.fit("coulomb", record(tmp_path_factory.mktemp("determined"), joint()), starts=1)


def test_of_two_parameters_that_compensate_each_other_the_sum_is_known(fitted: sb.Fit) -> None:
    """Both 3 +- 5 and 1 +- 5, with errors that cancel in the sum."""
    names = ("coulomb_friction", "viscous_friction")
    covariance = ParameterMatrix(names, np.array([[25.0, -24.99], [-24.99, 25.0]]))
    values = dict(zip(names, (3.0, 1.0), strict=True))
    estimates = {
        name: replace(fitted.estimates[name], value=value, stderr=5.0)
        for name, value in values.items()
    }
    unsure = replace(fitted, estimates=estimates, covariance=covariance)
    assert undetermined(unsure.estimates) == list(names)
    (found,) = known_combinations(unsure)
    assert list(found.coefficients) == list(names)
    assert found.coefficients[names[1]] == pytest.approx(0.9996)
    assert found.value == pytest.approx(3.9996)
    # The variance that is left of one error once the other is known.
    assert found.stderr == pytest.approx(np.sqrt(25.0 - 24.99**2 / 25.0))
    assert undetermined(fitted.estimates) == [] and known_combinations(fitted) == ()


def test_small_coefficients_of_a_series_are_determined(tmp_path: Path) -> None:
    """Dry friction with one wave along the stroke: the other coefficients are zero, and known."""
    _, q, v, _ = motion()
    frame = joint(1.0 * np.cos(np.pi * (q - q.min()) / np.ptp(q)) * np.sign(v))
    found = sb.add(sb.fit("coulomb", record(tmp_path, frame), starts=1), "position", starts=1)
    small = [e for n, e in found.estimates.items() if n.startswith("position") and e.stderr]
    assert any(e.stderr > abs(e.value) for e in small)
    assert undetermined(found.estimates) == []


def test_what_it_costs_to_be_passive(tmp_path: Path) -> None:
    """Torque that drives the joint at high speed, as no friction does."""
    v = motion()[2]
    recording = record(tmp_path, joint(-1.2 * v**2 * np.sign(v)))
    bounds = {"nonlinear_viscous_coefficient": (-20.0, 20.0)}
    free = sb.fit("coulomb+nonlinear_viscous", recording, starts=4, bounds=bounds)
    assert free.passive() is False
    cost = cost_of_passivity(free)
    assert cost is not None and cost.rmse is not None and cost.rmse > free.rmse
    assert cost_of_passivity(sb.fit("coulomb", recording, starts=1)) is None
