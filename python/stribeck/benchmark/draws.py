"""Random numbers and RMS values for the generators."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """Draw a number between `low` and `high` whose logarithm is uniform."""
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def root_mean_square(values: Array) -> float:
    """Root of the mean square; 0 without values."""
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0


def size_beyond(values: Array, basis: Array) -> float:
    """RMS of the residual of a least-squares fit of `values` with the columns of `basis`."""
    return root_mean_square(values - basis @ np.linalg.lstsq(basis, values, rcond=None)[0])
