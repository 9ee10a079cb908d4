"""Covariances and correlations of identified parameters, with their names."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

__all__ = ["ParameterMatrix"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ParameterMatrix:
    """A symmetric matrix of identified parameters.

    Attributes
    ----------
    names : tuple of str
        The p parameters that have a standard error, in the order of the model.
    values : array [p, p]
        A covariance in products of the parameters' units, or correlations.

    Examples
    --------
    >>> covariance = ParameterMatrix(("a", "b"), np.array([[4.0, 3.0], [3.0, 9.0]]))
    >>> covariance.correlation().values
    array([[1. , 0.5],
           [0.5, 1. ]])
    """

    names: tuple[str, ...]
    values: Array

    def correlation(self) -> ParameterMatrix:
        """The correlations of a covariance; 0 beside a parameter without variance."""
        error = np.sqrt(np.diag(self.values))
        scale = np.where(error > 0.0, error, np.inf)
        values = np.clip(self.values / scale[:, None] / scale, -1.0, 1.0)
        np.fill_diagonal(values, 1.0)
        return ParameterMatrix(self.names, values)

    def pairs(self, least: float) -> list[tuple[str, str, float]]:
        """Pairs of parameters whose entry has at least this size, the largest first."""
        rows, columns = np.triu_indices(len(self.names), 1)
        entries = self.values[rows, columns]
        order = np.argsort(-np.abs(entries), kind="stable")
        return [
            (self.names[rows[k]], self.names[columns[k]], float(entries[k]))
            for k in order
            if abs(entries[k]) >= least
        ]

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {"parameters": list(self.names), "matrix": self.values.tolist()}

    def to_frame(self) -> pl.DataFrame:
        """One row and one column per parameter."""
        return pl.DataFrame(
            {"parameter": list(self.names)}
            | {name: self.values[:, k] for k, name in enumerate(self.names)}
        )
