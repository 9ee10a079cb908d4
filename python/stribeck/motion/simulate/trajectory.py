"""Desired motions: strokes forward and back, Fourier series, and recorded positions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base.errors import SpecError

Array = NDArray[np.float64]


class Trajectory(Protocol):
    """A desired motion."""

    @property
    def duration(self) -> float:
        """Duration, s; of a periodic motion, one period."""

    def __call__(self, time: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at `time` [n] in s, arrays [n]."""


def _positive(name: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise SpecError(f"the trajectory's {name} is {value:g}: give a number above 0")


@dataclass(frozen=True)
class Trapezoid:
    """Forward and back with trapezoidal speed, from rest to rest.

    Attributes
    ----------
    start, end
        Where it turns, rad or m.
    speed, acceleration
        Limits, SI units; the speed is not reached on a short stroke.
    dwell
        Rest before each move, s.
    """

    start: float
    end: float
    speed: float
    acceleration: float
    dwell: float = 0.5

    def __post_init__(self) -> None:
        _positive("speed", self.speed)
        _positive("acceleration", self.acceleration)
        _check_ends(self.start, self.end, self.dwell)

    @property
    def duration(self) -> float:
        """There and back, s."""
        limits = [self.speed, self.acceleration]
        return 2.0 * _core.stroke([0.0], (self.start, self.end), self.dwell, limits)[1]

    def __call__(self, time: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at `time` [n] in s, arrays [n]."""
        limits = [self.speed, self.acceleration]
        return _core.stroke(time, (self.start, self.end), self.dwell, limits)[0]


@dataclass(frozen=True)
class Quintic:
    """Forward and back by quintic polynomials; speed and acceleration are zero at the ends.

    Attributes
    ----------
    start, end
        Where it turns, rad or m.
    move
        Duration of a move, s.
    dwell
        Rest before each move, s.
    """

    start: float
    end: float
    move: float
    dwell: float = 0.5

    def __post_init__(self) -> None:
        _check_ends(self.start, self.end, self.dwell)
        _positive("time per move", self.move)

    @property
    def duration(self) -> float:
        """There and back, s."""
        return 2.0 * (self.dwell + self.move)

    def __call__(self, time: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at `time` [n] in s, arrays [n]."""
        return _core.stroke(time, (self.start, self.end), self.dwell, [self.move])[0]


def _check_ends(start: float, end: float, dwell: float) -> None:
    if not (math.isfinite(start) and math.isfinite(end) and start != end):
        raise SpecError(f"a stroke from {start:g} to {end:g} has no length: give two positions")
    if not (math.isfinite(dwell) and dwell >= 0.0):
        raise SpecError(f"the trajectory's dwell is {dwell:g} s: give 0 or more")


@dataclass(frozen=True)
class Fourier:
    """A Fourier series, ``centre + sum_k sine[k] sin(k w t) + cosine[k] cos(k w t)``.

    Attributes
    ----------
    period
        Period of the first harmonic, s.
    sine, cosine
        Amplitudes of the harmonics, rad or m.
    """

    period: float
    sine: tuple[float, ...]
    cosine: tuple[float, ...]
    centre: float = 0.0

    def __post_init__(self) -> None:
        _positive("period", self.period)
        if not all(math.isfinite(x) for x in (*self.sine, *self.cosine, self.centre)):
            raise SpecError("a Fourier series needs finite amplitudes")

    @classmethod
    def from_rest(
        cls,
        amplitude: float,
        period: float,
        *,
        harmonics: int = 5,
        seed: int = 0,
        centre: float = 0.0,
    ) -> Fourier:
        """Return a random series that starts at the centre with zero speed and acceleration.

        Parameters
        ----------
        amplitude : float
            Largest distance from the centre, rad or m.
        period : float
            s.
        harmonics : int
            From 3 to 8.
        seed : int
        """
        _positive("amplitude", amplitude)
        if not 3 <= harmonics <= 8:
            raise SpecError(f"a Fourier series from rest has 3 to 8 harmonics, not {harmonics}")
        order = np.arange(1.0, harmonics + 1.0)
        rng = np.random.default_rng(seed)
        sine, cosine = rng.uniform(-1.0, 1.0, (2, harmonics)) / order
        # The sums of k sine (speed), k^2 cosine (acceleration) and cosine (position) must be zero.
        sine = _without(sine, order)
        flat = np.ones(harmonics)
        cosine = _without(_without(cosine, flat), _without(order**2, flat))
        drawn = cls(period, tuple(sine.tolist()), tuple(cosine.tolist()))
        largest = np.abs(drawn(np.linspace(0.0, period, 2000))[0]).max()
        scale = amplitude / largest
        return cls(period, tuple((scale * sine).tolist()), tuple((scale * cosine).tolist()), centre)

    @property
    def duration(self) -> float:
        """One period, s."""
        return self.period

    def __call__(self, time: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at `time` [n] in s, arrays [n]."""
        return _core.fourier(
            time, self.centre, math.tau / self.period, list(self.sine), list(self.cosine)
        )


def _without(vector: Array, direction: Array) -> Array:
    """Return the component of a vector orthogonal to a direction, with sums in a fixed order."""
    share = math.fsum(vector * direction) / math.fsum(direction * direction)
    return vector - share * direction


@dataclass(frozen=True)
class Sampled:
    """A recorded desired position, constant between samples, and its difference quotient.

    Attributes
    ----------
    position
        rad or m, array [n].
    step
        s.
    """

    position: Array
    step: float

    @property
    def duration(self) -> float:
        """Time of the last sample, s."""
        return (self.position.size - 1) * self.step

    def __call__(self, time: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at `time` [n] in s, arrays [n]."""
        row = np.clip(np.rint(time / self.step).astype(np.intp), 0, self.position.size - 1)
        velocity = np.gradient(self.position, self.step)
        return self.position[row], velocity[row], np.gradient(velocity, self.step)[row]
