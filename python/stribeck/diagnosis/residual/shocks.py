"""Shocks after the load torque changes its sign: a sign of lost motion in the drive train.

Where teeth change flanks, the motor first turns freely, and then meets the load at a speed of its
own. The drive train rings after the impact. Each shock differs from the one before, so that no
function of the recorded channels explains them: they show in the size of the error, not in its
mean.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.result import Fit
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Times after a change of the sign within which shocks are looked for, s.
TIMES = (0.02, 0.04, 0.08, 0.16, 0.32)
#: Least ratio of the RMS error within such a time and that elsewhere.
RATIO = 3.0
#: The same of a single one.
OTHER = 2.0
#: Changes of the sign needed, and the share of them that a shock follows.
FEWEST, OFTEN = 8, 0.3
#: Samples within such a time, as a share of all: with more, there is no elsewhere.
SEVERAL = 0.3
#: Samples elsewhere that are needed, for each sample within such a time.
ELSEWHERE = 0.25
#: The load torque must then reach this share of its standard deviation: less is noise.
REACHES = 0.1
#: A load torque that changes by more of it in one sample jumps: there a delay shows too.
JUMP = 0.2


@dataclass(frozen=True)
class Shocks:
    """What shocks are of the error.

    Attributes
    ----------
    share
        Share of the squared held-out error that is above that elsewhere. 0 where no shocks show.
    seconds
        The time after a change of the sign within which it is.
    ratio
        RMS error within that time, divided by that elsewhere.
    """

    share: float = 0.0
    seconds: float = 0.0
    ratio: float = 1.0


def shocks(fit: Fit) -> Shocks:
    """The shocks in the held-out error of `fit`, excluded transients included."""
    r = fit.recording
    load = fit.load_torque
    if load is None or r.averaged:
        return Shocks()
    crossings = _crossings(r, load)
    if crossings.size < FEWEST:
        return Shocks()
    square = fit.held_out_residual**2
    since, event = _since(r, crossings)
    since_reversal, _ = _since(r, _reversals(r))
    found = [_within(r, square, since, event, since_reversal, limit) for limit in TIMES]
    return max(found, key=lambda each: each.share)


def _within(
    r: Recording,
    square: Array,
    since: Array,
    event: NDArray[np.intp],
    since_reversal: Array,
    limit: float,
) -> Shocks:
    """The same within a `limit` after each change of the sign.

    Apart from reversals of the motion, after which errors have many causes.
    """
    scored = r.moving & (since_reversal > limit)
    near = scored & (since <= limit)
    if not near.any() or near.sum() > SEVERAL * scored.sum():
        return Shocks()
    far = scored & (since > TIMES[-1])
    if r.acceleration is not None:
        # Many errors grow with the acceleration: elsewhere it must be as large.
        a = np.abs(r.acceleration)
        far &= a >= np.median(a[near])
    if far.sum() < ELSEWHERE * near.sum():
        return Shocks()
    usual = float(square[far].mean())
    ratio = float(square[near].mean()) / usual if usual > 0.0 else 0.0
    count = np.bincount(event[near])
    each = np.bincount(event[near], square[near])[count > 0] / count[count > 0]
    often = float(np.mean(each > OTHER**2 * usual))
    if ratio < RATIO**2 or each.size < FEWEST or often < OFTEN:
        return Shocks()
    share = float((square[near] - usual).sum() / square[r.moving].sum())
    return Shocks(share, limit, float(np.sqrt(ratio)))


def _crossings(r: Recording, load: Array) -> NDArray[np.intp]:
    """First samples of another sign of the load torque, which then is more than noise."""
    same = r.segment[1:] == r.segment[:-1]
    changed = np.flatnonzero(same & (np.sign(load[1:]) != np.sign(load[:-1]))) + 1
    if changed.size == 0:
        return changed
    size = float(np.std(load))
    reached = np.maximum.reduceat(np.abs(load), changed) > REACHES * size
    return changed[reached & (np.abs(load[changed] - load[changed - 1]) < JUMP * size)]


def _reversals(r: Recording) -> NDArray[np.intp]:
    """First samples of another direction of motion, or of motion after rest."""
    sign = np.where(r.moving, np.sign(r.velocity), 0.0)
    return np.flatnonzero(sign[1:] != sign[:-1]) + 1


def _since(r: Recording, starts: NDArray[np.intp]) -> tuple[Array, NDArray[np.intp]]:
    """Time since the last of some samples, [n] in s, and which of them; infinite before all."""
    index = np.arange(r.time.size)
    event = np.searchsorted(starts, index, side="right") - 1
    last = starts[np.maximum(event, 0)] if starts.size else np.zeros_like(index)
    known = (event >= 0) & (r.segment[last] == r.segment)
    return np.where(known, r.elapsed - r.elapsed[last], np.inf), np.maximum(event, 0)
