"""Samples whose friction is that of a rest or a reversal, because the torque is late or early.

At rest the friction is whatever holds the joint, which no model predicts. A torque that is late
shows it in the samples after the joint has started, one that is early in those before it stops.
There every friction model is wrong by up to twice the dry friction. At a reversal the direction of
the slow samples is uncertain, and so is the sign of the torque that is theirs.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.left_out.torque_shift import is_delayed, torque_shift
from stribeck.recording.recording import Recording
from stribeck.recording.rows import neighbour

Bools = NDArray[np.bool_]

#: Samples by which the doubt exceeds twice the shift.
MARGIN = 2
#: Largest share of the moving samples that are in doubt.
MOST = 0.5


def friction_of_rest(recording: Recording) -> Bools:
    """Moving samples that may show the friction of a rest, bool [n].

    They are within twice the shift of the torque from a rest, or nearer where that would be most
    samples; none where the torque is in time.
    """
    shift = abs(torque_shift(recording))
    if shift == 0:
        return np.zeros(recording.time.size, dtype=bool)
    reach = 2 * shift + MARGIN
    most = MOST * np.count_nonzero(recording.moving)
    while np.count_nonzero(found := beside_rest(recording, reach)) > most:
        reach //= 2
    return found


def friction_of_slow_motion(recording: Recording) -> Bools:
    """Moving samples whose torque is that of a slow sample, bool [n].

    None where the torque is late by a sample at most: those would be all samples that show it. Nor
    where that need not be a delay, or where they would be most samples.
    """
    shift, moving = torque_shift(recording), recording.moving
    if abs(shift) <= 1 or not is_delayed(recording):
        return np.zeros(moving.size, dtype=bool)
    shown = (
        neighbour(moving.astype(np.float64), recording.segment, -ago)
        for ago in (shift - 1, shift, shift + 1)
    )
    slow = moving & (np.min(list(shown), axis=0) == 0.0)
    return slow & (np.count_nonzero(slow) <= MOST * np.count_nonzero(moving))


def beside_rest(recording: Recording, reach: int) -> Bools:
    """Moving samples within `reach` samples of a rest that lasts more than twice that, bool [n].

    A shorter stretch of slow samples is a reversal, in which friction changes its sign.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(0.0, 3.0, 0.01)
    >>> v = np.where(np.abs(t - 1.5) < 0.3, 0.0, 1.0)
    >>> r = Recording.from_columns(time=t, velocity=v, torque=np.ones(t.size))
    >>> int(beside_rest(r, 5).sum())
    10
    """
    moving, segment = recording.moving, recording.segment
    changes = np.flatnonzero((moving[1:] != moving[:-1]) | (segment[1:] != segment[:-1])) + 1
    starts = np.concatenate([[0], changes])
    ends = np.concatenate([changes, [moving.size]])
    rests = ~moving[starts] & (ends - starts > 2 * reach)
    beside = np.zeros(moving.size, dtype=bool)
    for start, end in zip(starts[rests], ends[rests], strict=True):
        near = slice(max(start - reach, 0), end + reach)
        beside[near] |= segment[near] == segment[start]
    return beside & moving
