"""Coordinates in which the nonlinear parameters of a model are searched."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.problem import Problem
from stribeck.identify.scaling import scaled_parameters
from stribeck.models.parameter import Parameter
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: The golden ratio minus one.
GOLDEN = (5.0**0.5 - 1.0) / 2.0
#: Decades of the size of a value that depends on temperature, below its largest start.
DECADES = 3.0
#: Largest start of a relative change over the span of temperatures: the value may change its sign.
RELATIVE_CHANGE = 2.0


@dataclass(frozen=True)
class Polynomial:
    """Parameters that are the coefficients of a quantity in powers of the temperature.

    They are strongly correlated, since temperatures lie far from 0 degC: starts are drawn for the
    value at the mean temperature and its changes over the span, and converted.

    Attributes
    ----------
    indices
        Of the constant, the slope and, where there is one, the square.
    """

    indices: tuple[int, ...]
    mean: float
    span: float

    def centred(self, values: Array) -> Array:
        """Value at the mean temperature, and changes over half the span [len(indices)]."""
        constant, slope, *rest = values[list(self.indices)]
        square = rest[0] if rest else 0.0
        half = 0.5 * self.span
        value = constant + slope * self.mean + square * self.mean**2
        changes = [value, (slope + 2.0 * square * self.mean) * half, square * half**2]
        return np.array(changes[: len(self.indices)])

    def raw(self, centred: Array) -> Array:
        """Coefficients [len(indices)] of a value and its changes; the inverse of `centred`."""
        half = 0.5 * self.span
        value, slope = centred[0], centred[1] / half
        square = centred[2] / half**2 if len(self.indices) > 2 else 0.0
        coefficients = [
            value - slope * self.mean + square * self.mean**2,
            slope - 2.0 * square * self.mean,
            square,
        ]
        return np.array(coefficients[: len(self.indices)])


class SearchSpace:
    """Coordinates of the nonlinear parameters; 0..1 is the range of random starts.

    Speeds, exponents and stiffnesses span decades: where the range is above zero, the coordinate is
    linear in the logarithm. A parameter with equal bounds is held and has none. Bounds may lie far
    outside 0..1.

    Parameters
    ----------
    parameters
        All p parameters of a model, scaled to a recording.
    lower, upper : arrays [p]
        Their bounds.
    recording
        The recording, for its temperatures.

    Attributes
    ----------
    nonlinear, logarithmic : bool arrays [p]
        Which parameters have a coordinate, and which are searched in steps of their logarithm: the
        stiffness of bristles, since a step that suits a soft bristle hardly changes a stiff one.
    enclosed : bool
        Whether every nonlinear parameter has a finite range of random starts.
    """

    def __init__(
        self, parameters: Sequence[Parameter], lower: Array, upper: Array, recording: Recording
    ) -> None:
        linear = np.array([p.linear for p in parameters], dtype=bool)
        self.lower, self.upper = lower, upper
        self.nonlinear = ~linear & (lower < upper)
        stiffness = np.array([p.scale == "stiffness" for p in parameters], dtype=bool)
        self.logarithmic = self.nonlinear & stiffness & (lower > 0.0)
        # With a bristle the torque is nearly linear in the amplitudes of dry friction: a search
        # finds them from any start, and random ones would only make the start worse.
        amplitude = np.array([p.role == "dry" for p in parameters], dtype=bool)
        self.sought = self.nonlinear & ~amplitude
        drawn = np.array([p.drawn for p in parameters], dtype=np.float64).reshape(-1, 2)
        self._low, self._high = drawn[self.nonlinear].T
        self.enclosed = bool(np.all(np.isfinite(drawn[self.nonlinear])))
        self._log = self._low > 0.0
        self.polynomials = _polynomials(parameters, self.sought, recording)

    @classmethod
    def of(cls, problem: Problem, lower: Array, upper: Array) -> SearchSpace:
        """The space of a problem's model on its recording."""
        rows = scaled_parameters(problem.model, problem.recording)
        return cls(rows, lower, upper, problem.recording)

    def encode(self, values: Array) -> Array:
        """Search coordinates [..., k] of the k nonlinear parameters among `values` [..., p]."""
        low, high = self._low, self._high
        x = values[..., self.nonlinear]
        with np.errstate(divide="ignore", invalid="ignore"):
            logarithmic = np.log(x / low) / np.log(high / low)
            return np.where(self._log, logarithmic, (x - low) / (high - low))

    def decode(self, u: Array) -> Array:
        """Nonlinear parameters [..., k] at search coordinates `u`, array [..., k]."""
        low, high = self._low, self._high
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            logarithmic = low * (high / low) ** u
        x = np.where(self._log, logarithmic, low + u * (high - low))
        return np.clip(x, self.lower[self.nonlinear], self.upper[self.nonlinear])

    def slope(self, values: Array) -> Array:
        """Derivatives of the nonlinear parameters by their coordinates, array [k]."""
        x = values[self.nonlinear]
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self._log, x * np.log(self._high / self._low), self._high - self._low)

    def placed(self, start: Array, u: Array) -> Array:
        """`start` [p] with its nonlinear parameters at coordinates `u` [..., k]."""
        values = np.tile(start, (*u.shape[:-1], 1))
        values[..., self.nonlinear] = self.decode(u)
        return values

    def placed_at_mean_temperature(self, start: Array, u: Array) -> Array:
        """As `placed`, with coordinates of values at the mean temperature and relative changes."""
        values = self.placed(start, u)
        position = np.cumsum(self.nonlinear) - 1
        for polynomial in self.polynomials:
            at = position[list(polynomial.indices)]
            largest = max(abs(self._low[at[0]]), abs(self._high[at[0]]))
            for row, share in zip(values, u[:, at], strict=True):
                signed = 2.0 * share[0] - 1.0 if self._low[at[0]] < 0.0 else 1.0 - share[0]
                value = np.copysign(largest * 10.0 ** (-DECADES * (1.0 - abs(signed))), signed)
                change = value * RELATIVE_CHANGE * (2.0 * share[1:] - 1.0)
                self._put(row, polynomial, np.array([value, *change]))
        return values

    def moved(self, values: Array, step: Array) -> Array:
        """`values` [p] after a step [k] in search coordinates.

        Coefficients of a polynomial in temperature move relative to the size of the quantity.
        """
        after = self.placed(values, self.encode(values) + step)
        position = np.cumsum(self.nonlinear) - 1
        for polynomial in self.polynomials:
            centred = polynomial.centred(values)
            own = step[position[list(polynomial.indices)]]
            self._put(after, polynomial, centred + np.abs(centred).sum() * own)
        return after

    def _put(self, values: Array, polynomial: Polynomial, centred: Array) -> None:
        at = list(polynomial.indices)
        values[at] = np.clip(polynomial.raw(centred), self.lower[at], self.upper[at])

    def further(self, values: Array, parameters: Sequence[int]) -> Array:
        """Move some nonlinear parameters of `values` [p] by the golden section of their range.

        A parameter that passes the end of its range continues at the other end. So repeated moves
        cover the range evenly and never meet the same place twice.
        """
        which = np.isin(np.flatnonzero(self.nonlinear), parameters)
        u = self.encode(values)
        moved = values.copy()
        moved[self.nonlinear] = self.decode(np.where(which, (u + GOLDEN) % 1.0, u))
        return moved

    def drawn(self, start: Array, random: np.random.Generator) -> Array:
        """`start` [p] with random nonlinear parameters, uniform in the search coordinates."""
        return self.placed(start, random.uniform(size=int(self.nonlinear.sum())))


def _polynomials(
    parameters: Sequence[Parameter], sought: Mask, recording: Recording
) -> tuple[Polynomial, ...]:
    """The quantities whose coefficients in powers of the temperature are all searched.

    The catalog names the coefficients of a quantity ``NAME``, ``NAME_slope`` and ``NAME_square``,
    and a direction behind them.
    """
    if recording.temperature is None:
        return ()
    warm = recording.temperature[recording.moving]
    mean, span = float(warm.mean()), float(np.ptp(warm))
    if span <= 0.0:
        return ()
    names = [p.name for p in parameters]
    found = []
    for k, name in enumerate(names):
        constant = name.replace("_slope", "")
        if "_slope" not in name or constant not in names:
            continue
        members = [names.index(constant), k]
        square = name.replace("_slope", "_square")
        if square in names:
            members.append(names.index(square))
        if all(sought[member] for member in members):
            found.append(Polynomial(tuple(members), mean, span))
    return tuple(found)
