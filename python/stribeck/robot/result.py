"""What is identified of a robot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import polars as pl

from stribeck.base.shown import Shown
from stribeck.identify.errors.estimates import Estimate
from stribeck.models.model import Model
from stribeck.robot.consistent import Bodies

if TYPE_CHECKING:
    from stribeck.robot.drive_gains import DriveGain
    from stribeck.robot.solve import Solved


@dataclass(frozen=True)
class JointFit:
    """The friction of one joint, identified with the rigid bodies.

    Attributes
    ----------
    rmse, rmse_held_out
        Of the torque as recorded, over scored samples, in `unit`.
    relative_residual, relative_residual_held_out
        Norm of the residual over norm of the torque, both after the low-pass.
    """

    joint: str
    model: Model
    estimates: Mapping[str, Estimate]
    rmse: float
    rmse_held_out: float
    relative_residual: float
    relative_residual_held_out: float

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "joint": self.joint,
            "model": self.model.spec,
            "parameters": {name: e.to_dict() for name, e in self.estimates.items()},
            "rmse": self.rmse,
            "rmse_held_out": self.rmse_held_out,
            "relative_residual": self.relative_residual_held_out,
            "relative_residual_of_fit": self.relative_residual,
            "unit": self.model.torque_unit,
        }


@dataclass(frozen=True)
class BaseEstimate:
    """A base parameter with its standard error and 95 % interval."""

    combination: str
    value: float
    stderr: float
    ci95: tuple[float, float]
    unit: str

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {**vars(self), "ci95": list(self.ci95)}


@dataclass(frozen=True)
class Payload:
    """A payload on the last link: mass and centre of mass, with 95 % intervals.

    Attributes
    ----------
    mass, mass_ci95
        kg; conditional on the drive gains, with which it scales.
    centre
        In the frame of the last link, m; None where the mass is not above zero.
    """

    runs: tuple[str, ...]
    mass: float
    mass_stderr: float
    mass_ci95: tuple[float, float]
    centre: tuple[float, float, float] | None

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "runs": list(self.runs),
            "mass": self.mass,
            "stderr": self.mass_stderr,
            "ci95": list(self.mass_ci95),
            "unit": "kg",
            "centre_of_mass": None if self.centre is None else list(self.centre),
            "conditional_on": "drive gains",
        }


@dataclass(frozen=True)
class Evaluated:
    """Errors on a motion that nothing was fitted to, by joint.

    Attributes
    ----------
    relative_residual, ordinary
        Norm of the residual over norm of the torque, both after the low-pass: of the model, and of
        the ordinary one (Coulomb and viscous friction and a constant on each joint).
    """

    path: str
    rmse: tuple[float, ...]
    relative_residual: tuple[float, ...]
    ordinary: tuple[float, ...]

    @property
    def ratio(self) -> tuple[float, ...]:
        """Error over that of the ordinary model."""
        pairs = zip(self.relative_residual, self.ordinary, strict=True)
        return tuple(mine / other for mine, other in pairs)

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "file": self.path,
            "rmse": list(self.rmse),
            "relative_residual": list(self.relative_residual),
            "relative_residual_ordinary": list(self.ordinary),
            "ratio": list(self.ratio),
        }


@dataclass(frozen=True, repr=False)
class RobotFit(Shown):
    """Rigid bodies and friction of a robot, identified together.

    Attributes
    ----------
    joints, ordinary
        The joints with the laws asked for, and with the ordinary one on each.
    base_parameters
        Combinations of inertial parameters on which the torques depend.
    bodies
        Inertial parameters of every link that a body with positive mass density has.
    payload
        Of the runs that carry one.
    evaluated
        Errors on motions that nothing was fitted to.
    drive_gains
        Of each joint, where the payload is known.

    Examples
    --------
    >>> import numpy as np
    >>> from stribeck import model, read, robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, 0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]]))
    >>> friction = {"1": model("coulomb", coulomb_friction=2.0, viscous_friction=1.0)}
    >>> run = robot.simulate_robot(arm, friction, seconds=20.0, rate=100.0, noise=0.01)
    >>> found = robot.fit_robot(robot.RobotMotion.of(arm, [read(run)]), "coulomb")
    >>> found.joints[0].model.values.round(1)
    array([1., 2.])
    >>> [one.combination for one in found.base_parameters]
    ['mx_1', 'my_1', 'Izz_1 + Ir_1']
    """

    solved: Solved
    joints: tuple[JointFit, ...]
    ordinary: tuple[JointFit, ...]
    base_parameters: tuple[BaseEstimate, ...]
    bodies: Bodies
    payload: Payload | None
    evaluated: tuple[Evaluated, ...]
    seconds: float
    drive_gains: tuple[DriveGain, ...] = ()

    @property
    def consistent(self) -> bool:
        """Whether links with positive mass density have these base parameters."""
        return self.bodies.consistent

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck robot fit`."""
        balance = self.solved.balance
        return {
            "robot": balance.base.robot.name,
            "joints": [joint.to_dict() for joint in self.joints],
            "ordinary": [
                {"joint": joint.joint, "relative_residual": joint.relative_residual_held_out}
                for joint in self.ordinary
            ],
            "base_parameters": [row.to_dict() for row in self.base_parameters],
            "not_identifiable": list(balance.base.not_shown),
            "consistent": self.consistent,
            "links": self.bodies.to_dict(),
            "payload": None if self.payload is None else self.payload.to_dict(),
            "drive_gains": [row.to_dict() for row in self.drive_gains],
            "cutoff_hz": balance.motion.cutoff,
            "held_out": balance.held_out,
            "converged": self.solved.converged,
            "evaluated": [row.to_dict() for row in self.evaluated],
            "seconds": self.seconds,
        }

    def to_frame(self) -> pl.DataFrame:
        """One row per joint."""
        rows = [
            {
                "joint": mine.joint,
                "model": mine.model.spec,
                "rmse": mine.rmse,
                "rmse_held_out": mine.rmse_held_out,
                "relative_residual": mine.relative_residual_held_out,
                "ordinary": other.relative_residual_held_out,
            }
            for mine, other in zip(self.joints, self.ordinary, strict=True)
        ]
        return pl.DataFrame(rows)
