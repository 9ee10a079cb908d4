"""A planar arm of two joints in motion (Indri et al., eq 4), friction in both."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import numpy as np
import polars as pl
from numpy.typing import ArrayLike, NDArray

from stribeck import _core
from stribeck.base.errors import SpecError
from stribeck.models.model import Model
from stribeck.motion.simulate.acting import friction_of
from stribeck.motion.simulate.drive import Follow, Torque
from stribeck.motion.simulate.run import check_positive, column, steps_of

if TYPE_CHECKING:
    from stribeck.fitting.methods.arm import ArmFit

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PlanarArm:
    """The inertial parameters of eq 12; the second angle is relative to the first link.

    Attributes
    ----------
    inertia_1
        ``Gamma_1z + m2 l1^2``, kg m2.
    moment_2x, moment_2y
        First moments of the second link along and across it, kg m.
    inertia_2
        ``Gamma_2z``, kg m2.
    first_link_length
        ``l1``, m.
    """

    inertia_1: float
    moment_2x: float
    moment_2y: float
    inertia_2: float
    first_link_length: float

    def __post_init__(self) -> None:
        if not all(math.isfinite(x) for x in asdict(self).values()):
            raise SpecError("the arm's parameters must be numbers")
        coupling = self.first_link_length * math.hypot(self.moment_2x, self.moment_2y)
        if not (self.inertia_2 > 0.0 and self.inertia_1 * self.inertia_2 > coupling**2):
            raise SpecError(
                f"the arm's inertia would not be positive in every posture: inertia_1 times "
                f"inertia_2 is {self.inertia_1 * self.inertia_2:g}, and must exceed "
                f"(l1 moment_2)^2, {coupling**2:g}"
            )

    @classmethod
    def identified(cls, fit: ArmFit) -> PlanarArm:
        """The arm of `stribeck arm`."""
        first, along, across, second = (float(x) for x in fit.values[:4])
        return cls(first, along, across, second, fit.first_link_length)


@dataclass(frozen=True)
class ArmMotion:
    """A motion of the arm: postures between steps, means over steps; a column a joint.

    Attributes
    ----------
    instant_position, instant_velocity
        rad, rad/s, arrays [steps + 1, 2].
    torque, load_torque, friction_torque
        N m; the first is the sum of the others. Arrays [steps, 2].
    motor_work, friction_work
        J, arrays [steps, 2].
    """

    arm: PlanarArm
    step: float
    instant_position: Array
    instant_velocity: Array
    torque: Array
    load_torque: Array
    friction_torque: Array
    motor_work: Array
    friction_work: Array

    def to_frame(self) -> pl.DataFrame:
        """Both joints as recordings, a row a step and joint: all columns at the step's middle."""
        time = self.step * (np.arange(self.torque.shape[0], dtype=np.float64) + 0.5)
        joints = [
            pl.DataFrame(
                {
                    "joint": [str(joint + 1)] * time.size,
                    "time": time,
                    "position": 0.5 * (places[1:] + places[:-1]),
                    "velocity": np.diff(places) / self.step,
                    "acceleration": np.diff(self.instant_velocity[:, joint]) / self.step,
                    "torque": self.torque[:, joint],
                    "load_torque": self.load_torque[:, joint],
                }
            )
            for joint, places in enumerate(self.instant_position.T)
        ]
        return pl.concat(joints)


def simulate_arm(
    friction: Sequence[Model],
    arm: PlanarArm,
    drives: Sequence[Torque | Follow],
    *,
    seconds: float | None = None,
    step: float = 1e-3,
    position: Sequence[float] | None = None,
    velocity: Sequence[float] = (0.0, 0.0),
    temperature: ArrayLike = 25.0,
) -> ArmMotion:
    """Move a planar arm with friction in both joints.

    Parameters
    ----------
    friction : two Models
        With values for all parameters.
    arm : PlanarArm
    drives : two of Torque or Follow
        Of each joint; controllers know nothing of each other.
    seconds : float, optional
        Default: as long as the longer trajectory.
    step : float
        s.
    position, velocity : two floats, optional
        At the start, rad and rad/s; default: where trajectories begin.
    temperature : float or array [steps]
        degC.

    Raises
    ------
    SpecError
        Something is missing, or cannot be.

    Notes
    -----
    As `simulate`, with both equations of friction solved within each other.
    """
    if len(friction) != 2 or len(drives) != 2:
        raise SpecError("a planar arm has two joints: give two models and two drives")
    check_positive("step", step)
    count = max(steps_of(drive, seconds, step) for drive in drives)
    models = [friction_of(model)[0] for model in friction]
    begun = step * np.arange(count, dtype=np.float64)
    acting = {
        "torque": np.zeros((count, 2)),
        "temperature": np.column_stack([column("temperature", temperature, count)] * 2),
        "desired_position": np.zeros((count, 2)),
        "desired_velocity": np.zeros((count, 2)),
    }
    for joint, drive in enumerate(drives):
        if isinstance(drive, Torque):
            acting["torque"][:, joint] = column("torque", drive.torque, count)
            continue
        if drive.feedforward:
            raise SpecError("feedforward knows one inertia, not an arm's: leave it out")
        at, speed, _ = drive.trajectory(begun)
        acting["desired_position"][:, joint], acting["desired_velocity"][:, joint] = at, speed
    place = acting["desired_position"][0] if position is None else np.asarray(position)
    try:
        answer = _core.simulate_arm(
            (models[0].core, models[1].core),
            (models[0].values, models[1].values),
            _sizes(arm),
            acting,
            step,
            (place.tolist(), list(velocity)),
            (_gains(drives[0]), _gains(drives[1])),
        )
    except _core.ModelError as error:
        raise SpecError(f"the arm cannot be simulated: {error}") from None
    return ArmMotion(
        arm=arm,
        step=step,
        instant_position=answer["position"],
        instant_velocity=answer["velocity"],
        torque=answer["torque"],
        load_torque=answer["load_torque"],
        friction_torque=answer["friction_torque"],
        motor_work=answer["motor_work"],
        friction_work=answer["friction_work"],
    )


def _sizes(arm: PlanarArm) -> dict[str, float]:
    length = arm.first_link_length
    return {
        "inertia_1": arm.inertia_1,
        "inertia_2": arm.inertia_2,
        "moment_x": length * arm.moment_2x,
        "moment_y": length * arm.moment_2y,
    }


def _gains(drive: Torque | Follow) -> dict[str, float] | None:
    return asdict(drive.controller) if isinstance(drive, Follow) else None
