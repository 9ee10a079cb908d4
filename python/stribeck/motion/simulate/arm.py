"""Simulation of a planar arm of two joints with friction in both (Indri et al., eq 4)."""

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
    """Inertial parameters (eq 12); the second angle is relative to the first link.

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
            raise SpecError("the parameters of the arm must be finite numbers")
        coupling = self.first_link_length * math.hypot(self.moment_2x, self.moment_2y)
        if not (self.inertia_2 > 0.0 and self.inertia_1 * self.inertia_2 > coupling**2):
            raise SpecError(
                f"the inertia of the arm is not positive in every posture: inertia_1 times "
                f"inertia_2 is {self.inertia_1 * self.inertia_2:g}, and must exceed "
                f"(l1 moment_2)^2, {coupling**2:g}"
            )

    @classmethod
    def identified(cls, fit: ArmFit) -> PlanarArm:
        """Return the arm that `stribeck arm` identified."""
        first, along, across, second = (float(x) for x in fit.values[:4])
        return cls(first, along, across, second, fit.first_link_length)


@dataclass(frozen=True)
class ArmMotion:
    """A motion of the arm: states between steps, means over steps; one column for each joint.

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
        """Return recordings of both joints, one sample for each step, at its middle."""
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
    """Simulate the motion of a planar arm, as `simulate` does for one joint.

    Parameters
    ----------
    friction, drives : two Models, two of Torque or Follow
        For each joint: the model with values, and the drive. The controllers are independent.
    arm : PlanarArm
    seconds, step : float
        Duration, s (default: that of the longer trajectory), and time step, s.
    position, velocity : two floats, optional
        Initial state, rad and rad/s; default: that of the trajectories.
    temperature : float or array [steps]
        degC.

    Raises
    ------
    SpecError
        An argument is missing or invalid.
    """
    if len(friction) != 2 or len(drives) != 2:
        raise SpecError("a planar arm has two joints: give two models and two drives")
    check_positive("step", step)
    count = max(steps_of(drive, seconds, step) for drive in drives)
    models = [friction_of(model)[0] for model in friction]
    columns = _columns(drives, step * np.arange(count, dtype=np.float64))
    columns["temperature"] = np.column_stack([column("temperature", temperature, count)] * 2)
    place = columns["desired_position"][0] if position is None else np.asarray(position)
    try:
        answer = _core.simulate_arm(
            (models[0].core, models[1].core),
            (models[0].values, models[1].values),
            _sizes(arm),
            columns,
            step,
            (place.tolist(), list(velocity)),
            (_gains(drives[0]), _gains(drives[1])),
        )
    except _core.ModelError as error:
        raise SpecError(f"the arm cannot be simulated: {error}") from None
    names = ("torque", "load_torque", "friction_torque", "motor_work", "friction_work")
    means = {name: answer[name] for name in names}
    return ArmMotion(arm, step, answer["position"], answer["velocity"], **means)


def _columns(drives: Sequence[Torque | Follow], time: Array) -> dict[str, Array]:
    """Return the inputs of both joints in each step, arrays [steps, 2]."""
    names = ("torque", "desired_position", "desired_velocity")
    columns = {name: np.zeros((time.size, 2)) for name in names}
    for joint, drive in enumerate(drives):
        if isinstance(drive, Torque):
            columns["torque"][:, joint] = column("torque", drive.torque, time.size)
            continue
        if drive.feedforward:
            raise SpecError("feedforward needs a joint of one inertia: leave it out for an arm")
        at, speed, _ = drive.trajectory(time)
        columns["desired_position"][:, joint], columns["desired_velocity"][:, joint] = at, speed
    return columns


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
