"""Weights of the samples in a least-squares problem.

A weight multiplies the squared error of its sample, so that the rows of the Jacobian and of the
residual are multiplied by its square root. Only ratios of weights matter: the level of the noise is
estimated from the residual.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.recording.recording import Recording

__all__ = ["root_weights", "weighted", "weighted_rms"]

Array = NDArray[np.float64]


def root_weights(recording: Recording, further: Array | None = None) -> Array | None:
    """Square roots of the weights of all samples, [n]; None where all are equal.

    Parameters
    ----------
    further : array [n]
        Weights that multiply those of the recording: those of a robust loss.
    """
    given = [weight for weight in (recording.weight, further) if weight is not None]
    return np.sqrt(np.prod(given, axis=0)) if given else None


def weighted(recording: Recording, errors: Array, rows: NDArray[np.intp]) -> Array:
    """`errors` [n] of some `rows` times the square roots of their weights, without zero weights."""
    root = root_weights(recording)
    if root is None:
        return errors[rows]
    kept = rows[root[rows] > 0.0]
    return errors[kept] * root[kept]


def weighted_rms(recording: Recording, errors: Array, at: NDArray[np.bool_]) -> float | None:
    """``sqrt(sum(w e^2) / sum(w))`` of `errors` [n] over the samples `at`; None without weights."""
    if recording.weight is None:
        return None
    weight = recording.weight[at]
    total = float(weight.sum())
    return float(np.sqrt(np.sum(weight * errors[at] ** 2) / total)) if total > 0.0 else None
