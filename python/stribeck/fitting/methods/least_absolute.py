"""Linear regression with least absolute error, solved exactly as a linear programme."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.base.errors import FitError, option
from stribeck.identify.triangle import Triangle

Array = NDArray[np.float64]

#: Rounds of reweighted least squares, and the share of the mean error below which all errors have
#: the same weight.
ROUNDS, SMALL = 8, 0.1


@dataclass(frozen=True)
class LeastAbsolute:
    """Solution of a regression: the parameters [p] and the sum of absolute errors."""

    values: Array
    total: float


def least_absolute(columns: Array, target: Array, lower: Array, upper: Array) -> LeastAbsolute:
    """Minimise sum |target - columns @ x| within bounds.

    With e+ and e- the parts of the error above and below zero, this is the linear programme
    min sum(e+ + e-) subject to columns @ x + e+ - e- = target, e+, e- >= 0. HiGHS finds its
    exact optimum, which reweighted least squares only approaches.

    Parameters
    ----------
    columns : array [n, p]
    target : array [n]
        In the unit of torque.
    lower, upper : array [p]

    Returns
    -------
    LeastAbsolute

    Raises
    ------
    FitError
        The solver finds no solution.

    Examples
    --------
    The median is the constant of least absolute error; an outlier does not move it.

    >>> none = np.array([np.inf])
    >>> least_absolute(np.ones((5, 1)), np.array([1.0, 2.0, 3.0, 4.0, 90.0]), -none, none)
    LeastAbsolute(values=array([3.]), total=91.0)
    """
    rows, count = columns.shape
    size = np.abs(columns).max(axis=0)
    size[size == 0.0] = 1.0
    scale = float(np.abs(target).max()) or 1.0
    either = scipy.sparse.hstack(
        [scipy.sparse.csc_matrix(columns / size), scipy.sparse.eye(rows), -scipy.sparse.eye(rows)],
        format="csc",
    )
    cost = np.concatenate([np.zeros(count), np.ones(2 * rows)])
    low = np.concatenate([lower * size / scale, np.zeros(2 * rows)])
    high = np.concatenate([upper * size / scale, np.full(2 * rows, np.inf)])
    solved = scipy.optimize.linprog(
        cost, A_eq=either, b_eq=target / scale, bounds=np.column_stack([low, high]), method="highs"
    )
    if solved.x is None:
        raise FitError(
            f"the regression with least absolute error over {rows} rows has no solution "
            f"({solved.message}): use {option('method', 'rms')}"
        )
    values = np.clip(solved.x[:count] * scale / size, lower, upper)
    return LeastAbsolute(values, float(np.abs(target - columns @ values).sum()))


def least_total(columns: Array, target: Array) -> tuple[float, float]:
    """Bounds of the least sum of absolute errors, from reweighted least squares.

    The residual r of a least-squares fit with weights w is orthogonal to the columns in w r. Scaled
    by its largest entry, w r is a feasible point of the dual programme, whose value r'(w r) no x
    can undercut. With weights 1/|r| of the previous round the two bounds converge.

    Parameters
    ----------
    columns : array [n, p]
    target : array [n]

    Returns
    -------
    least, reached : float
        No x has a smaller sum than `least`; some x has `reached`.
    """
    weight = np.ones_like(target)
    least, reached = 0.0, float(np.abs(target).sum())
    for _ in range(ROUNDS):
        root = np.sqrt(weight)
        solution = linear.least_norm(columns * root[:, None], target * root)
        residual = target - columns @ solution
        size = np.abs(residual)
        largest = float((weight * size).max())
        if largest == 0.0:
            return 0.0, 0.0
        least = max(least, float(residual @ (weight * residual)) / largest)
        reached = min(reached, float(size.sum()))
        weight = 1.0 / np.maximum(size, SMALL * float(size.mean()))
    return least, reached


def standard_errors(jacobian: Array, residual: Array, free: NDArray[np.bool_]) -> Array:
    """Standard errors [p] of least absolute error; NaN for parameters that are not `free`.

    Koenker and Bassett 1978: covariance (J'J)^-1 / (2 f(0))^2, f(0) the density of the errors at
    zero, here from the quantiles at 1/2 -+ h with the width h of Hall and Sheather 1988.

    Parameters
    ----------
    jacobian : array [n, p]
    residual : array [n]
    free : bool array [p]
    """
    rows, count = jacobian.shape
    errors = np.full(count, np.nan)
    columns = jacobian[:, free]
    if not free.any() or rows <= count:
        return errors
    width = min((1.5 * 1.96**2 / (2.0 * np.pi * rows)) ** (1.0 / 3.0), 0.49)
    low, high = np.quantile(residual, [0.5 - width, 0.5 + width])
    sparsity = float(high - low) / (2.0 * width)
    inverse = Triangle.of(columns, residual).covariance()
    errors[free] = 0.5 * sparsity * np.sqrt(np.diag(inverse))
    return errors
