"""Drive gains, from a payload that is known.

The torque of a motor is its current times its drive gain. With a wrong gain all torques of the
joint are wrong by one factor, which inertial parameters and friction absorb. They cannot absorb
the torque of a payload of known mass: its measured size over its known size is the factor (Gautier
and Briot, J. Dynamic Systems, Measurement, and Control 136(5), 2014).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit

from stribeck.base import linear
from stribeck.base.errors import FitError
from stribeck.identify.errors.covariance import covariance_of, seen
from stribeck.identify.errors.estimates import APART
from stribeck.robot.solve import Solved

Array = NDArray[np.float64]

#: Largest standard error of the payload's torque, as a share of it, with which a gain is stated.
LARGEST_ERROR = 0.2


@dataclass(frozen=True)
class KnownPayload:
    """A payload whose mass is known.

    Attributes
    ----------
    mass
        kg.
    centre
        Centre of mass in the frame of the last link, m. The payload counts as a point mass there.

    Examples
    --------
    >>> KnownPayload(2.0, (0.0, 0.0, 0.1)).parameters[:4]
    array([2. , 0. , 0. , 0.2])
    """

    mass: float
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not (np.isfinite(self.mass) and self.mass > 0.0):
            raise FitError(f"a known payload of {self.mass} kg: its mass must be above zero")
        if len(self.centre) != 3 or not np.all(np.isfinite(self.centre)):
            raise FitError("the centre of mass of a payload is three numbers, in m")

    @property
    def parameters(self) -> Array:
        """Inertial parameters, array [10] in the order of `stribeck.robot.arm.PARAMETERS`."""
        x, y, z = self.centre
        inertia = [y * y + z * z, -x * y, x * x + z * z, -x * z, -y * z, x * x + y * y]
        return self.mass * np.array([1.0, x, y, z, *inertia])


@dataclass(frozen=True)
class DriveGain:
    """The gain of one drive, relative to that with which its torque was computed.

    Attributes
    ----------
    ratio
        Gain over the one that was used; None where its torque does not show on this joint.
    ci95
        95 % interval of `ratio`.
    gain
        Torque per current; None where the recording holds torques.
    unit
        Of `gain`.

    Examples
    --------
    >>> import numpy as np
    >>> from stribeck import concat, read, robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> link, known = robot.KnownPayload(3.0, (0.2, 0, 0)), robot.KnownPayload(2.0, (0.4, 0, 0))
    >>> runs = []
    >>> for own in (link.parameters, link.parameters + known.parameters):
    ...     carrying = arm.with_bodies(np.array([[*own, 0.0]]))
    ...     run = robot.simulate_robot(carrying, {}, seconds=10.0, rate=100.0)
    ...     runs.append(read(run.with_columns(run["torque_1"] / 1.1)))  # by a gain that is wrong
    >>> motion = robot.RobotMotion.of(arm, [concat(runs, names=["empty", "loaded"])])
    >>> found = robot.fit_robot(motion, payload=["loaded"], known_payload=known)
    >>> [round(gain.ratio, 3) for gain in found.drive_gains]
    [1.1]
    """

    joint: str
    ratio: float | None
    ci95: tuple[float, float] | None
    gain: float | None
    unit: str

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {**vars(self), "ci95": None if self.ci95 is None else list(self.ci95)}


def drive_gains(solved: Solved, payload: KnownPayload) -> tuple[DriveGain, ...]:
    """The gain of each drive, from the size of the payload's torque on its joint.

    Each joint has inertial parameters and friction of its own here, so that the gain of another
    drive does not matter.

    Parameters
    ----------
    solved : Solved
        With a payload in some runs, identified.
    payload : KnownPayload
        What it was.
    """
    first = solved.balance.base.count
    place = np.arange(first, first + 10)
    low, high = solved.balance.bounds()
    held = low == high
    gains = []
    for joint, factors, own in zip(
        solved.balance.motion.robot.joints, solved.factors, solved.places(), strict=True
    ):
        cells, rows, columns = factors.whole.shape
        stacked = factors.whole.reshape(cells * rows, columns)
        jacobian, residual = stacked[:, :-1], stacked[:, -1]
        among = jacobian[:, place]
        right = residual + among @ solved.values.base[place]
        matrix = np.column_stack([among @ payload.parameters, np.delete(jacobian, place, axis=1)])
        free = np.concatenate([[True], ~np.delete(held[own], place)])
        cell = np.repeat(np.arange(cells), rows).astype(np.uint32)
        size, error, quantile = _size(matrix, right, cell, free)
        unit = f"{joint.torque_unit}/A"
        if error is None or not 0.0 < error < LARGEST_ERROR * size:
            gains.append(DriveGain(joint.name, None, None, None, unit))
            continue
        reach = quantile * error
        used = joint.drive_gain
        gains.append(
            DriveGain(
                joint.name,
                1.0 / size,
                (1.0 / (size + reach), 1.0 / (size - reach)),
                None if used is None else used / size,
                unit,
            )
        )
    return tuple(gains)


def _size(
    matrix: Array, right: Array, cell: NDArray[np.uint32], free: NDArray[np.bool_]
) -> tuple[float, float | None, float]:
    """The factor of the first column, its standard error, and the quantile of its interval.

    The error is None where the other columns can stand in for it.
    """
    values = np.zeros(matrix.shape[1])
    values[free] = linear.least_norm(np.ascontiguousarray(matrix[:, free]), right)
    covariance, freedom = covariance_of(matrix, right - matrix @ values, cell, free, APART)
    known = bool(seen(matrix, free, APART)[0])
    error = float(np.sqrt(max(covariance[0, 0], 0.0))) if known else None
    return float(values[0]), error, float(stdtrit(freedom, 0.975))
