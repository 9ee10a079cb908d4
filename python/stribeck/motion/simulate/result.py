"""A simulated motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.shown import Plotted
from stribeck.models.model import Model
from stribeck.motion.simulate.drive import Drive, Follow
from stribeck.motion.simulate.joint import Joint

Array = NDArray[np.float64]


@dataclass(frozen=True, repr=False)
class Simulation(Plotted):
    """A motion: states between the steps, and means over the steps.

    Attributes
    ----------
    instants
        The times between steps, s, array [steps + 1].
    instant_position, instant_velocity
        States at those times, of the motor if there is a transmission, arrays [steps + 1].
    instant_load_position
        Position of the load at those times; equal to that of the motor without a transmission.
    torque, load_torque, friction_torque
        Means over each step, arrays [steps]; motor torque is the sum of the other two.
    desired_position, desired_velocity
        In a closed loop, at the start of each step, arrays [steps].
    motor_work, environment_work, friction_work
        Work in each step, J, arrays [steps]. Gravity and springs belong to the environment; the
        work of friction is dissipated or stored in bristles.
    temperature
        degC, array [steps].
    left_out
        Effects of the measurement, which are not simulated.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.simulate.drive import Torque
    >>> friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> pushed = sb.simulate(friction, sb.Joint.revolute(0.1), Torque(3.0), seconds=2.0)
    >>> round(float(pushed.velocity[-1]), 2), abs(pushed.energy["imbalance"]) < 1e-9
    (2.0, True)
    >>> sb.read(pushed.to_frame()).rows
    2000
    """

    model: Model
    joint: Joint
    drive: Drive
    instants: Array
    left_out: tuple[str, ...]
    temperature: Array
    desired_position: Array
    desired_velocity: Array
    instant_position: Array
    instant_velocity: Array
    instant_load_position: Array
    torque: Array
    load_torque: Array
    friction_torque: Array
    motor_work: Array
    environment_work: Array
    friction_work: Array

    @property
    def time(self) -> Array:
        """The middles of the steps, s, array [steps]."""
        return 0.5 * (self.instants[1:] + self.instants[:-1])

    @property
    def position(self) -> Array:
        """Mean of both ends of each step, rad or m, array [steps]."""
        return 0.5 * (self.instant_position[1:] + self.instant_position[:-1])

    @property
    def velocity(self) -> Array:
        """Mean over each step, rad/s or m/s, array [steps]."""
        return np.diff(self.instant_position) / np.diff(self.instants)

    @property
    def acceleration(self) -> Array:
        """Mean over each step, rad/s2 or m/s2, array [steps]."""
        return np.diff(self.instant_velocity) / np.diff(self.instants)

    @property
    def position_end(self) -> float:
        """Position at the end, rad or m."""
        return float(self.instant_position[-1])

    @property
    def tracking_error(self) -> Array | None:
        """Desired minus actual position at the start of each step, rad or m; None in open loop."""
        if not isinstance(self.drive, Follow):
            return None
        return self.desired_position - self.instant_position[:-1]

    @property
    def energy(self) -> dict[str, float]:
        """Energies over the motion, J; ``imbalance`` is the rounding error.

        Kinetic energy is that of the motor inertia; a load behind a transmission belongs to the
        environment.
        """
        motor, environment, friction = (
            float(work.sum())
            for work in (self.motor_work, self.environment_work, self.friction_work)
        )
        start, end = self.instant_velocity[0], self.instant_velocity[-1]
        kinetic = float(0.5 * self.joint.motor_inertia * (end**2 - start**2))
        return {
            "motor": motor,
            "environment": environment,
            "friction": friction,
            "kinetic": kinetic,
            "imbalance": motor + environment - friction - kinetic,
        }

    def to_frame(self) -> pl.DataFrame:
        """The motion as a recording with one sample per step, taken at its middle."""
        columns = {
            "time": self.time,
            "position": self.position,
            "velocity": self.velocity,
            "acceleration": self.acceleration,
            "torque": self.torque,
            "load_torque": self.load_torque,
        }
        if self.joint.transmission is not None:
            ends = self.instant_load_position
            columns["load_position"] = 0.5 * (ends[1:] + ends[:-1])
        if "temperature" in self.model.core.needs:
            columns["temperature"] = self.temperature
        return pl.DataFrame(columns)

    def to_dict(self) -> dict[str, Any]:
        """Summary of the motion as JSON."""
        error = self.tracking_error
        return {
            "model": self.model.spec,
            "joint_kind": self.joint.kind,
            "inertia": self.joint.inertia,
            "seconds": float(self.instants[-1]),
            "step": float(self.instants[-1]) / self.torque.size,
            "steps": self.torque.size,
            "left_out": list(self.left_out),
            "position": {
                "start": float(self.instant_position[0]),
                "end": self.position_end,
                "min": float(self.instant_position.min()),
                "max": float(self.instant_position.max()),
            },
            "largest_speed": float(np.abs(self.instant_velocity).max()),
            "share_at_rest": float(np.mean(self.velocity == 0.0)),
            "largest_torque": float(np.abs(self.torque).max()),
            "tracking_error": None
            if error is None
            else {
                "rms": float(np.sqrt(np.mean(error**2))),
                "largest": float(np.abs(error).max()),
            },
            "energy_J": self.energy,
        }
