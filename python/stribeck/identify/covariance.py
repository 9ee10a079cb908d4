"""Standard errors that stand up to autocorrelated residuals.

The sandwich H^-1 S H^-1 with S from sums of scores over contiguous batches that are longer
than the residual's memory (batch means; Ibragimov and Mueller 2010 for the t quantile).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def correlation_length(residual: Array) -> float:
    """Samples over which a residual remembers itself: 1 + 2 sum of autocorrelations.

    Sokal's automatic window: the sum stops at five times itself.
    """
    x = residual - residual.mean()
    size = x.size
    power = float(x @ x)
    if size < 8 or power <= 0:
        return 1.0
    length = 1.0
    limit = min(size // 4, 20000)
    spectrum = np.fft.rfft(x, 2 * size)
    correlation = np.fft.irfft(np.abs(spectrum) ** 2)[: limit + 1] / power
    for lag in range(1, limit + 1):
        length += 2.0 * correlation[lag]
        if lag >= 5.0 * max(length, 1.0):
            break
    return float(max(length, 1.0))


def batches(size: int, length: float, fewest: int = 10, most: int = 200) -> NDArray[np.uint32]:
    """Number each of `size` rows by contiguous batches, well longer than the correlation `length`.

    Batches are of equal size; there are `fewest` to `most` of them.
    """
    count = int(np.clip(size / max(4.0 * length, 1.0), fewest, most))
    count = min(count, size)
    return (np.arange(size) * count // max(size, 1)).astype(np.uint32)


def sandwich(
    jacobian: Array, residual: Array, batch: NDArray[np.uint32], free: NDArray[np.bool_]
) -> Array:
    """Covariance [p, p] of the free parameters; infinite where the data does not show one."""
    p = jacobian.shape[1]
    covariance = np.zeros((p, p))
    j = jacobian[:, free]
    if not free.any():
        return covariance
    scale = np.sqrt(np.einsum("ij,ij->j", j, j))
    scale[scale == 0] = 1.0
    j = j / scale
    hessian = j.T @ j
    count = int(batch.max()) + 1
    scores = np.zeros((count, j.shape[1]))
    np.add.at(scores, batch, j * residual[:, None])
    scores -= scores.mean(axis=0)
    dof = max(count - 1, 1)
    meat = scores.T @ scores * (count / dof)
    inverse = np.linalg.pinv(hessian, rcond=1e-13, hermitian=True)
    inner = inverse @ meat @ inverse / np.outer(scale, scale)
    covariance[np.ix_(free, free)] = inner
    return covariance


def seen(jacobian: Array, free: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which parameters the data can show apart from the others.

    A parameter whose tangent lies in the span of the others' to one part in 10^4 is not
    identifiable on this data, whatever its standard error says.
    """
    p = jacobian.shape[1]
    shown = np.zeros(p, dtype=bool)
    index = np.flatnonzero(free)
    size = np.sqrt(np.einsum("ij,ij->j", jacobian, jacobian))
    index = index[size[index] > 0]
    if index.size == 0:
        return shown
    j = jacobian[:, index] / size[index]
    hessian = j.T @ j
    inverse = np.linalg.pinv(hessian, rcond=1e-14, hermitian=True)
    alone = 1.0 / np.maximum(np.diag(inverse) * np.diag(hessian), 1.0)
    weights = np.linalg.eigvalsh(hessian)
    singular = weights[0] < 1e-12 * weights[-1]
    if singular:
        # The pseudo-inverse hides exact collinearity: find who takes part in the null space.
        values, vectors = np.linalg.eigh(hessian)
        null = vectors[:, values < 1e-12 * values[-1]]
        alone = np.where((null**2).sum(axis=1) > 1e-6, 0.0, alone)
    shown[index] = alone > 1e-8
    return shown
