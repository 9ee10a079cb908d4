"""The last steps to a constrained minimum, and how well it is one.

A point is a minimum under conditions c >= 0 if the gradient of the objective is a combination of
the gradients of the active conditions with multipliers that are not negative (Karush, Kuhn and
Tucker; Nocedal and Wright 2006, section 12.3). Each step is that of Gauss and Newton with
linearised conditions: a problem of least distance, solved by non-negative least squares (Lawson and
Hanson 1974, section 23.4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.base.errors import FitError
from stribeck.identify.constrained.objective import Objective, Point
from stribeck.identify.constrained.region import Region
from stribeck.identify.triangle import Triangle, least_squares

__all__ = ["Optimality", "polished"]

Array = NDArray[np.float64]

#: A condition is active if its slack, in units of the step, is smaller.
ACTIVE = 1e-6
#: Most evaluations; steps without improvement that end the search; a residual that is small enough.
MOST_STEPS, IDLE, ENOUGH = 300, 5, 1e-12
#: Half the width of a difference, as a share of a parameter's value.
DIFFERENCE = 1e-5
#: Newton's steps, which may lead to a saddle, may raise the cost by this share.
RISE = 1e-9
#: Share of each column that keeps a step bounded along directions without effect.
RIDGE = 1e-9


@dataclass(frozen=True)
class Optimality:
    """How well the conditions of Karush, Kuhn and Tucker hold, as shares.

    Attributes
    ----------
    stationarity
        Largest component of the gradient of the Lagrangian by a parameter, over the norms of the
        parameter's column of the Jacobian and of the residual.
    complementarity, infeasibility
        Largest product of a multiplier and its slack, and largest violation, in the same units.
    multipliers : array [n]
        Of the conditions of the region; 0 where a condition is not active.
    active : bool array [n]
        Which conditions are active.
    """

    stationarity: float
    complementarity: float
    infeasibility: float
    multipliers: Array
    active: NDArray[np.bool_]

    @property
    def residual(self) -> float:
        """The largest of the three."""
        return max(self.stationarity, self.complementarity, self.infeasibility)


class _Linearised:
    """An objective and its conditions in coordinates in which columns have unit length."""

    def __init__(self, point: Point, values: Array, region: Region, rounding: float) -> None:
        triangle, free = point.triangle, region.free
        size = max(float(np.sqrt(triangle.square)), rounding)
        lengths = np.sqrt(np.einsum("ij,ij->j", triangle.factor, triangle.factor))
        own = np.where(values[free] == 0.0, 1.0, np.abs(values[free]))
        self.unit = np.where(lengths > 0.0, size / np.where(lengths > 0.0, lengths, 1.0), own)
        self.factor = triangle.factor * (self.unit / size)
        self.right = triangle.right / size
        shares, slopes = region.finite_shares(values)
        slopes = slopes * self.unit
        norms = np.sqrt(np.einsum("ij,ij->i", slopes, slopes))
        norms = np.where(norms > 0.0, norms, 1.0)
        lower, upper = region.lower[free] - values[free], region.upper[free] - values[free]
        low, high = np.flatnonzero(np.isfinite(lower)), np.flatnonzero(np.isfinite(upper))
        eye = np.eye(free.size)
        #: Slopes and slacks of conditions, lower bounds and upper bounds, each scaled.
        self.slopes = np.concatenate([slopes / norms[:, None], eye[low], -eye[high]])
        self.slacks = np.concatenate(
            [shares / norms, -lower[low] / self.unit[low], upper[high] / self.unit[high]]
        )
        self.conditions, self.norms, self.size = shares.size, norms, size
        self.bounded = np.concatenate([low, high])

    def multipliers(self) -> Array:
        """Of all conditions and bounds; 0 for those that are not active."""
        gradient = -self.factor.T @ self.right
        active = np.flatnonzero(self.slacks <= ACTIVE)
        none, most = np.zeros(active.size), np.full(active.size, np.inf)
        made = np.zeros(self.slacks.size)
        made[active] = least_squares(self.slopes[active].T.copy(), gradient, none, most)
        return made

    def optimality(self) -> Optimality:
        """How well the point is a minimum."""
        multipliers = self.multipliers()
        left = -self.factor.T @ self.right - self.slopes.T @ multipliers
        return Optimality(
            stationarity=float(np.abs(left).max(initial=0.0)),
            complementarity=float(np.abs(multipliers * self.slacks).max(initial=0.0)),
            infeasibility=float(np.maximum(-self.slacks, 0.0).max(initial=0.0)),
            multipliers=multipliers[: self.conditions],
            active=(self.slacks <= ACTIVE)[: self.conditions],
        )

    def step(self) -> Array | None:
        """Change [k] of the free parameters to the minimum under linearised conditions."""
        count = self.unit.size
        full = Triangle.of(
            np.concatenate([self.factor, RIDGE * np.eye(count)]),
            np.concatenate([self.right, np.zeros(count)]),
        )
        # With y = R x - b the problem is to minimise |y| under G y >= h.
        slopes = linear.solve(full.factor.T, self.slopes.T).T
        least = -self.slacks - slopes @ full.right
        rows = np.concatenate([slopes.T, least[None, :]])
        target = np.append(np.zeros(count), 1.0)
        free = np.full(least.size, np.inf)
        dual = least_squares(rows, target, np.zeros(least.size), free)
        rest = rows @ dual - target
        if not rest[-1] < -1e-14:
            return None
        shifted = full.right - rest[:-1] / rest[-1]
        found = linear.solve(full.factor, shifted) * self.unit
        return found if np.all(np.isfinite(found)) else None


class _Newton:
    """Newton's steps on the active conditions, for residuals with which Gauss and Newton's diverge.

    The Hessian of the Lagrangian comes from differences of its gradient, in the units of the
    linearised objective at the start.
    """

    def __init__(
        self, objective: Objective, region: Region, at: _Linearised, multipliers: Array
    ) -> None:
        self.objective, self.region, self.at = objective, region, at
        kept = multipliers > 0.0
        conditions = kept[: at.conditions]
        self.conditions = np.flatnonzero(conditions)
        self.weights = multipliers[: at.conditions][conditions] / at.norms[conditions]
        held = np.zeros(region.free.size, dtype=bool)
        held[at.bounded[kept[at.conditions :]]] = True
        self.moving = np.flatnonzero(~held)

    def gradient(self, values: Array) -> Array | None:
        """The gradient of the Lagrangian by the moving parameters; None where there is none."""
        point = self.objective.at(values, self.region)
        if point is None:
            return None
        _, slopes = self.region.finite_shares(values)
        own = -(point.triangle.factor.T @ point.triangle.right) / self.at.size**2
        own -= self.weights @ slopes[self.conditions]
        return np.asarray((own * self.at.unit)[self.moving])

    def step(self, values: Array) -> Array | None:
        """Change [k] of the free parameters; None where there is none."""
        free, count = self.region.free, self.moving.size
        here = self.gradient(values)
        hessian = np.zeros((count, count))
        for k, place in enumerate(free[self.moving].tolist()):
            width = DIFFERENCE * min(abs(values[place]) or np.inf, self.at.unit[self.moving[k]])
            ends = []
            for sign in (1.0, -1.0):
                moved = values.copy()
                moved[place] += sign * width
                ends.append(self.gradient(self.region.ties.filled(moved)))
            if here is None or ends[0] is None or ends[1] is None:
                return None
            hessian[:, k] = (ends[0] - ends[1]) / (2.0 * width / self.at.unit[self.moving[k]])
        shares, slopes = self.region.finite_shares(values)
        rows = (slopes[self.conditions] * self.at.unit)[:, self.moving]
        whole = np.block(
            [[0.5 * (hessian + hessian.T), rows.T], [rows, np.zeros((rows.shape[0],) * 2)]]
        )
        right = np.concatenate([-np.asarray(here), -shares[self.conditions]])
        try:
            solved = linear.solve(whole, right)[:count]
        except FitError:
            return None
        made = np.zeros(free.size)
        made[self.moving] = solved * self.at.unit[self.moving]
        return made if np.all(np.isfinite(made)) else None

    @property
    def evaluations(self) -> int:
        """Evaluations of one step."""
        return 2 * self.moving.size + 1


def polished(
    objective: Objective, values: Array, region: Region, *, most: int = MOST_STEPS
) -> tuple[Array, Optimality, int]:
    """The values near `values` that are best a minimum, how well, and evaluations used.

    Parameters
    ----------
    most : int
        Most evaluations; 1: only `values` are evaluated.
    """
    rounding = float(np.finfo(float).eps) * objective.problem.torque_norm
    best = _at(objective, values, region, rounding)
    assert best is not None
    evaluations = 1
    for by_newton in (False, True):
        reached, idle = best, 0
        while evaluations < most and idle < IDLE and best.optimality.residual > ENOUGH:
            if by_newton:
                newton = _Newton(objective, region, best.linearised, best.linearised.multipliers())
                step, base = newton.step(best.values), best.values
                evaluations += newton.evaluations
            else:
                step, base = reached.linearised.step(), reached.values
            moved = base.copy()
            moved[region.free] += 0.0 if step is None else step
            tried = None if step is None else _at(objective, region.filled(moved), region, rounding)
            evaluations += 1
            if tried is None:
                break
            reached = tried
            lower = not by_newton or tried.cost <= best.cost * (1.0 + RISE)
            if lower and tried.optimality.residual < best.optimality.residual:
                best, idle = tried, 0
            else:
                # Newton's step is the same again from the same values.
                idle = IDLE if by_newton else idle + 1
    return best.values, best.optimality, evaluations


@dataclass(frozen=True)
class _Reached:
    """Values with the objective linearised there."""

    values: Array
    cost: float
    linearised: _Linearised
    optimality: Optimality


def _at(objective: Objective, values: Array, region: Region, rounding: float) -> _Reached | None:
    """The objective linearised at `values`; None where the model is not finite."""
    point = objective.at(values, region)
    if point is None:
        return None
    linearised = _Linearised(point, values, region, rounding)
    return _Reached(values, point.cost, linearised, linearised.optimality())
