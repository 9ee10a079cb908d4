"""Periodic motions: a Fourier series of five harmonics from rest to rest.

Swevers, Ganseman, Tukel, De Schutter and Van Brussel 1997, "Optimal robot excitation and
identification". In that paper the limits are constraints of the search. Here the series is scaled
by its exact extremes, so that every design vector gives a motion within the limits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.motion.design.motion import INSIDE, Limits, SampledMotion, sample_times

Array = NDArray[np.float64]

HARMONICS = 5
#: Smallest number of samples in a period of the highest harmonic.
FEWEST_SAMPLES = 20


@dataclass(frozen=True)
class FourierMotions:
    """Motions ``q(t) = c + sum_l A_l sin(l w t) + B_l cos(l w t)`` for `duration` s.

    The duration is a whole number of periods; speed and acceleration are 0 at both ends. The design
    vector contains the speed amplitudes of the harmonics (sine, then cosine), the period and the
    position in the range. At `rate` in Hz the highest harmonic has at least `FEWEST_SAMPLES`
    samples per period.
    """

    limits: Limits
    duration: float
    rate: float
    name: str = "Fourier series"

    @property
    def variables(self) -> int:
        """Two variables per harmonic, the period and the position."""
        return 2 * HARMONICS + 2

    @property
    def start(self) -> Array:
        """Three sines in the middle of the range."""
        design = np.full(self.variables, 0.5)
        design[:3] = (1.0, 0.2, 0.7)
        return design

    def motion(self, design: Array, rate: float) -> SampledMotion:
        """Return the motion of a design vector [variables], sampled at `rate` in Hz."""
        sine, cosine = _from_rest(2.0 * design[:HARMONICS] - 1.0, _second(design))
        frequency = 2.0 * math.pi * self._periods(design[-2]) / self.duration
        low, high = extremes(sine, cosine)
        scale = self._scale(sine, cosine, frequency, high - low)
        slack = self.limits.stroke * INSIDE - scale * (high - low)
        middle = self.limits.low + 0.5 * self.limits.stroke * (1.0 - INSIDE)
        place = middle - scale * low + max(slack, 0.0) * design[-1]
        time = sample_times(self.duration, rate)
        within = np.minimum(time, self.duration)
        q, v, a = series(scale * sine, scale * cosine, frequency, within)
        return SampledMotion(time, place + q, v, a)

    def _periods(self, share: float) -> int:
        """Number of periods, between one and the most that the limits allow for a large motion."""
        limits = self.limits
        reach = 0.5 * limits.stroke
        swing = 2.0 * math.pi * max(reach / limits.speed, math.sqrt(reach / limits.acceleration))
        quickest = max(0.5 * swing, HARMONICS * FEWEST_SAMPLES / self.rate)
        most = max(1.0, self.duration / quickest)
        return max(1, round(most**share))

    def _scale(self, sine: Array, cosine: Array, frequency: float, height: float) -> float:
        """The largest factor with which the series is within the limits."""
        speed = np.abs(extremes(*_derivative(sine, cosine))).max() * frequency
        bend = np.abs(extremes(*_derivative(*_derivative(sine, cosine)))).max() * frequency**2
        limits = self.limits
        if height <= 0 or speed <= 0 or bend <= 0:
            return 0.0
        return float(
            INSIDE * min(limits.stroke / height, limits.speed / speed, limits.acceleration / bend)
        )


def _second(design: Array) -> Array:
    return 2.0 * design[HARMONICS : 2 * HARMONICS] - 1.0


def _from_rest(sine: Array, cosine: Array) -> tuple[Array, Array]:
    """Position amplitudes from speed amplitudes, with zero initial speed and acceleration."""
    order = np.arange(1, HARMONICS + 1, dtype=np.float64)
    sine, cosine = sine / order, cosine / order
    return (
        sine - order * (order @ sine) / (order @ order),
        cosine - order**2 * (order**2 @ cosine) / (order**2 @ order**2),
    )


def series(sine: Array, cosine: Array, frequency: float, time: Array) -> tuple[Array, Array, Array]:
    """The series and its first two derivatives at `time` [n], `frequency` in rad/s."""
    order = frequency * np.arange(1, sine.size + 1)
    phase = np.outer(time, order)
    s, c = np.sin(phase), np.cos(phase)
    return (
        s @ sine + c @ cosine,
        c @ (order * sine) - s @ (order * cosine),
        -s @ (order**2 * sine) - c @ (order**2 * cosine),
    )


def _derivative(sine: Array, cosine: Array) -> tuple[Array, Array]:
    """Amplitudes of the derivative with respect to the phase."""
    order = np.arange(1, sine.size + 1)
    return -order * cosine, order * sine


def extremes(sine: Array, cosine: Array) -> tuple[float, float]:
    """Smallest and largest value of ``sum_l sine_l sin(l x) + cosine_l cos(l x)``.

    They are exact: values at the roots of the derivative, a polynomial in ``exp(i x)``.

    Examples
    --------
    >>> low, high = extremes(np.array([0.0, 2.0]), np.array([0.0, 0.0]))
    >>> round(low, 12), round(high, 12)
    (-2.0, 2.0)
    """
    by_sine, by_cosine = _derivative(sine, cosine)
    upper = 0.5 * (by_cosine - 1j * by_sine)
    roots = np.roots(np.concatenate([upper[::-1], [0.0], upper.conj()]))
    at = np.concatenate([[0.0], np.angle(roots)])
    values = series(sine, cosine, 1.0, at)[0]
    return float(values.min()), float(values.max())
