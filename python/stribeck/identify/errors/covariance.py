"""Standard errors that are valid for autocorrelated residuals.

The sandwich H^-1 S H^-1 with S from sums of scores over contiguous batches that are longer
than the residual's correlation length (batch means; Ibragimov and Mueller 2010 for the t quantile).
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.identify.errors.directions import Directions
from stribeck.identify.triangle import Triangle

Array = NDArray[np.float64]


def correlation_length(residual: Array) -> float:
    """Correlation length of a residual in samples: 1 + 2 times the sum of autocorrelations.

    Sokal's automatic window: the sum stops at a lag of five times its value.
    """
    x = residual - residual.mean()
    size = x.size
    power = float(x @ x)
    if size < 8 or power <= 0:
        return 1.0
    length = 1.0
    limit = min(size // 4, 20000)
    # Padded with zeros so that no lag up to the limit wraps around, to a fast length.
    padded = scipy.fft.next_fast_len(size + limit, real=True)
    spectrum = np.fft.rfft(x, padded)
    correlation = np.fft.irfft(np.abs(spectrum) ** 2, padded)[: limit + 1] / power
    for lag in range(1, limit + 1):
        length += 2.0 * correlation[lag]
        if lag >= 5.0 * max(length, 1.0):
            break
    return float(max(length, 1.0))


def batches(size: int, length: float, fewest: int = 10, most: int = 200) -> NDArray[np.uint32]:
    """The batch of each of `size` samples; batches are well longer than the correlation `length`.

    Batches are contiguous and of equal size; there are `fewest` to `most` of them.
    """
    count = int(np.clip(size / max(4.0 * length, 1.0), fewest, most))
    count = min(count, size)
    return (np.arange(size) * count // max(size, 1)).astype(np.uint32)


def sandwich(
    jacobian: Array, residual: Array, batch: NDArray[np.uint32], free: NDArray[np.bool_]
) -> Array:
    """Covariance of the free parameters, array [p, p]; zero for the others."""
    p = jacobian.shape[1]
    covariance = np.zeros((p, p))
    if not free.any():
        return covariance
    j, powers = _balanced(jacobian[:, free])
    count = int(batch.max()) + 1
    scores = np.zeros((count, j.shape[1]))
    np.add.at(scores, batch, j * residual[:, None])
    scores -= scores.mean(axis=0)
    dof = max(count - 1, 1)
    meat = scores.T @ scores * (count / dof)
    inverse = Triangle.of(j, residual).covariance()
    covariance[np.ix_(free, free)] = _restored(inverse @ meat @ inverse, powers)
    return covariance


def independent(
    jacobian: Array, residual: Array, free: NDArray[np.bool_], rank: int | None = None
) -> Array:
    """Covariance of the free parameters for independent errors, array [p, p].

    ``s^2 (J'J)^-1`` with ``s^2`` the sum of squares over n - `rank`, the number of parameters or of
    combinations that are determined; default: all that are free.
    """
    p = jacobian.shape[1]
    covariance = np.zeros((p, p))
    freedom = residual.size - (int(free.sum()) if rank is None else rank)
    if free.any() and freedom > 0:
        variance = float(np.sum(residual**2)) / freedom
        j, powers = _balanced(jacobian[:, free])
        inverse = Triangle.of(j, residual).covariance()
        covariance[np.ix_(free, free)] = _restored(variance * inverse, powers)
    return covariance


def _balanced(jacobian: Array) -> tuple[Array, NDArray[np.intc]]:
    """The columns [n, p] brought to a size near 1, and the powers of two [p] that this takes.

    The squares of a column that hardly affects the prediction would underflow, and their inverse
    overflow. A power of two changes no digit of the result.
    """
    powers = np.frexp(np.abs(jacobian).max(axis=0, initial=0.0))[1]
    return np.ldexp(jacobian, -powers), powers


def _restored(covariance: Array, powers: NDArray[np.intc]) -> Array:
    """The covariance [p, p] for the columns as they were; infinite where it overflows."""
    with np.errstate(over="ignore"):
        return np.ldexp(covariance, -(powers[:, None] + powers))


def covariance_of(
    jacobian: Array,
    residual: Array,
    batch: NDArray[np.uint32] | None,
    free: NDArray[np.bool_],
    apart: float,
) -> tuple[Array, int]:
    """Covariance [p, p] of the determined part of the `free` parameters; degrees of freedom."""
    directions = Directions.of(jacobian, free)
    determined = directions.without_hidden(jacobian, apart)
    if batch is not None:
        return sandwich(determined, residual, batch, free), max(int(batch.max()), 1)
    rank = directions.rank(apart)
    return independent(determined, residual, free, rank), residual.size - rank


def variances(
    jacobian: Array,
    residual: Array,
    batch: NDArray[np.uint32],
    free: NDArray[np.bool_],
    parameter: int,
    apart: float,
) -> tuple[float, float]:
    """Variance of a parameter, and that of independent errors to which it corresponds.

    The second is the robust variance of the parameter over its diagonal element of ``(J'J)^-1``: by
    so much the sum of squares rises, at its minimum over the other parameters, where the parameter
    is one standard error away from its best value.
    """
    among = free.copy()
    among[parameter] = True
    jacobian, powers = _balanced(jacobian)
    covariance, _ = covariance_of(jacobian, residual, batch, among, apart)
    determined = Directions.of(jacobian, among).without_hidden(jacobian, apart)
    inverse = Triangle.of(determined[:, among], residual).covariance()
    place = int(np.count_nonzero(among[:parameter]))
    variance = float(covariance[parameter, parameter])
    own = _restored(covariance, powers)[parameter, parameter]
    return float(own), variance / float(inverse[place, place])


def seen(jacobian: Array, free: NDArray[np.bool_], apart: float = 1e-4) -> NDArray[np.bool_]:
    """Which of the `free` parameters are identifiable, bool array [p].

    A parameter is not identifiable on this data if less than the share `apart` of its tangent lies
    outside the span of the others' tangents, whatever its standard error.
    """
    directions = Directions.of(jacobian, free)
    shown = np.zeros(jacobian.shape[1], dtype=bool)
    shown[directions.index] = directions.seen(apart)
    return shown
