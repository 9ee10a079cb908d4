"""Single moves, each an analytic function of time, at rest before and after."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
#: Position, velocity and acceleration at times since the start of the move.
Move = Callable[[Array], tuple[Array, Array, Array]]


def trapezoid(delta: float, vmax: float, amax: float) -> tuple[float, Move]:
    """A move of `delta` with trapezoidal speed."""
    d, s = abs(delta), math.copysign(1.0, delta)
    top = min(vmax, math.sqrt(d * amax))
    ramp = top / amax
    total = d / top + ramp

    def move(t: Array) -> tuple[Array, Array, Array]:
        left = total - t
        up, down = t < ramp, left < ramp
        q = np.where(up, amax * t * t / 2, top * (t - ramp / 2))
        q = np.where(down, d - amax * left * left / 2, q)
        v = np.where(up, amax * t, np.where(down, amax * left, top))
        a = np.where(up, amax, np.where(down, -amax, 0.0))
        return s * q, s * v, s * a

    return total, move


def quintic(delta: float, total: float) -> Move:
    """A minimum-jerk move."""

    def move(t: Array) -> tuple[Array, Array, Array]:
        x = t / total
        return (
            delta * x**3 * (10 - 15 * x + 6 * x * x),
            delta * 30 * x * x * (1 - x) ** 2 / total,
            delta * 60 * x * (1 - x) * (1 - 2 * x) / total**2,
        )

    return move


def stroke(delta: float, total: float) -> Move:
    """Half a cosine, with full acceleration at both ends."""
    w = math.pi / total

    def move(t: Array) -> tuple[Array, Array, Array]:
        c, s = np.cos(w * t), np.sin(w * t)
        return delta / 2 * (1 - c), delta / 2 * w * s, delta / 2 * w * w * c

    return move


def multisine(amp: Array, omega: Array, phase: Array, total: float, ramp: float) -> Move:
    """A sum of sines that fades in and out, so that it starts and ends at rest."""

    def fade(t: Array) -> tuple[Array, Array, Array]:
        x = np.clip(np.minimum(t, total - t) / ramp, 0.0, 1.0)
        s = np.where(t < total / 2, 1.0, -1.0)
        return (
            x**3 * (10 - 15 * x + 6 * x * x),
            s * 30 * x * x * (1 - x) ** 2 / ramp,
            60 * x * (1 - x) * (1 - 2 * x) / ramp**2,
        )

    def move(t: Array) -> tuple[Array, Array, Array]:
        arg = omega[:, None] * t + phase[:, None]
        f0 = amp @ np.sin(arg)
        f1 = (amp * omega) @ np.cos(arg)
        f2 = -(amp * omega**2) @ np.sin(arg)
        w0, w1, w2 = fade(t)
        return w0 * f0, w1 * f0 + w0 * f1, w2 * f0 + 2 * w1 * f1 + w0 * f2

    return move
