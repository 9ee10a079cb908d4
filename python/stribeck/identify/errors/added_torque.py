"""Could noise alone explain a torque that a wider model adds?

A Wald test along the added torque. The variance of the noise in that direction comes from batches
longer than its correlation, so that the test is robust to autocorrelation and to noise of varying
level.
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.identify.errors.covariance import batches, correlation_length

Array = NDArray[np.float64]


def added_torque_test(added: Array, residual: Array, parameters: int) -> float:
    """Probability that noise like `residual` alone makes `added` torque [m] this large.

    `added` is the best of a family with this number of additional `parameters`. Nonlinear ones
    count like the others, which accounts for their search.
    """
    size = float(added @ added)
    if size <= 0 or parameters < 1:
        return 1.0
    batch = batches(residual.size, correlation_length(residual), fewest=20, most=200)
    count = int(batch.max()) + 1
    if count <= parameters + 1:
        return 1.0
    scores = np.bincount(batch, added * residual, count)
    variance = float(np.sum((scores - scores.mean()) ** 2)) * count / (count - 1)
    if variance <= 0:
        return 0.0
    return float(
        scipy.special.fdtrc(parameters, count - parameters, size**2 / variance / parameters)
    )
