"""What columns of a motion leave of the torque, at several shifts of it."""

from __future__ import annotations

import numpy as np

from stribeck.base import linear
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.joint.channels import Channels
from stribeck.recording.rows import neighbour

__all__ = ["REACH", "left_of", "shifted", "torque_of"]

#: Largest shift of the torque in samples, as of the effect `delay`.
REACH = 6
#: Channels that a torque may be read from.
_TORQUES = ("friction_torque", "torque", "current")


def torque_of(data: Channels) -> Floats | None:
    """The channel that the torque is read from, in its own unit; None where there is none."""
    return next((data.values[name] for name in _TORQUES if name in data.values), None)


def shifted(torque: Floats, segment: Ints, rows: Ints) -> Floats:
    """The torque of the samples `rows` at each shift from -REACH to REACH, array [shifts, m]."""
    shifts = range(-REACH, REACH + 1)
    return np.array([neighbour(torque, segment, shift)[rows] for shift in shifts])


def left_of(targets: Floats, columns: list[Floats], rows: Ints) -> Floats:
    """Sums of squares that the columns [n] leave of each target by least squares, array [shifts].

    Parameters
    ----------
    targets
        See `shifted`.
    """
    return linear.squares_left(np.column_stack([column[rows] for column in columns]), targets.T)
