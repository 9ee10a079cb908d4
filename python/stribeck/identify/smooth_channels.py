"""The channels that a delay shifts: without noise, which a shift would average."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.recording.motion.moves import directions
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Least speed, as a share of the top speed: at rest only the direction matters.
STANDSTILL = 1e-9


def smooth_channels(recording: Recording, load: Array | None) -> dict[str, Array]:
    """The zero-phase smoothed channels of a recording, by name, arrays [n].

    The velocity keeps the direction of motion. At rest, which a delay moves among moving samples,
    friction acts against the motion that begins or has ended.

    Parameters
    ----------
    load : array [n] or None
        The load torque, where the recording gives none.
    """
    r = recording
    speed = np.abs(r.denoised("velocity"))
    smooth = {
        "velocity": directions(r) * np.maximum(speed, STANDSTILL * np.max(speed)),
        "acceleration": r.denoised("acceleration"),
    }
    if r.position is not None and r.position_smooth is not None:
        smooth["position"] = r.denoised("position")
    if r.load_torque is not None and r.load_torque_smooth is not None:
        smooth["load_torque"] = r.denoised("load_torque")
    elif load is not None:
        smooth["load_torque"] = load
    return smooth
