"""A joint in closed loop with friction compensation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stribeck import _core
from stribeck.base.errors import SpecError
from stribeck.fitting.result import Fit
from stribeck.models.channels import finite
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.motion.simulate.acting import Acting, friction_of, take_apart
from stribeck.motion.simulate.drive import Controller
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.run import MOST_STEPS, check_positive, column
from stribeck.motion.simulate.temperature import joint_temperature
from stribeck.motion.simulate.trajectory import Trajectory

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Compensator:
    """Friction compensation: ``alpha`` times the torque of a model.

    Attributes
    ----------
    model
        Model with values. Its inputs are the temperature of the joint and, as load, gravity and
        inertia of the desired motion; its internal state is separate from that of the joint.
    factor
        ``alpha``, 0 to 1.
    feedback
        Evaluate the model at the measured velocity; else at the desired one (feedforward).
    name
        Label in tables and figures; default: the spec of the model.

    Examples
    --------
    >>> import stribeck as sb
    >>> friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> sb.Compensator(friction, factor=0.8).label
    'coulomb'
    """

    model: Model
    factor: float = 1.0
    feedback: bool = True
    name: str = ""

    def __post_init__(self) -> None:
        if not 0.0 <= self.factor <= 1.0:
            raise SpecError(
                f"the compensation factor is {self.factor:g}: give 0 to 1; above 1 "
                f"compensation exceeds friction"
            )

    @property
    def label(self) -> str:
        """Name, or the spec of the model."""
        return self.name or self.model.spec


@dataclass(frozen=True)
class ClosedLoopMotion:
    """A motion in closed loop; instants are the ends of the steps.

    Attributes
    ----------
    compensator
        None: without compensation.
    position, velocity
        At the instants ``k step``, arrays [steps + 1].
    error
        Desired minus actual position at the start of each step, rad or m, array [steps].
    torque, controller_torque, compensation, observed
        Of the motor, of the PID (or the hand), of the compensator and of the observer, held over
        each step, N m or N, arrays [steps].
    load_torque, friction_torque
        Means over each step, N m or N, arrays [steps].
    """

    compensator: Compensator | None
    position: Array
    velocity: Array
    error: Array
    torque: Array
    controller_torque: Array
    compensation: Array
    observed: Array
    load_torque: Array
    friction_torque: Array

    @property
    def name(self) -> str:
        """Name of the compensation, or "without"."""
        return "without" if self.compensator is None else self.compensator.label

    @property
    def rmse(self) -> float:
        """RMS of the tracking error, rad or m."""
        return float(np.sqrt(np.mean(self.error**2)))

    @property
    def largest_error(self) -> float:
        """Largest tracking error, rad or m."""
        return float(np.abs(self.error).max())


@dataclass(frozen=True)
class Bench:
    """A joint with its true friction, an encoder and a desired motion."""

    acting: Acting
    step: float
    encoder: float
    desired: tuple[Array, Array, Array]
    temperature: Array

    @classmethod
    def of(
        cls,
        friction: Model | ModelFile | Fit,
        joint: Joint | None,
        trajectory: Trajectory,
        seconds: float | None,
        step: float,
        temperature: ArrayLike | None,
        encoder: float,
        compensators: Sequence[Compensator],
    ) -> Bench:
        """Check the arguments, and sample the desired motion at each step.

        Raises
        ------
        SpecError
            An argument is missing or invalid.
        """
        asked = friction if isinstance(friction, Model) else friction.model
        acting = take_apart(asked, joint)
        if acting.joint.transmission is not None:
            raise SpecError("compensation needs a joint of one inertia: leave the transmission out")
        check_positive("step", step)
        if not (math.isfinite(encoder) and encoder >= 0.0):
            raise SpecError(f"the resolution of the encoder is {encoder:g}: give 0 or more")
        duration = trajectory.duration if seconds is None else seconds
        check_positive("seconds", duration)
        steps = duration / step
        if not 0.5 < steps <= MOST_STEPS:
            raise SpecError(
                f"{duration:g} s in steps of {step:g} s are {steps:.3g} steps: "
                f"give 1 to {MOST_STEPS}"
            )
        count = round(steps)
        desired = trajectory(step * np.arange(count, dtype=np.float64))
        others = [compensator.model for compensator in compensators]
        warmth = joint_temperature(acting.friction, temperature, others)
        return cls(acting, step, encoder, desired, column("temperature", warmth, count))

    def run(
        self,
        controller: Controller,
        compensator: Compensator | None,
        *,
        bandwidth: float | None = None,
        guided: bool = False,
    ) -> ClosedLoopMotion:
        """Simulate one motion.

        Parameters
        ----------
        controller : Controller
            Feedback controller, added to inertia and gravity; if `guided`, the hand that pulls.
        compensator : Compensator, optional
        bandwidth : float, optional
            Bandwidth of an observer of the remaining friction, 1/s.
        """
        position, velocity, acceleration = self.desired
        friction = self.acting.friction
        given = {
            "position": position,
            "velocity": velocity,
            "acceleration": acceleration,
            "temperature": self.temperature,
        }
        try:
            answer = _core.compensate(
                friction.core,
                friction.values,
                _sizes(self.acting.joint),
                given,
                self.step,
                _gains(controller),
                None if compensator is None else self._cancels(compensator),
                bandwidth,
                guided,
                self.encoder,
            )
        except _core.ModelError as error:
            raise SpecError(f"{friction.spec} cannot be simulated: {error}") from None
        for name in ("position", "velocity", "torque", "friction_torque"):
            finite(answer[name], f"the simulated {name.replace('_', ' ')} of {friction.spec}")
        return ClosedLoopMotion(
            compensator=compensator,
            position=answer["position"],
            velocity=answer["velocity"],
            error=position - answer["position"][:-1],
            torque=answer["torque"],
            controller_torque=answer["controller_torque"],
            compensation=answer["compensation"],
            observed=answer["observed"],
            load_torque=answer["load_torque"],
            friction_torque=answer["friction_torque"],
        )

    def _cancels(self, compensator: Compensator) -> dict[str, object]:
        model, _ = friction_of(compensator.model)
        if model.torque_unit != self.acting.friction.torque_unit:
            raise SpecError(
                f"{compensator.label} is in {model.torque_unit} and cannot compensate "
                f"{self.acting.friction.spec}, which is in {self.acting.friction.torque_unit}"
            )
        return {
            "model": model.core,
            "values": model.values,
            "factor": compensator.factor,
            "feedback": compensator.feedback,
        }


def _sizes(joint: Joint) -> dict[str, float]:
    return {
        "inertia": joint.inertia,
        "gravity": joint.gravity,
        "gravity_cos": joint.gravity_cos,
        "gravity_sin": joint.gravity_sin,
        "stiffness": 0.0,
        "damping": 0.0,
    }


def _gains(controller: Controller) -> dict[str, float]:
    return {
        "proportional": controller.proportional,
        "integral": controller.integral,
        "derivative": controller.derivative,
        "velocity_weight": controller.velocity_weight,
        "limit": controller.limit,
    }
