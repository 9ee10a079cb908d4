"""Samples whose direction of motion is uncertain, because the recorded velocity is late.

Friction changes its sign where the motion does; a velocity behind a filter does so later. Between
the two every friction model is wrong by twice the dry friction, and whatever is added to it
imitates the filter. How late the velocity is follows from the recording alone, by comparison with
the position.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stribeck.recording.motion.velocity_lag import VelocityLag, recorded_lag
from stribeck.recording.recording import Recording

#: Lag in samples below which no sample is left out.
LEAST = 1.0


def late_velocity(recording: Recording) -> VelocityLag | None:
    """The lag of the recorded velocity; None where it is below a sample, or cannot be told."""
    late = recorded_lag(recording)
    return None if late is None or not late.exceeds(LEAST / recording.rate_hz) else late


def uncertain_direction(recording: Recording) -> NDArray[np.bool_]:
    """Scored samples within the lag of the velocity before it changes its sign, bool [n]."""
    uncertain = np.zeros(recording.time.size, dtype=bool)
    late = late_velocity(recording)
    if late is None:
        return uncertain
    sign, rows = np.sign(recording.velocity), np.arange(uncertain.size)
    for ahead in range(1, math.ceil(late.lag * recording.rate_hz) + 1):
        at = np.minimum(rows + ahead, uncertain.size - 1)
        uncertain |= (sign[at] != sign) & (recording.segment[at] == recording.segment)
    return uncertain & recording.moving
