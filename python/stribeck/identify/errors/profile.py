"""Profile-likelihood intervals of parameters.

The sum of squares, minimised over all other parameters, is followed on both sides of the best value
of one parameter, up to a threshold (profile t function; Bates and Watts 1988, chapter 6). So the
interval is asymmetric where the sum of squares is not a parabola, and open where it does not reach
the threshold.

For correlated errors the likelihood of independent ones is wrong by a factor, which is estimated
for each parameter from the ratio of its robust to its naive variance (vertical adjustment of the
independence likelihood; Chandler and Bate 2007).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.identify.search.separable import LeastSquares, Search, minimise_from

__all__ = ["Interval", "Profile"]

Array = NDArray[np.float64]

#: Ends are accurate to this share of their distance from the best value.
ACCURACY = 1e-3
#: Sums of squares are accurate to this share of their rise at the ends.
PRECISION = 1e-4
#: Most doublings of a step towards an infinite bound, and most reductions of one by `SHRINK`, which
#: are tried where the profile t exceeds the quantile by the factor `STEEP`.
DOUBLINGS, SHRINK, STEEP = 40, 10.0, 3.0
#: The first step is at most this share of the best value: a standard error may be far too large,
#: and the same torque may follow from values of the other sign.
LARGEST = 0.5
#: Profile t beyond so many times the quantile is not told apart: the interval has long ended.
FAR = 10.0


@dataclass(frozen=True)
class Interval:
    """An interval of a parameter.

    Attributes
    ----------
    low, high
        Its ends; a bound of the parameter, or infinite, where it is open.
    open
        ``"lower"``, ``"upper"`` or both: ends that the data does not determine.
    """

    low: float
    high: float
    open: tuple[str, ...]


@dataclass
class Profile:
    """The sum of squares as a function of one parameter, minimised over all others.

    Attributes
    ----------
    values, lower, upper : arrays [p]
        The solution of the fit, and its bounds; equal ones hold a parameter.
    square : float
        Sum of squares of the solution.
    parameter : int
        Index of the parameter.
    variance : float
        Rise of the sum of squares that is one squared standard error: the variance of independent
        errors, or its equivalent for correlated ones.
    quantile : float
        Of the t distribution: ends are where the rise is ``quantile^2 variance``.
    least : float
        The smallest sum of squares that was found.
    """

    problem: LeastSquares
    values: Array
    lower: Array
    upper: Array
    square: float
    parameter: int
    variance: float
    quantile: float
    least: float = field(init=False)
    #: Values of all parameters, and profile t, by the value of the parameter.
    _seen: dict[float, tuple[Array, float]] = field(init=False)

    def __post_init__(self) -> None:
        self.least = self.square
        self._seen = {float(self.values[self.parameter]): (self.values, 0.0)}

    def t(self, at: float) -> float:
        """The profile t function at a value of the parameter, without sign."""
        if at in self._seen:
            return self._seen[at][1]
        best = self._minimum(at)
        if not math.isfinite(best.square):
            return FAR * self.quantile
        self.least = min(self.least, best.square)
        rise = max(best.square - self.square, 0.0)
        t = min(math.sqrt(rise / self.variance), FAR * self.quantile)
        self._seen[at] = best.values, t
        return t

    def _minimum(self, at: float) -> Search:
        """The minimum over the other parameters."""
        k = self.parameter
        lower, upper = self.lower.copy(), self.upper.copy()
        lower[k] = upper[k] = at
        # The search starts from the solution, and from the nearest point of the profile.
        near = min(self._seen, key=lambda x: (abs(x - at), x))
        starts = np.stack([self._seen[near][0], self.values])
        starts = starts[:1] if near == self.values[k] else starts
        starts[:, k] = at
        rise = self.quantile**2 * self.variance
        tolerance = max(PRECISION * rise / self.square, 1e-15) if self.square > 0.0 else 1e-15
        found = minimise_from(self.problem, starts, lower, upper, tolerance=tolerance)
        return min(found, key=lambda search: search.square)

    def interval(self, step: float) -> Interval:
        """The interval between both ends.

        Parameters
        ----------
        step : float
            Half-width of the symmetric interval, from which the search for an end starts.
        """
        size = abs(float(self.values[self.parameter]))
        step = min(step, LARGEST * size) if size > 0.0 else step
        low, below = self._end(-1.0, step)
        high, above = self._end(1.0, step)
        sides = (("lower", below), ("upper", above))
        return Interval(low, high, tuple(side for side, is_open in sides if is_open))

    def _end(self, sign: float, step: float) -> tuple[float, bool]:
        """One end of the interval, and whether it is open."""
        inside = float(self.values[self.parameter])
        bound = float((self.lower if sign < 0.0 else self.upper)[self.parameter])
        if inside == bound:
            return bound, True
        best = inside
        for doubling in range(DOUBLINGS):
            outside = best + sign * step * 2.0**doubling
            at_bound = sign * (outside - bound) >= 0.0
            outside = bound if at_bound else outside
            if self.t(outside) >= self.quantile:
                return self._root(inside, outside), False
            if at_bound:
                return bound, True
            inside = outside
        return sign * math.inf, True

    def _root(self, inside: float, outside: float) -> float:
        """Where the profile t function is the quantile."""
        best = float(self.values[self.parameter])
        # A standard error may be far too large where the sum of squares is no parabola.
        for _ in range(DOUBLINGS):
            nearer = best + (outside - best) / SHRINK
            if inside != best or self.t(outside) < STEEP * self.quantile or nearer == best:
                break
            if self.t(nearer) >= self.quantile:
                outside = nearer
            else:
                inside = nearer
        return float(
            scipy.optimize.brentq(
                lambda at: self.t(at) - self.quantile,
                inside,
                outside,
                xtol=max(ACCURACY * abs(outside - best), np.finfo(float).tiny),
            )
        )
