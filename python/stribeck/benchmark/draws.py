"""Random numbers that every generator draws, and the size of what they add up to."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """A number whose logarithm is uniform between those of `low` and `high`."""
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def root_mean_square(values: Array) -> float:
    """Root of the mean square; 0 without values."""
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0


def size_beyond(values: Array, basis: Array) -> float:
    """RMS of what a least-squares fit of the columns of `basis` leaves of `values`."""
    return root_mean_square(values - basis @ np.linalg.lstsq(basis, values, rcond=None)[0])
