"""Noise of a load torque, where motion hardly needs any.

A differentiated velocity has noise, and so has the load torque made of it. In steady motion the
noise is all there is of an inertia's torque: it changes its sign many times a second.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base import low_pass
from stribeck.recording.derive import HIGHEST
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: What is faster than so many times the band of the motion is noise.
BANDS = 3.0
#: Standard deviation of normal noise over the median of its size.
NORMAL = 1.4826


def load_noise(recording: Recording, load: Array) -> float:
    """Standard deviation of the noise of a load torque [n]; 0 where motion is as fast as noise.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(0.0, 20.0, 0.01)
    >>> v = np.sin(2 * np.pi * 0.5 * t)
    >>> r = Recording.from_columns(time=t, velocity=v, torque=v)
    >>> noise = 0.1 * np.random.default_rng(0).standard_normal(t.size)
    >>> round(load_noise(r, 3.0 * v + noise), 2)
    0.1
    """
    band, rate = recording.motion_band, recording.rate_hz
    if band is None or BANDS * band >= HIGHEST * rate or not recording.moving.any():
        return 0.0
    fast = load - low_pass.zero_phase(load, BANDS * band, rate)
    return NORMAL * float(np.median(np.abs(fast[recording.moving])))
