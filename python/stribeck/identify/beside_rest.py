"""Samples whose friction a delay takes from a rest, where no model knows it.

At rest the friction is whatever holds the joint. A torque that is late shows some of that in the
samples after the joint has started, and one that is early in those before it stops.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.scaling import scaled_parameters
from stribeck.models.model import Model
from stribeck.recording.recording import Recording


def delayed_rest(model: Model, recording: Recording) -> NDArray[np.bool_]:
    """Moving samples that a delay within its bounds may take from a rest, bool [n].

    There are none without a delay in the model.
    """
    if "delay" not in model.names:
        return np.zeros(recording.time.size, dtype=bool)
    delay = scaled_parameters(model, recording)[model.names.index("delay")]
    return beside_rest(recording, max(-delay.lower, delay.upper))


def beside_rest(recording: Recording, within: float) -> NDArray[np.bool_]:
    """Moving samples within a time of a rest that lasts longer than twice that, bool [n].

    A shorter stretch of slow samples is a reversal, in which friction changes its sign.

    Parameters
    ----------
    within : float
        Time in s.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(0.0, 3.0, 0.01)
    >>> v = np.where(np.abs(t - 1.5) < 0.3, 0.0, 1.0)
    >>> r = Recording.from_columns(time=t, velocity=v, torque=np.ones(t.size))
    >>> int(beside_rest(r, 0.05).sum())
    10
    """
    moving, segment = recording.moving, recording.segment
    reach = math.ceil(within * recording.rate_hz)
    changes = np.flatnonzero((moving[1:] != moving[:-1]) | (segment[1:] != segment[:-1])) + 1
    starts = np.concatenate([[0], changes])
    ends = np.concatenate([changes, [moving.size]])
    rests = ~moving[starts] & (ends - starts > 2 * reach)
    beside = np.zeros(moving.size, dtype=bool)
    for start, end in zip(starts[rests], ends[rests], strict=True):
        near = slice(max(start - reach, 0), end + reach)
        beside[near] |= segment[near] == segment[start]
    return beside & moving
