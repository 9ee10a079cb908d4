"""All parameters of a robot at once: weighted least squares, joint by joint weights, bounds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.identify.triangle import Triangle
from stribeck.robot.problem import Balance, Factors, Values, places

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Effort:
    """When a search ends.

    Attributes
    ----------
    steps, halvings
        Most Gauss-Newton steps, and most halvings of one of them.
    tolerance
        The search ends where a step lowers the weighted sum of squares by less than this share.
    """

    steps: int
    halvings: int
    tolerance: float


#: For a result, and for one of many candidates.
THOROUGH, QUICK = Effort(30, 8, 1e-9), Effort(6, 3, 1e-5)


@dataclass(frozen=True)
class Solved:
    """The values that fit all joints best.

    Attributes
    ----------
    weights : array [N]
        One over the RMS of each joint's filtered residual: joints of different noise count alike.
    factors
        The balance of each joint, linearised there.
    """

    balance: Balance
    values: Values
    weights: Array
    factors: list[Factors]
    converged: bool

    @property
    def every(self) -> Mask:
        """All cells."""
        return np.ones(self.balance.group_of_cell.size, dtype=bool)

    def places(self) -> list[NDArray[np.intp]]:
        """Where the columns of each joint stand among all parameters."""
        sizes = [f.size for f in self.values.friction]
        return places(sizes, self.values.base.size)

    def held_out_steps(self) -> dict[int, Array]:
        """Step to the best values without each group of samples, by group.

        One Gauss-Newton step, which is exact where the torque is linear in the parameters.
        """
        groups = self.balance.group_of_cell
        low, high = self.balance.bounds()
        at = self.values.whole()
        made = {}
        for group in np.unique(groups):
            joined = _joined(self, groups != group)
            made[int(group)] = joined.solve(low - at, high - at)
        return made

    def stacked(self) -> tuple[Array, Array, NDArray[np.uint32]]:
        """Weighted ``J`` [m, P], ``r`` [m] and cell of each row, from the factors."""
        return _stacked(self, self.every)


def solve(
    balance: Balance, start: Values, weights: Array | None = None, effort: Effort = THOROUGH
) -> Solved:
    """Find the values by Gauss-Newton steps within bounds; weights follow the residuals.

    Parameters
    ----------
    weights : array [N], optional
        Of the first step; by default, joints count by the size of their torque.
    """
    count = balance.scored_rows
    if weights is None:
        weights = 1.0 / np.array([balance.torque_size(j) for j in range(len(count))])
    low, high = balance.bounds()
    made = Solved(balance, start, weights, balance.factors(start), False)
    for _ in range(effort.steps):
        at = made.values.whole()
        joined = _joined(made, made.every)
        step = joined.solve(low - at, high - at)
        share = max(joined.fall(step), 0.0) / joined.square
        made = _stepped(made, step, joined.square, effort.halvings)
        before = made.weights
        fell = joined.square - _weighted_square(made.factors, before, made.every)
        left = np.array([f.square(made.every) for f in made.factors])
        if not np.all(np.isfinite(left)):
            raise FitError(f"{balance.motion.path}: the torques of the robot are not finite")
        weights = 1.0 / np.sqrt(np.maximum(left / count, 1e-30))
        made = Solved(balance, made.values, weights, made.factors, made.converged)
        settled = np.allclose(before, weights, rtol=np.sqrt(effort.tolerance))
        least = effort.tolerance
        if settled and min(share, fell / joined.square) < least:
            return replace(made, converged=share < least)
    return made


def _stepped(made: Solved, step: Array, square: float, halvings: int) -> Solved:
    """The values after a step, halved until the weighted sum of squares does not rise."""
    balance, share = made.balance, 1.0
    curved = [joint for joint in range(len(made.factors)) if not balance.is_linear(joint)]
    for _ in range(halvings):
        values = made.values.moved(step, share)
        parts = zip(made.factors, made.places(), strict=True)
        factors = [part.after(share * step[place]) for part, place in parts]
        for joint, part in zip(curved, balance.factors(values, curved), strict=True):
            factors[joint] = part
        moved = replace(made, values=values, factors=factors)
        if _weighted_square(factors, made.weights, made.every) <= square * (1.0 + 1e-9):
            return moved
        share *= 0.5
    return made


def _weighted_square(factors: Sequence[Factors], weights: Array, cells: Mask) -> float:
    return sum(w * w * f.square(cells) for f, w in zip(factors, weights, strict=True))


def _stacked(made: Solved, cells: Mask) -> tuple[Array, Array, NDArray[np.uint32]]:
    size = made.values.whole().size
    rows, right, cell = [], [], []
    for place, factors, weight in zip(made.places(), made.factors, made.weights, strict=True):
        whole = factors.whole[cells] * weight
        matrix = np.zeros((*whole.shape[:2], size))
        matrix[:, :, place] = whole[:, :, :-1]
        rows.append(matrix.reshape(-1, size))
        right.append(whole[:, :, -1].ravel())
        cell.append(np.repeat(np.flatnonzero(cells), whole.shape[1]))
    return np.concatenate(rows), np.concatenate(right), np.concatenate(cell).astype(np.uint32)


def _joined(made: Solved, cells: Mask) -> Triangle:
    matrix, right, _ = _stacked(made, cells)
    return Triangle.of(matrix, right)
