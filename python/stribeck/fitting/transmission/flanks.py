"""Torque over windup as straight flanks with a gap between them, by least squares.

``torque = K max(w - upper, 0) + K min(w - lower, 0) + c + F sgn(v) + B v + J a + H d``: the spring
K of the transmission outside the gap, the friction F, B and the inertia J of the motor in front of
it, and the hysteresis H of the windup w with its direction d. All but the ends of the gap are
linear: they are searched on a grid and refined, the others follow by least squares.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.fitting.transmission.windup import Windup
from stribeck.identify.errors.covariance import batches, correlation_length

Array = NDArray[np.float64]

#: Ends of the gap that are tried at first, in each direction.
_GRID = 18
#: Samples on which they are tried, and the number of pairs that are refined.
_TRIED, _BEST = 4000, 3
#: Least samples on either flank, and in the gap.
_LEAST = 30
#: Directions of the regressors with less than this share of the largest singular value are unseen.
_UNSEEN = 1e-9


@dataclass(frozen=True)
class Flanks:
    """A fit of torque over windup.

    Attributes
    ----------
    values
        By name: stiffness, gap, and the linear terms of the motor that the data show.
    errors
        Their standard errors, valid for correlated residuals.
    freedom
        Degrees of freedom of these errors.
    squares
        Sum of squared residuals.
    independent
        Number of independent samples.
    common
        Share of the torque's variance that the spring explains, beyond all other terms.
    explained
        Share of the windup's variance, beyond all other terms, that is not its noise.
    noise
        RMS residual.
    inside
        Samples in the gap; on the lower and on the upper flank.
    """

    values: dict[str, float]
    errors: dict[str, float]
    freedom: int
    squares: float
    independent: float
    common: float
    explained: float
    noise: float
    inside: tuple[int, int, int]


def fit_flanks(windup: Windup, *, gap: bool) -> Flanks | None:
    """Fit the flanks, with or without a gap; None if there is nothing to fit a gap to."""
    w = windup.windup
    # Sizes near 1 keep the regressors comparable.
    size = max(windup.range, 1e-300)
    x = (w - np.median(w)) / size
    others, names = _others(windup)
    if not gap:
        return _solved(windup, x, others, names, None, size)
    found = min(
        (_refined(windup, x, others, place) for place in _places(windup, x, others)),
        key=lambda result: result.fun,
        default=None,
    )
    if found is None:
        return None
    lower, upper = sorted(map(float, found.x))
    if min((x < lower).sum(), (x > upper).sum()) < _LEAST:
        return None
    return _solved(windup, x, others, names, (lower, upper), size)


def _places(windup: Windup, x: Array, others: Array) -> list[tuple[float, float]]:
    """The best ends of a gap among those of a grid, by levels of the windup and by samples."""
    thin = slice(None, None, max(1, x.size // _TRIED))
    low, high = np.quantile(x, [0.01, 0.99])
    even = np.linspace(low, high, _GRID)
    ends = np.unique(np.concatenate([even, np.quantile(x, np.linspace(0.05, 0.95, _GRID // 2))]))
    tried = [
        (_squares(x[thin], others[thin], windup.torque[thin], lower, upper), lower, upper)
        for i, lower in enumerate(ends)
        for upper in ends[i + 1 :]
    ]
    return [(float(lower), float(upper)) for _, lower, upper in sorted(tried)[:_BEST]]


def _refined(
    windup: Windup, x: Array, others: Array, place: tuple[float, float]
) -> scipy.optimize.OptimizeResult:
    """The ends of the gap near `place` with the least squares."""
    simplex = np.array(place) + np.array([[0.0, 0.0], [0.05, 0.0], [0.0, -0.05]])
    return scipy.optimize.minimize(
        lambda p: _squares(x, others, windup.torque, min(p), max(p)),
        place,
        method="Nelder-Mead",
        options={"xatol": 1e-5, "fatol": 1e-12, "maxfev": 200, "initial_simplex": simplex},
    )


def _others(windup: Windup) -> tuple[Array, list[str]]:
    """The terms besides the spring, [n, k], scaled to 1, and their names."""
    columns = {"constant": np.ones(windup.windup.size)}
    if windup.moves:
        columns["viscous"] = windup.velocity
        columns["inertia"] = windup.acceleration
        columns["coulomb"] = np.sign(windup.velocity)
    if np.ptp(windup.rising) > 0.0:
        columns["hysteresis"] = windup.rising
    return np.column_stack(list(columns.values())), list(columns)


def _spring(x: Array, lower: float, upper: float) -> Array:
    return np.maximum(x - upper, 0.0) + np.minimum(x - lower, 0.0)


def _squares(x: Array, others: Array, torque: Array, lower: float, upper: float) -> float:
    if min((x < lower).sum(), (x > upper).sum()) < 3:
        return float(torque @ torque)
    matrix = np.column_stack([_spring(x, lower, upper), others])
    residual = torque - matrix @ _scaled_solution(matrix, torque)
    return float(residual @ residual)


def _scaled_solution(matrix: Array, right: Array) -> Array:
    length = np.sqrt((matrix**2).sum(axis=0))
    length[length == 0.0] = 1.0
    return linear.least_norm(matrix / length, right, _UNSEEN) / length


def _solved(
    windup: Windup,
    x: Array,
    others: Array,
    names: list[str],
    ends: tuple[float, float] | None,
    size: float,
) -> Flanks:
    lower, upper = ends if ends is not None else (0.0, 0.0)
    spring = _spring(x, lower, upper) if ends is not None else x
    matrix = np.column_stack([spring, others])
    solution = _scaled_solution(matrix, windup.torque)
    residual = windup.torque - matrix @ solution
    jacobian = matrix
    if ends is not None:
        # The ends of the gap: by how much the torque falls where an end rises.
        falls = np.column_stack([-solution[0] * (x < lower), -solution[0] * (x > upper)])
        jacobian = np.column_stack([matrix, falls])
    covariance, freedom, independent = _covariance(jacobian, residual)
    values = {"stiffness": float(solution[0]) / size}
    errors = {"stiffness": float(np.sqrt(covariance[0, 0])) / size}
    for k, name in enumerate(names, start=1):
        values[name], errors[name] = float(solution[k]), float(np.sqrt(covariance[k, k]))
    if ends is not None:
        values["gap"] = (upper - lower) * size
        between = covariance[-1, -1] + covariance[-2, -2] - 2.0 * covariance[-1, -2]
        errors["gap"] = float(np.sqrt(max(between, 0.0))) * size
    free = spring - others @ _scaled_solution(others, spring)
    alone = windup.torque - others @ _scaled_solution(others, windup.torque)
    own, both, target = float(free @ free), float(free @ alone), float(alone @ alone)
    noise = windup.noise / size
    return Flanks(
        values,
        errors,
        freedom,
        float(residual @ residual),
        independent,
        both**2 / (own * target) if own > 0.0 and target > 0.0 else 0.0,
        max(1.0 - noise**2 * x.size / own, 0.0) if own > 0.0 else 0.0,
        float(np.sqrt(np.mean(residual**2))),
        (int(((x >= lower) & (x <= upper)).sum()), int((x < lower).sum()), int((x > upper).sum())),
    )


def _covariance(jacobian: Array, residual: Array) -> tuple[Array, int, float]:
    """Covariance [p, p] valid for correlated residuals, its degrees of freedom, and samples."""
    length = np.sqrt((jacobian**2).sum(axis=0))
    length[length == 0.0] = 1.0
    scaled = jacobian / length
    correlated = correlation_length(residual)
    batch = batches(residual.size, correlated)
    values, vectors = linear.singular(scaled)
    seen = values > 1e-7 * values[0]
    inverse = (vectors[seen].T / values[seen] ** 2) @ vectors[seen]
    count = int(batch.max()) + 1
    scores = np.zeros((count, scaled.shape[1]))
    np.add.at(scores, batch, scaled * residual[:, None])
    meat = scores.T @ scores * (count / max(count - 1, 1))
    covariance = inverse @ meat @ inverse / np.outer(length, length)
    return covariance, max(count - 1, 1), residual.size / correlated
