"""The torques that a refit of a model can absorb, as a subspace."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.visibility.subspace import orthonormal, outside_span
from stribeck.identify.problem import Problem

Array = NDArray[np.float64]

#: Most samples on which angles between effects and leverages are computed; they need no noise.
MOST_ROWS = 8000


@dataclass(frozen=True)
class ModelSpace:
    """A model on some samples, as the span of the torques that a refit of it can absorb.

    Parameters
    ----------
    problem
        Its model has values.
    extra : array [m, k]
        Further columns that count as part of the model.
    """

    problem: Problem
    extra: Array | None = None

    @cached_property
    def free(self) -> NDArray[np.intp]:
        """Parameters that a fit may change, int array [p]."""
        model = self.problem.model
        held = {name for name, (low, high) in model.bounds.items() if low == high}
        return np.flatnonzero([name not in held for name in model.names])

    @cached_property
    def columns(self) -> Array:
        """Derivative of the prediction by each free parameter, and the extra columns, [m, p]."""
        _, jacobian = self.problem.linearise(self.problem.model.values, self.free)
        return jacobian if self.extra is None else np.column_stack([jacobian, self.extra])

    @cached_property
    def basis(self) -> Array:
        """Orthonormal basis of the columns' span, [m, r]."""
        return orthonormal(self.columns)

    @property
    def stride(self) -> int:
        """Every sample of this stride is enough for angles and leverages."""
        return -(-self.problem.rows.size // MOST_ROWS)

    @cached_property
    def thinned_basis(self) -> Array:
        """Orthonormal basis of the columns' span on the samples of `stride`."""
        return orthonormal(self.columns[:: self.stride])

    def outside(self, torques: Array) -> Array:
        """The part of `torques` [m, k] that no refit absorbs."""
        return outside_span(self.basis, torques)
