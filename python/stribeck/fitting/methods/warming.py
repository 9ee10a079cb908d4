"""The thermal time constant of a joint, and when its temperature has settled.

Bittencourt et al. 2010, section II-B: friction curves count only after twice the decay constant,
when the joint is expected to be in thermal equilibrium.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from stribeck.base.errors import FitError

#: Time constants after which a temperature counts as settled; 13 % of the change are left.
SETTLED_AFTER = 2.0


@dataclass(frozen=True)
class Warming:
    """A temperature that settles as ``T = settled + (start - settled) exp(-t/constant)``.

    Attributes
    ----------
    constant, stderr
        Time constant and its standard error, in the unit of the time that was given.
    start, settled
        Temperatures at the first sample and in equilibrium, degC.
    """

    constant: float
    stderr: float
    start: float
    settled: float

    def in_equilibrium(self, time: ArrayLike) -> NDArray[np.bool_]:
        """Which samples are later than twice the constant after the first one, bool array [n]."""
        t = np.asarray(time, dtype=np.float64)
        return np.asarray(t - t[0] > SETTLED_AFTER * self.constant)


def warming(time: ArrayLike, temperature: ArrayLike) -> Warming:
    """Identify the time constant of a joint that warms up or cools.

    Parameters
    ----------
    time : array [n]
        Any unit.
    temperature : array [n]
        degC.

    Raises
    ------
    FitError
        Fewer than five samples, or no constant between the spacing and ten times the span of time.

    Examples
    --------
    >>> hours = np.linspace(0.0, 10.0, 50)
    >>> round(warming(hours, 40.0 - 18.0 * np.exp(-hours / 3.04)).constant, 2)
    3.04
    """
    t, T = np.asarray(time, dtype=np.float64), np.asarray(temperature, dtype=np.float64)
    if t.size < 5 or t.size != T.size or not (np.isfinite(t).all() and np.isfinite(T).all()):
        raise FitError(
            f"{t.size} times and {T.size} temperatures do not show a time constant: give five or "
            f"more finite pairs"
        )
    span = float(t[-1] - t[0])

    def settling(at: NDArray[np.float64], end: float, change: float, constant: float) -> object:
        return end + change * np.exp(-(at - t[0]) / constant)

    low, high = span / t.size, 10.0 * span
    (end, change, constant), covariance = scipy.optimize.curve_fit(
        settling,
        t,
        T,
        p0=(T[-1], T[0] - T[-1], span / 3.0),
        bounds=((-np.inf, -np.inf, low), (np.inf, np.inf, high)),
    )
    if not low < constant < 0.999 * high:
        raise FitError(
            "the temperature does not settle in the recorded time: record for more than two time "
            "constants"
        )
    return Warming(float(constant), float(np.sqrt(covariance[2, 2])), end + change, float(end))
