"""How late a recorded velocity is, measured against the recorded position.

Drives report a velocity behind a low-pass filter. Of a filter of first order with the time constant
tau, ``v + tau dv/dt = dq/dt``; any other lag has the same first term. Least squares gives tau from
position and velocity alone, without torque and without a model.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.recording import Recording

__all__ = ["VelocityLag", "recorded_lag", "velocity_lag"]

#: Number of stretches whose estimates give the standard error, and of standard errors by which a
#: lag exceeds its limit.
STRETCHES, CERTAIN = 20, 3.0


@dataclass(frozen=True)
class VelocityLag:
    """Time by which the velocity lags the position, and its standard error, s."""

    lag: float
    error: float

    def exceeds(self, limit: float) -> bool:
        """Whether the lag is certainly larger than `limit`."""
        return self.lag - CERTAIN * self.error > limit


def velocity_lag(time: Floats, position: Floats, velocity: Floats, segment: Ints) -> VelocityLag:
    """Lag of a velocity [n] against the derivative of a position [n].

    Zero with an infinite error where the motion does not show it.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(4000) / 100.0
    >>> found = velocity_lag(t, -np.cos(t), np.sin(t - 0.03), np.zeros(4000, dtype=np.int64))
    >>> round(found.lag, 3), found.exceeds(0.01)
    (0.03, True)
    """
    unknown = VelocityLag(0.0, float("inf"))
    inside = segment[2:] == segment[:-2]
    if np.count_nonzero(inside) < 10 * STRETCHES:
        return unknown
    span = (time[2:] - time[:-2])[inside]
    rate = (velocity[2:] - velocity[:-2])[inside] / span
    ahead = (position[2:] - position[:-2])[inside] / span - velocity[1:-1][inside]
    stretch = np.arange(rate.size) * STRETCHES // rate.size
    product = np.bincount(stretch, ahead * rate, STRETCHES)
    square = np.bincount(stretch, rate**2, STRETCHES)
    if not square.sum() > 0.0:
        return unknown
    lag = float(product.sum() / square.sum())
    scores = product - lag * square
    spread = float(np.sqrt(np.sum(scores**2) * STRETCHES / (STRETCHES - 1)))
    return VelocityLag(lag, spread / float(square.sum()))


def recorded_lag(recording: Recording) -> VelocityLag | None:
    """How late the recorded velocity is; None where position and velocity are not both recorded."""
    r = recording
    if r.averaged or r.position is None or r.rate_hz <= 0 or r.columns["velocity"].derived:
        return None
    return velocity_lag(r.time, r.position, r.velocity, r.segment)
