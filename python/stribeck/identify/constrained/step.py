"""One step of least squares under conditions, by nlopt's SLSQP.

The objective is the sum of squares of the linearised residual, from a triangular factor whose size
does not depend on the number of samples. The conditions are not linearised.
"""

from __future__ import annotations

import nlopt
import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.identify.constrained.region import Region
from stribeck.identify.triangle import Triangle

Array = NDArray[np.float64]

#: Most evaluations in one step; each costs little more than the conditions.
MOST_EVALUATIONS = 300
#: Margin kept from every condition, so that rounding does not violate it.
AIM = 1e-10
#: Least singular value used for scaling, as a share of the largest.
LEAST_SHOWN = 1e-4
#: Weight of the sum of squares while a feasible point is searched.
ASIDE = 1e-6
#: A search for a feasible point stops this far beyond the reserve.
INSIDE = 1e-3
#: Replaces a share that is not finite.
FAR = 1e6


def step_under(triangle: Triangle, values: Array, region: Region) -> Array | None:
    """The values with the least linearised sum of squares under the conditions, array [p].

    Parameters
    ----------
    triangle
        Factor of the Jacobian's columns of the free parameters, at `values`.

    Returns
    -------
    array [p] or None
        None where no values were found that hold the conditions.
    """
    free, plain = region.free, values.copy()
    low, high = region.lower[free] - values[free], region.upper[free] - values[free]
    plain[free] += triangle.solve(low, high)
    plain = region.filled(plain)
    if region.hold(plain):
        return plain
    step = _Step(triangle, values, region)
    found = step.least(np.zeros(free.size))
    if found is None:
        inside = step.inside()
        found = None if inside is None else step.least(inside)
        found = inside if found is None else found
    return None if found is None else step.values(found)


class _Step:
    """A step in coordinates in which the sum of squares is well conditioned.

    One unit of a coordinate `w` changes the torque by about the residual's norm.
    """

    def __init__(self, triangle: Triangle, values: Array, region: Region) -> None:
        free = region.free
        size = np.sqrt(triangle.square) or 1.0
        lengths = np.sqrt(np.einsum("ij,ij->j", triangle.factor, triangle.factor))
        own = np.where(values[free] == 0.0, 1.0, np.abs(values[free]))
        # A parameter without effect on the torque is scaled by its own size.
        unit = np.minimum(size / np.maximum(lengths, size * 1e-12), own)
        factor = triangle.factor * unit / size
        shown, directions = linear.singular(factor)
        self.turn = unit[:, None] * directions.T / np.maximum(shown, LEAST_SHOWN * shown[0])
        self.factor = factor @ (self.turn / unit[:, None])
        self.right = triangle.right / size
        self.start, self.region = values, region
        lower, upper = region.lower[free], region.upper[free]
        low, high = np.isfinite(lower), np.isfinite(upper)
        # Bounds are conditions too: the distance to each, in units of its coordinate.
        self.walls = np.concatenate([self.turn[low], -self.turn[high]])
        room = np.concatenate([(values[free] - lower)[low], (upper - values[free])[high]])
        scale = np.concatenate([unit[low], unit[high]])
        self.walls, self.room = self.walls / scale[:, None], room / scale
        self._last: tuple[bytes, tuple[Array, Array]] | None = None

    @property
    def count(self) -> int:
        """Number of conditions and bounds."""
        return self.region.count + self.room.size

    def values(self, w: Array) -> Array:
        """The parameters [p] after a step."""
        moved = self.start.copy()
        moved[self.region.free] += self.turn @ w
        return self.region.filled(moved)

    def square(self, w: Array) -> tuple[float, Array]:
        """Sum of squares of the linearised residual, and its gradient."""
        left = self.factor @ w - self.right
        return float(left @ left), 2.0 * (self.factor.T @ left)

    def shares(self, w: Array) -> tuple[Array, Array]:
        """Shares of the conditions, array [n], and their slopes; -1 where friction is undefined."""
        # The optimiser evaluates objective and conditions at the same point, one after the other.
        key = w.tobytes()
        if self._last is None or self._last[0] != key:
            self._last = key, self._shares(w)
        return self._last[1]

    def _shares(self, w: Array) -> tuple[Array, Array]:
        shares, slopes = self.region.finite_shares(self.values(w))
        slopes = slopes @ self.turn
        shares = np.nan_to_num(shares, nan=-1.0, posinf=FAR, neginf=-FAR)
        return shares, np.nan_to_num(slopes, posinf=FAR, neginf=-FAR)

    def least(self, start: Array) -> Array | None:
        """The coordinates with the least sum of squares under the conditions; None: none found."""
        best: tuple[float, Array] | None = None

        def objective(w: Array, gradient: Array) -> float:
            nonlocal best
            square, slope = self.square(w)
            if gradient.size:
                gradient[:] = slope
            inside = self.room + self.walls @ w >= -AIM
            if (best is None or square < best[0]) and inside.all():
                held = np.all(self.shares(w)[0] >= 0.0)
                best = (square, w.copy()) if held else best
            return square

        def short(result: Array, w: Array, gradient: Array) -> None:
            shares, slopes = self.shares(w)
            result[: shares.size] = AIM - shares
            result[shares.size :] = -self.room - self.walls @ w
            if gradient.size:
                gradient[: shares.size], gradient[shares.size :] = -slopes, -self.walls

        optimizer = nlopt.opt(nlopt.LD_SLSQP, start.size)
        optimizer.set_min_objective(objective)
        optimizer.add_inequality_mconstraint(short, np.zeros(self.count))
        _run(optimizer, start)
        return None if best is None else best[1]

    def inside(self) -> Array | None:
        """Coordinates that hold the conditions; None where none were found.

        The smallest share is a variable of its own, which is raised until all conditions hold.
        """
        count = self.region.free.size
        found: Array | None = None

        def objective(x: Array, gradient: Array) -> float:
            square, slope = self.square(x[:count])
            if gradient.size:
                gradient[:count], gradient[count] = ASIDE * slope, -1.0
            return ASIDE * square - float(x[count])

        def short(result: Array, x: Array, gradient: Array) -> None:
            nonlocal found
            w = x[:count]
            shares, slopes = self.shares(w)
            wall = self.room + self.walls @ w
            if np.all(shares >= 0.0) and np.all(wall >= -AIM):
                found = w.copy()
            result[: shares.size], result[shares.size :] = x[count] - shares, -wall
            if gradient.size:
                gradient[: shares.size, :count], gradient[: shares.size, count] = -slopes, 1.0
                gradient[shares.size :, :count], gradient[shares.size :, count] = -self.walls, 0.0

        start = np.zeros(count + 1)
        start[count] = self.shares(start[:count])[0].min()
        optimizer = nlopt.opt(nlopt.LD_SLSQP, count + 1)
        optimizer.set_upper_bounds(np.append(np.full(count, np.inf), INSIDE))
        optimizer.set_min_objective(objective)
        optimizer.add_inequality_mconstraint(short, np.zeros(self.count))
        _run(optimizer, start)
        return found


def _run(optimizer: nlopt.opt, start: Array) -> None:
    """Run the optimiser; its functions keep the best point, whatever status it ends with."""
    optimizer.set_ftol_rel(1e-13)
    optimizer.set_xtol_abs(1e-12)
    optimizer.set_maxeval(MOST_EVALUATIONS)
    try:
        optimizer.optimize(start)
    except (nlopt.RoundoffLimited, nlopt.runtime_error):
        # Also raised at an optimum, where no further decrease can be resolved.
        return
