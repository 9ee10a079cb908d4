"""Sampled motions, their limits, and families of motions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import SpecError

Array = NDArray[np.float64]

#: Share of a limit that is used, so that rounding cannot exceed it.
INSIDE = 1.0 - 1e-9


@dataclass(frozen=True)
class Limits:
    """Range of position, largest speed and acceleration, in rad or m and s.

    Examples
    --------
    >>> Limits(-1.0, 1.0, 2.0, 10.0).stroke
    2.0
    """

    low: float
    high: float
    speed: float
    acceleration: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            raise SpecError(
                f"the positions {self.low:g} .. {self.high:g} are not a range: give LOW:HIGH"
            )
        for what, value in (("speed", self.speed), ("acceleration", self.acceleration)):
            if not (math.isfinite(value) and value > 0):
                raise SpecError(f"the largest {what} is {value:g}: give a number above 0")

    @property
    def stroke(self) -> float:
        """Length of the range."""
        return self.high - self.low

    def hold(self, motion: SampledMotion) -> bool:
        """Whether every sample of `motion` is within the limits."""
        return bool(
            np.all(motion.position >= self.low)
            and np.all(motion.position <= self.high)
            and np.all(np.abs(motion.velocity) <= self.speed)
            and np.all(np.abs(motion.acceleration) <= self.acceleration)
        )


@dataclass(frozen=True)
class SampledMotion:
    """Samples of a motion: arrays [n] in s, rad or m."""

    time: Array
    position: Array
    velocity: Array
    acceleration: Array


class Family(Protocol):
    """Motions given by a design vector of numbers between 0 and 1, all within the limits."""

    @property
    def name(self) -> str:
        """Name in one or two words."""

    @property
    def variables(self) -> int:
        """Length of the design vector."""

    @property
    def start(self) -> Array:
        """Design vector of a good initial motion."""

    def motion(self, design: Array, rate: float) -> SampledMotion:
        """Return the motion of a design vector, from rest to rest, sampled at `rate` in Hz."""


def sample_times(duration: float, rate: float) -> Array:
    """Times from 0 to `duration` in s, or to the sample after it, array [n]."""
    return np.arange(math.ceil(duration * rate * INSIDE) + 1) / rate
