"""Searches by nlopt: its local and global algorithms on the reduced sum of squares.

nlopt sees only the nonlinear parameters, in search coordinates; the core gives the least sum of
squares over the linear ones, and its gradient. The objective is the logarithm of that sum, so that
tolerances do not depend on the size of the torque.
"""

from __future__ import annotations

import math

import nlopt
import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import SpecError, nearest
from stribeck.base.pool import on_each
from stribeck.identify.problem import Problem
from stribeck.identify.search.reduced import reduced
from stribeck.identify.search.separable import Search
from stribeck.identify.search.space import SearchSpace

Array = NDArray[np.float64]

#: The core's search by damped Gauss-Newton steps.
GAUSS_NEWTON = "gauss-newton"
#: nlopt's algorithms that search from a start, by name.
LOCAL = {
    "slsqp": nlopt.LD_SLSQP,
    "lbfgs": nlopt.LD_LBFGS,
    "mma": nlopt.LD_MMA,
    "ccsaq": nlopt.LD_CCSAQ,
    "tnewton": nlopt.LD_TNEWTON_PRECOND_RESTART,
    "var2": nlopt.LD_VAR2,
    "bobyqa": nlopt.LN_BOBYQA,
    "cobyla": nlopt.LN_COBYLA,
    "neldermead": nlopt.LN_NELDERMEAD,
    "sbplx": nlopt.LN_SBPLX,
}
#: nlopt's algorithms that search the range of random starts, by name.
GLOBAL = {
    "mlsl": nlopt.G_MLSL_LDS,
    "stogo": nlopt.GD_STOGO,
    "ags": nlopt.GN_AGS,
    "crs2": nlopt.GN_CRS2_LM,
    "direct": nlopt.GN_DIRECT_L,
    "esch": nlopt.GN_ESCH,
    "isres": nlopt.GN_ISRES,
}
#: All algorithms that a fit takes.
ALGORITHMS = (GAUSS_NEWTON, *LOCAL, *GLOBAL)

#: A search ends when the sum of squares falls by less than this share.
TOLERANCE = 1e-8
#: Objective where the model is not finite: larger than the logarithm of any sum of squares.
FAR = 750.0
#: First step of algorithms without gradient, in search coordinates.
FIRST_STEP = 0.1
#: Most nonlinear parameters of `ags`.
MOST_OF_AGS = 5


def check_algorithm(name: str, what: str = "algorithm") -> str:
    """Return the name of an algorithm.

    Raises
    ------
    SpecError
        There is none of that name.
    """
    if not isinstance(name, str):
        raise SpecError(f"{what} is {name!r}: give the name of one")
    if name not in ALGORITHMS:
        raise SpecError(
            f"unknown {what} {name!r}{nearest(name, ALGORITHMS)}; there are {', '.join(ALGORITHMS)}"
        )
    return name


def search_from(
    problem: Problem, space: SearchSpace, starts: Array, algorithm: str, evaluations: int
) -> list[Search]:
    """The ends of nlopt's searches from `starts`, array [n, p].

    Parameters
    ----------
    algorithm
        A key of `LOCAL`.
    evaluations
        Most evaluations of each search.
    """

    def run(start: Array) -> Search:
        objective = _Objective(problem, space, start)
        optimizer = nlopt.opt(LOCAL[algorithm], objective.size)
        optimizer.set_lower_bounds(objective.coordinates(space.lower))
        optimizer.set_upper_bounds(objective.coordinates(space.upper))
        optimizer.set_initial_step(FIRST_STEP)
        return objective.run(optimizer, objective.coordinates(start), evaluations)

    return on_each(run, starts)


def search_range(
    problem: Problem, space: SearchSpace, start: Array, algorithm: str, evaluations: int, seed: int
) -> Search:
    """The end of nlopt's search in the range of random starts.

    Parameters
    ----------
    start : array [p]
        Values of the parameters that are not searched, and first values of the others.
    algorithm
        A key of `GLOBAL`.
    """
    objective = _Objective(problem, space, start)
    if algorithm == "ags" and objective.size > MOST_OF_AGS:
        raise SpecError(
            f"the algorithm ags takes at most {MOST_OF_AGS} nonlinear parameters, and "
            f"{problem.model.spec} has {objective.size}: choose another one"
        )
    optimizer = nlopt.opt(GLOBAL[algorithm], objective.size)
    if algorithm == "mlsl":
        local = nlopt.opt(nlopt.LD_SLSQP, objective.size)
        local.set_ftol_abs(1e-4)
        optimizer.set_local_optimizer(local)
    optimizer.set_lower_bounds(np.zeros(objective.size))
    optimizer.set_upper_bounds(np.ones(objective.size))
    nlopt.srand(seed + 1)
    first = np.clip(objective.coordinates(start), 0.0, 1.0)
    return objective.run(optimizer, first, evaluations)


class _Objective:
    """The logarithm of the reduced sum of squares in search coordinates; it keeps the best point.

    nlopt returns a success where the objective is NaN, and raises errors at an optimum: what it
    returns is not used.
    """

    def __init__(self, problem: Problem, space: SearchSpace, start: Array) -> None:
        self.problem, self.space, self.start = problem, space, start
        self.size = int(space.nonlinear.sum())
        own = np.abs(start[space.nonlinear])
        self.unit = np.where(own > 0.0, own, 1.0)
        self.best = Search(start, math.inf, False, "the model is not finite at the start", 0)
        self.evaluations = 0

    def coordinates(self, values: Array) -> Array:
        """Coordinates of `values` [p]; without a range of starts, multiples of the start."""
        if self.space.enclosed:
            with np.errstate(divide="ignore"):
                return self.space.encode(values)
        return np.asarray(values[self.space.nonlinear] / self.unit)

    def values(self, u: Array) -> Array:
        """Values [p] at coordinates `u` [k]."""
        if self.space.enclosed:
            return self.space.placed(self.start, u)
        values = self.start.copy()
        values[self.space.nonlinear] = u * self.unit
        return values

    def __call__(self, u: Array, gradient: Array) -> float:
        self.evaluations += 1
        values = self.values(u)
        lower, upper = self.space.lower, self.space.upper
        sloped = gradient.size > 0
        found = reduced(self.problem, values[None, :], lower, upper, sloped=sloped)[0]
        if found is None or not math.isfinite(found.square):
            gradient[:] = 0.0
            return FAR
        if found.square < self.best.square:
            self.best = Search(found.values, found.square, True, "converged", 0)
        if sloped:
            unit = self.space.slope(values) if self.space.enclosed else self.unit
            gradient[:] = found.slope[self.space.nonlinear] * unit / max(found.square, 1e-300)
        return math.log(max(found.square, 1e-300))

    def run(self, optimizer: nlopt.opt, first: Array, evaluations: int) -> Search:
        """The best point of a run."""
        optimizer.set_min_objective(self)
        optimizer.set_ftol_abs(TOLERANCE)
        optimizer.set_maxeval(evaluations)
        try:
            optimizer.optimize(first)
        except (nlopt.RoundoffLimited, nlopt.runtime_error):
            # Raised at an optimum too, where no further decrease can be resolved.
            pass
        self.best.evaluations = self.evaluations
        return self.best
