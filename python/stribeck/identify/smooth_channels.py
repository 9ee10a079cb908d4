"""The channels that a delay shifts: without noise, which a shift would average."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.recording.moves import directions
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Least speed, as a share of the top speed: at rest only the direction matters.
STANDSTILL = 1e-9


def smooth_channels(recording: Recording, load: Array | None) -> dict[str, Array]:
    """The zero-phase smoothed channels of a recording, by name, arrays [n].

    The direction of motion is certain, and smoothing must not reverse it. At rest, where noise
    decides the sign of the velocity, friction acts against the motion that begins or has ended: a
    delay moves samples at rest among moving ones. A reversal is where the velocity shows it.

    Parameters
    ----------
    load : array [n] or None
        The load torque, where the recording gives none.
    """
    r = recording
    velocity = r.denoised("velocity")
    speed, sign = np.abs(velocity), np.where(r.moving, directions(r), np.sign(velocity))
    smooth = {
        "velocity": np.where(_is_sure(r, sign), sign, directions(r))
        * np.maximum(speed, STANDSTILL * np.max(speed)),
        "acceleration": r.denoised("acceleration"),
    }
    if r.position is not None and r.position_smooth is not None:
        smooth["position"] = r.denoised("position")
    if r.load_torque is not None and r.load_torque_smooth is not None:
        smooth["load_torque"] = r.denoised("load_torque")
    elif load is not None:
        smooth["load_torque"] = load
    return smooth


def _is_sure(r: Recording, sign: Array) -> NDArray[np.bool_]:
    """Whether the sign of the velocity changes at most once between two moving samples, [n]."""
    at = np.flatnonzero(r.moving)
    if at.size < 2:
        return r.moving
    changes = np.cumsum(np.diff(sign, prepend=sign[:1]) != 0.0)
    once = changes[at[1:]] - changes[at[:-1]] <= 1
    after = np.clip(np.searchsorted(at, np.arange(sign.size)), 1, at.size - 1)
    return r.moving | once[after - 1]
