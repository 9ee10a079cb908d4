"""Covariance and correlation of the parameters of a fit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.identify.errors.matrix import ParameterMatrix
from synthetic import joint, record


def test_correlations_of_a_covariance() -> None:
    covariance = ParameterMatrix(
        ("a", "b", "c"), np.array([[4.0, -5.9, 0.0], [-5.9, 9.0, 0.0], [0.0, 0.0, 0.0]])
    )
    correlation = covariance.correlation()
    np.testing.assert_allclose(
        correlation.values, [[1.0, -5.9 / 6.0, 0.0], [-5.9 / 6.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    )
    assert correlation.pairs(0.95) == [("a", "b", pytest.approx(-5.9 / 6.0))]
    assert correlation.pairs(0.99) == []
    assert correlation.to_frame().columns == ["parameter", "a", "b", "c"]


def test_a_fit_has_the_covariance_of_its_standard_errors(tmp_path: Path) -> None:
    """For independent errors it is s^2 (J'J)^-1, here of a straight line."""
    recording = record(tmp_path, joint())
    fit = sb.fit("coulomb", recording, errors="independent")
    assert fit.covariance is not None
    v = recording.velocity[fit.rows]
    columns = np.column_stack([v, np.sign(v)])
    variance = np.sum(fit.residual[fit.rows] ** 2) / (v.size - 2)
    np.testing.assert_allclose(
        fit.covariance.values, variance * np.linalg.inv(columns.T @ columns), rtol=1e-9
    )
    robust = sb.fit("coulomb", recording)
    assert robust.covariance is not None and robust.correlation is not None
    assert robust.covariance.names == ("viscous_friction", "coulomb_friction")
    for k, name in enumerate(robust.covariance.names):
        assert np.sqrt(robust.covariance.values[k, k]) == robust.estimates[name].stderr
    assert robust.to_dict()["correlation"] == robust.correlation.to_dict()
