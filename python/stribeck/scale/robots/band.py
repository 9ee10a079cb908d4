"""Bandwidth of a joint's motion over all samples of a data set."""

from __future__ import annotations

import numpy as np

from stribeck.identify.scaling import model_for
from stribeck.robot.fit import ORDINARY
from stribeck.scale.streaming.dataset import DataSet
from stribeck.scale.streaming.sample import Sample
from stribeck.scale.streaming.windows import Windows

__all__ = ["motion_band"]

#: Samples whose spectrum is computed at once: stretches of the sample would be too short for the
#: slow motions of arms.
ROWS = 1 << 16


def motion_band(data: DataSet, sample: Sample) -> float | None:
    """Frequency [Hz] below which 99 % of the velocity's power lies; None if there is no motion.

    The power is summed over windows of equal length (Bartlett, Biometrika 37, 1950).
    """
    power = np.zeros(ROWS // 2 + 1)
    for window in Windows(data, sample, model_for(ORDINARY, sample.recording), ROWS):
        velocity = window.recording.velocity[window.own]
        # The last window is shorter: zeros follow it.
        power += np.abs(np.fft.rfft(velocity - velocity.mean(), ROWS)) ** 2
    total = np.cumsum(power)
    if total[-1] <= 0.0:
        return None
    place = int(np.searchsorted(total, 0.99 * total[-1]))
    return float(max(place, 1) * sample.recording.rate_hz / ROWS)
