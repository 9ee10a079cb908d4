"""Work of a LuGre bristle over held velocities, integrated by hand: no code of the core in it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bristle:
    """``dz/dt = v - s0 |v|/D z``, ``tf = s0 z + s1 dz/dt + s2 v``, D falling from `static`."""

    stiffness: float
    damping: float
    viscous: float
    coulomb: float
    static: float
    speed: float
    exponent: float

    def strength(self, v: Array) -> Array:
        """D at velocities."""
        fall = np.exp(-(np.abs(v / self.speed) ** self.exponent))
        return self.coulomb + (self.static - self.coulomb) * fall

    def deflection(self, v: float, torque: float) -> float:
        """At a velocity with this torque."""
        rate = self.stiffness * abs(v) / float(self.strength(np.float64(v)))
        return (torque - (self.damping + self.viscous) * v) / (self.stiffness - self.damping * rate)

    def duration(self, start: Array, end: Array, v: Array) -> Array:
        """How long the deflection takes; NaN where it does not get there."""
        rate = self.stiffness * np.abs(v) / self.strength(v)
        settled = np.sign(v) * self.strength(v) / self.stiffness
        with np.errstate(all="ignore"):
            time = np.log((settled - start) / (settled - end)) / rate
        return np.where(np.isfinite(time) & (time > 0.0), time, np.nan)

    def work(self, start: Array, v: Array, time: Array) -> Array:
        """Integral of tf v over a while in which v is held, from its antiderivative."""
        rate = self.stiffness * np.abs(v) / self.strength(v)
        settled = np.sign(v) * self.strength(v) / self.stiffness
        gone = -np.expm1(-rate * time)
        spring = self.stiffness * (settled * time + (start - settled) * gone / rate)
        damper = self.damping * (settled - start) * gone
        return v * (spring + damper + self.viscous * v * time)


@dataclass(frozen=True)
class Cycles:
    """Random cycles of a bristle between two deflections, one velocity up and one down."""

    bristle: Bristle
    low: Array
    high: Array
    up: Array
    down: Array

    @classmethod
    def inside(cls, bristle: Bristle, limit: float, count: int, rng: np.random.Generator) -> Cycles:
        """At speeds up to `limit`, spread over decades."""
        reach = bristle.static / bristle.stiffness
        ends = np.sort(rng.uniform(-reach, reach, (2, count)), axis=0)
        size = limit * 10.0 ** rng.uniform(-5.0, 0.0, (2, count))
        up, down = np.where(rng.uniform(size=(2, count)) < 0.5, -size, size)
        return cls(bristle, ends[0], ends[1], up, down)

    @cached_property
    def work(self) -> Array:
        """What each takes, J; infinite where it does not close."""
        rise = self.bristle.duration(self.low, self.high, self.up)
        fall = self.bristle.duration(self.high, self.low, self.down)
        work = self.bristle.work(self.low, self.up, rise)
        work = work + self.bristle.work(self.high, self.down, fall)
        return np.where(np.isfinite(work), work, np.inf)

    @cached_property
    def energy(self) -> Array:
        """The largest that is in the spring on the way, J."""
        far = np.maximum(np.abs(self.low), np.abs(self.high))
        return 0.5 * self.bristle.stiffness * far**2
