"""Velocity and acceleration that were not recorded, by zero-phase filters chosen from the data."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.derive import HIGHEST, Smoother, choose_cutoff, motion_band

if TYPE_CHECKING:
    from stribeck.recording.recording import Recording

__all__ = ["acceleration_cutoff", "cutoff_of", "filtered_noise", "slope"]

#: The cut-off of a derived acceleration is at most this many times the band of the motion.
_BANDS = 20.0


def slope(time: Floats, value: Floats, segment: Ints) -> tuple[Floats, float | None]:
    """The derivative of a signal by time, [n], and the cut-off [Hz] of its filter; None: no filter.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(200) / 100.0
    >>> speed, _ = slope(t, 3.0 * t, np.zeros(200, dtype=np.int64))
    >>> round(float(speed[50]), 6)
    3.0
    """
    cutoff = choose_cutoff(time, value, segment, 2)
    return Smoother(time, segment, cutoff).smooth(value, 1), cutoff


def filtered_noise(
    noise: float, period: float, cutoff: float | None, derivative: int = 1
) -> float | None:
    """Standard deviation of white noise after derivatives by time and a low-pass; None: no filter.

    The spectral density of the noise, ``2 noise^2 period``, times ``(2 pi f)^(2 derivative)``, up
    to the cut-off.

    Parameters
    ----------
    noise
        Standard deviation of the noise of the signal.
    period
        Sampling period, s.
    """
    if cutoff is None:
        return None
    power = 2 * derivative + 1
    in_band = math.sqrt(2.0 * period * cutoff**power / power)
    return (2.0 * math.pi) ** derivative * noise * in_band


def acceleration_cutoff(
    time: Floats, velocity: Floats, segment: Ints, typical: float, cutoff: float | None
) -> float | None:
    """The cut-off [Hz] for an acceleration; None: no filter.

    Differentiation amplifies vibration above the motion, which no rigid body follows: where noise
    does not limit the cut-off, the band of the motion does.

    Parameters
    ----------
    typical
        Median step, s.
    cutoff
        Of the velocity.
    """
    band = motion_band(time, velocity, segment)
    limits = [x for x in (cutoff, None if band is None else _BANDS * band) if x is not None]
    highest = min(limits, default=None)
    # A cut-off that the samples do not reach is none.
    return None if highest is None or highest >= HIGHEST / typical else highest


def cutoff_of(recording: Recording) -> float | None:
    """The cut-off [Hz] for an acceleration that is derived from a recording; None: no filter."""
    r = recording
    if r.acceleration_filter is not None:
        return r.acceleration_filter.cutoff
    period = r.scales()["sample_period"]
    return acceleration_cutoff(r.time, r.velocity, r.segment, period, r.cutoff_hz)
