"""Held-out error in the band of the motion, where friction acts and vibration does not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.result import Fit
from stribeck.identify.figures import bridged, zero_phase


def held_out_in_band(fit: Fit, before: Fit) -> NDArray[np.float64]:
    """Held-out residual in the band, on the samples that `before` was fitted to, array [m]."""
    r = before.recording
    return np.asarray(zero_phase(r, bridged(r, fit.held_out_residual))[before.rows])
