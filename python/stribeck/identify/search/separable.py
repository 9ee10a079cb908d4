"""Separable least squares: the core's search, for data in memory and data read in passes.

Steps change the nonlinear parameters alone, by Levenberg and Marquardt's method; at each point the
linear parameters are solved for. Bounds hold throughout. A parameter with equal bounds is held.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.identify.measured import search_options
from stribeck.identify.problem import Problem
from stribeck.identify.triangle import Triangle
from stribeck.models.model import Model

Array = NDArray[np.float64]

#: Most steps of a search.
MOST_ROUNDS = 50
#: A search ends when the undamped step predicts a smaller relative decrease of the sum of squares.
TOLERANCE = 1e-18
#: First damping far from the minimum, in squared lengths of the columns.
CAUTIOUS = 1e-2


class LeastSquares(Protocol):
    """A model and measured torque: samples in memory, or a data set that is read in passes."""

    @property
    def model(self) -> Model:
        """The model whose parameters are sought."""

    @property
    def torque_norm(self) -> float:
        """Norm of the measured torque; read only after the first call of `triangle`."""

    def triangle(self, values: Array, wanted: NDArray[np.intp], slope: Array) -> Triangle | None:
        """The problem linearised at `values`; None where the model is not finite there.

        Parameters
        ----------
        values : array [p]
        wanted, slope : arrays [k]
            Indices of the parameters to differentiate by, and factors of their columns.
        """


@dataclass
class Search:
    """The end of one search.

    Attributes
    ----------
    values : array [p]
    square
        Sum of squares.
    converged, outcome
        Whether the search converged, and why it ended.
    evaluations
        Number of evaluations of the model.
    blind
        Indices of the nonlinear parameters that have no effect at `values`.
    others
        Ends of searches from other delays, whose sums of squares are larger.
    """

    values: Array
    square: float
    converged: bool
    outcome: str
    evaluations: int
    blind: Sequence[int] = ()
    others: tuple[Search, ...] = ()

    def continuing(self, before: Search) -> Search:
        """This search with the evaluations of the one `before` it, and the other ends."""
        evaluations = before.evaluations + self.evaluations
        return replace(self, evaluations=evaluations, others=before.others)


def minimise(
    problem: LeastSquares,
    values: Array,
    lower: Array,
    upper: Array,
    *,
    tolerance: float = TOLERANCE,
    most: int = MOST_ROUNDS,
    damping: float = 0.0,
    logarithmic: NDArray[np.bool_] | None = None,
) -> Search:
    """Minimise the sum of squares, starting from `values`.

    Parameters
    ----------
    values, lower, upper : arrays [p]
        Start and bounds; an infinite bound is no bound, equal ones hold a parameter.
    tolerance : float
        The search ends when the undamped step predicts a smaller relative decrease, or several
        damped steps achieve only a smaller one.
    most : int
        Most steps, rejected ones included.
    damping : float
        First damping: 0 near the minimum, `CAUTIOUS` elsewhere.
    logarithmic : bool array [p]
        Nonlinear parameters that are changed in steps of their logarithm.

    Returns
    -------
    Search
        With an infinite sum of squares where the model is not finite at `values`.
    """
    searches = minimise_from(
        problem,
        values[None, :],
        lower,
        upper,
        tolerance=tolerance,
        most=most,
        damping=damping,
        logarithmic=logarithmic,
    )
    return searches[0]


def minimise_from(
    problem: LeastSquares,
    starts: Array,
    lower: Array,
    upper: Array,
    *,
    tolerance: float = TOLERANCE,
    most: int = MOST_ROUNDS,
    damping: float = 0.0,
    logarithmic: NDArray[np.bool_] | None = None,
) -> list[Search]:
    """`minimise` from each of several `starts` [k, p]; for data in memory on all threads."""
    within = search_options(
        problem.model,
        lower,
        upper,
        logarithmic=logarithmic,
        tolerance=tolerance,
        most=most,
        damping=damping,
    )
    if isinstance(problem, Problem) and problem.in_core:
        found = problem.search(starts, within)
    else:
        # Steps that overflow are rejected.
        with np.errstate(all="ignore"):
            found = [_core.search_by(problem, start, within) for start in starts]
    return [Search(*one) for one in found]


def rounding(problem: LeastSquares) -> float:
    """Norm of the rounding of the torque: the residual of an exact fit."""
    return float(np.finfo(float).eps) * problem.torque_norm
