"""A recorded load torque of another acceleration than that of the recorded motion.

A load torque is often computed from the reference of a controller, or from an acceleration behind a
filter. The motor needs the torque of the motion that took place. What is added to a model then
imitates the difference: a drive train that twists, a frictional lag, another inertia. Where the
torque follows the motion, the motion gives the load torque.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stribeck.base import linear
from stribeck.base.errors import option
from stribeck.recording.arrays import Bools, Floats, Ints
from stribeck.recording.derive import Smoother, motion_band

__all__ = ["Differing", "differing", "note", "slow_motion", "torque_follows"]

#: Motion that any controller follows, in bands of the motion.
_SLOW = 2.0
#: Least share of the variance of the acceleration that the load torque explains: it holds inertia.
_INERTIAL = 0.5
#: The torque lacks the difference: what is left without it exceeds the least that is left with any
#: factor by at most this share of what that explains.
_LACKING = 0.25
#: Least fall of the sum of squares, parts of the recording, and how many of them must agree.
_FALL, _PARTS, _AGREEING = 0.01, 10, 6


@dataclass(frozen=True)
class Differing:
    """How a load torque differs from that of the motion.

    Attributes
    ----------
    inertia : float
        The inertia in the load torque, kg m2 or kg.
    torque : array [n]
        Load torque minus that of the motion, without what gravity explains of it.
    """

    inertia: float
    torque: Floats


def differing(
    load: Floats,
    acceleration: Floats,
    position: Floats | None,
    moving: Bools,
    slow: Callable[[Floats], Floats],
) -> Differing | None:
    """How a load torque differs from that of the motion; None where it holds no inertia.

    Parameters
    ----------
    load, acceleration : array [n]
        Smoothed alike, so that they differ by no more than what was smoothed away.
    position : array [n]
        Of a revolute joint; None otherwise.
    slow
        Smooths both further, to motion so slow that any controller follows its reference.
    """
    gravity = _gravity(load, position)
    inertia = _inertia(slow(load), slow(acceleration), gravity, moving)
    if inertia is None:
        return None
    rest = load - inertia * acceleration
    return Differing(inertia, rest - gravity @ linear.least_norm(gravity[moving], rest[moving]))


def slow_motion(time: Floats, velocity: Floats, segment: Ints) -> Smoother:
    """A low-pass that leaves motion which any controller follows; none where it is too short."""
    band = motion_band(time, velocity, segment)
    return Smoother(time, segment, None if band is None else _SLOW * band)


def _inertia(load: Floats, acceleration: Floats, gravity: Floats, moving: Bools) -> float | None:
    """The inertia in a load torque, by regression of the acceleration on it; None without one.

    The load torque has no noise of the motion, so noise does not lower the factor.
    """
    known = np.column_stack([load, gravity])[moving]
    if known.shape[0] <= known.shape[1]:
        return None
    factors = linear.least_norm(known, acceleration[moving])
    beyond = _beyond(gravity[moving], acceleration[moving])
    left = acceleration[moving] - known @ factors
    if not factors[0] > 0.0 or left @ left > (1.0 - _INERTIAL) * (beyond @ beyond):
        return None
    return 1.0 / float(factors[0])


def torque_follows(
    found: Differing,
    torque: Floats,
    load: Floats,
    velocity: Floats,
    position: Floats | None,
    moving: Bools,
) -> bool:
    """Whether the torque lacks the difference: it follows the motion, and not the load torque.

    By least squares of Coulomb and viscous friction and gravity, and in most of the recording.
    """
    base = np.column_stack([np.sign(velocity), velocity, _gravity(load, position)])[moving]
    given = _beyond(base, (torque - load)[moving])
    other = _beyond(base, found.torque[moving])
    size = float(other @ other)
    if not size > 0.0:
        return False
    mended = given + other
    recorded, without = float(given @ given), float(mended @ mended)
    least = recorded - float(other @ given) ** 2 / size
    lacks = without - least <= _LACKING * (recorded - least)
    parts = zip(np.array_split(given, _PARTS), np.array_split(mended, _PARTS), strict=True)
    agreeing = sum(float(after @ after) < float(before @ before) for before, after in parts)
    return lacks and without < (1.0 - _FALL) * recorded and agreeing >= _AGREEING


def note(inertia: float, unit: str) -> str:
    """What a reader has to know of a load torque that is not used as recorded."""
    return (
        f"the recorded load torque is that of another acceleration than the motion's, as of a "
        f"reference or behind a filter, and the torque follows the motion: its inertia, "
        f"{inertia:.3g} {unit}, is taken with the acceleration of the motion; to use it as "
        f"recorded, give {option('trust')}"
    )


def _gravity(load: Floats, position: Floats | None) -> Floats:
    """Columns of gravity and of a constant, [n, 1 or 3]."""
    one = np.ones_like(load)
    if position is None:
        return one[:, None]
    return np.column_stack([one, np.cos(position), np.sin(position)])


def _beyond(columns: Floats, values: Floats) -> Floats:
    """`values` [m] without what the `columns` [m, k] explain of them."""
    return np.asarray(values - columns @ linear.least_norm(columns, values))
