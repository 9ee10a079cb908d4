"""Separable least squares: the core's search, for problems in memory and for those that are not.

Steps are taken in the nonlinear parameters alone, by Levenberg and Marquardt's method, and at each
point the linear ones are solved for. Bounds hold throughout; a parameter whose bounds are equal is
held.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.identify.problem import Problem
from stribeck.identify.triangle import Triangle
from stribeck.models.model import Model

Array = NDArray[np.float64]

MOST_ROUNDS = 50
#: A fall of the sum of squares by less than this share, foreseen by the undamped step, ends it.
TOLERANCE = 1e-18
#: First damping where the search starts far away, in squared lengths of the columns.
CAUTIOUS = 1e-2


class LeastSquares(Protocol):
    """A model against measured torque: rows in memory, or a data set that is read in passes."""

    @property
    def model(self) -> Model:
        """The model whose parameters are sought."""

    @property
    def torque_norm(self) -> float:
        """Norm of the measured torque; asked for after the first `triangle`."""

    def triangle(self, values: Array, wanted: NDArray[np.intp], slope: Array) -> Triangle | None:
        """The problem linearised at `values`; None where the model is not finite there.

        Parameters
        ----------
        values : array [p]
        wanted, slope : arrays [k]
            The parameters to differentiate by, and by what their columns are multiplied.
        """


@dataclass
class Search:
    """Where one search ended.

    Attributes
    ----------
    blind
        Places of the nonlinear parameters on which the torque does not depend there.
    """

    values: Array
    square: float
    converged: bool
    outcome: str
    evaluations: int
    blind: Sequence[int] = ()


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
    """Bring the sum of squares down from `values` to the minimum they lead to.

    Parameters
    ----------
    values, lower, upper : arrays [p]
        Start and bounds; infinite bounds are none, equal ones hold a parameter.
    tolerance : float
        The search ends when the undamped step foresees a smaller relative fall, or some damped ones
        bring a smaller one.
    most : int
        Most steps, those that are taken back included.
    damping : float
        First damping: 0 from a point near the minimum, `CAUTIOUS` from anywhere else.
    logarithmic : bool array [p]
        Nonlinear parameters whose logarithm is stepped in.

    Returns
    -------
    Search
        Its sum of squares is infinite where the model is not finite at `values`.
    """
    return minimise_from(
        problem, values[None, :], lower, upper, tolerance=tolerance, most=most, damping=damping,
        logarithmic=logarithmic,
    )[0]  # fmt: skip


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
    """`minimise` from each of several `starts`, array [k, p]; rows in memory on all threads."""
    within = {
        "lower": lower,
        "upper": upper,
        "linear": [bool(p.linear) for p in problem.model.parameters],
        "logarithmic": np.zeros(lower.size, dtype=bool) if logarithmic is None else logarithmic,
        "tolerance": tolerance,
        "most": most,
        "damping": damping,
    }
    if isinstance(problem, Problem) and problem.in_core:
        found = problem.search(starts, within)
    else:
        # Steps that leave the range of numbers are taken back.
        with np.errstate(all="ignore"):
            found = [_core.search_by(problem, start, within) for start in starts]
    return [Search(*one) for one in found]


def rounding(problem: LeastSquares) -> float:
    """Norm of the rounding of the torque: what is left where a model fits exactly."""
    return float(np.finfo(float).eps) * problem.torque_norm
