"""A robot in closed loop: every joint follows a motion against its friction, with compensation.

Time-stepping after Moreau (1988): velocities after a step solve the equations of motion with dry
friction at these velocities, for all joints at once. A joint sticks where dry friction can hold
it. The step is that of a convex function, found joint by joint (Gauss-Seidel).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.checks import check_number
from stribeck.base.errors import SpecError
from stribeck.base.shown import Shown
from stribeck.models.model import Model
from stribeck.motion.simulate.acting import friction_of
from stribeck.robot.arm import Robot
from stribeck.robot.simulate import check_friction, fourier_motion

Array = NDArray[np.float64]

#: Most sweeps over the joints in a step, and the change, as a share of the speed, that ends them.
SWEEPS, SETTLED = 200, 1e-12
#: The step in speed by which friction is differentiated, as a share of the largest speed.
SPEED_STEP = 1e-6


@dataclass(frozen=True)
class Followed:
    """One run of a robot in closed loop.

    Attributes
    ----------
    name
        Of the compensation; empty: none.
    position, velocity, torque : arrays [n, N]
        Of the joints, in rad or m, and torque of the drives.
    error : array [N]
        RMS of the desired minus the actual position.
    sticking : array [N]
        Share of the time at which a joint sticks.
    """

    name: str
    position: Array
    velocity: Array
    torque: Array
    error: Array
    sticking: Array


@dataclass(frozen=True, repr=False)
class RobotTracking(Shown):
    """A motion of a robot, followed without and with compensation of friction.

    Attributes
    ----------
    time, desired : arrays [n] and [n, N]
    runs
        Without compensation, then with each of those given.
    """

    robot: Robot
    time: Array
    desired: Array
    runs: tuple[Followed, ...]

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck robot simulate --compensate`."""
        rows = [
            {
                "compensation": run.name or None,
                "joints": [
                    {
                        "joint": name,
                        "rms_error": float(run.error[k]),
                        "share_sticking": float(run.sticking[k]),
                    }
                    for k, name in enumerate(self.robot.names)
                ],
            }
            for run in self.runs
        ]
        return {"robot": self.robot.name, "seconds": float(self.time[-1]), "runs": rows}

    def to_frame(self) -> pl.DataFrame:
        """The last run, one row per sample, with the columns of `simulate_robot`."""
        run, made = self.runs[-1], {"time": self.time}
        for k, name in enumerate(self.robot.names):
            made[f"position_{name}"] = run.position[:, k]
            made[f"velocity_{name}"] = run.velocity[:, k]
            made[f"torque_{name}"] = run.torque[:, k]
        return pl.DataFrame(made)


def follow_robot(
    robot: Robot,
    friction: Mapping[str, Model],
    compensations: Mapping[str, Mapping[str, Model]],
    *,
    seconds: float = 10.0,
    rate: float = 1000.0,
    speed: float = 1.0,
    harmonics: int = 5,
    bandwidth: float = 20.0,
    seed: int = 0,
) -> RobotTracking:
    """Follow a random Fourier motion, without compensation of friction and with each one given.

    The controller of a joint is computed torque at the desired motion plus position and velocity
    errors: a critically damped loop of `bandwidth` around its inertia. Compensation is the friction
    of a model at the desired motion.

    Parameters
    ----------
    friction : mapping of Model
        Friction of each joint, with values. One with a state acts by its steady torque.
    compensations : mapping
        Friction of each joint as the controller knows it, by a name for tables.
    rate
        Steps per second, Hz.
    bandwidth
        rad/s.

    Raises
    ------
    SpecError
        A joint does not exist; inertia is not known; an effect cannot act in motion.
    """
    check_friction(robot, friction)
    for known in compensations.values():
        check_friction(robot, known)
    check_number("seconds", seconds, 0.1, 600.0, " s")
    check_number("rate", rate, 100.0, 10_000.0, " Hz")
    check_number("speed", speed, 1e-6, 1e3)
    if not 0.0 < bandwidth <= 0.2 * rate:
        raise SpecError(
            f"the bandwidth is {bandwidth:g} rad/s: give a number above 0, at most a fifth of the "
            f"rate, {0.2 * rate:g}"
        )
    time = np.arange(int(seconds * rate)) / rate
    random = np.random.default_rng(seed)
    desired = fourier_motion(time, len(robot.joints), speed, harmonics, random)
    arm = _Arm(robot, friction, 1.0 / rate, speed)
    planned = robot.torque(*desired)
    runs = []
    for name, known in {"": {}, **compensations}.items():
        feedforward = planned + _known(robot, known, time, desired, planned)
        runs.append(_run(arm, name, desired, feedforward, bandwidth))
    return RobotTracking(robot, time, desired[0], tuple(runs))


def _known(
    robot: Robot,
    known: Mapping[str, Model],
    time: Array,
    desired: tuple[Array, Array, Array],
    planned: Array,
) -> Array:
    """Friction at the desired motion, array [n, N]."""
    made = np.zeros_like(planned)
    dt = np.diff(time, prepend=time[0])
    position, velocity, acceleration = desired
    for k, joint in enumerate(robot.joints):
        if joint.name in known:
            made[:, k] = friction_of(known[joint.name])[0].torque(
                velocity[:, k],
                position=position[:, k],
                acceleration=acceleration[:, k],
                load_torque=planned[:, k],
                dt=dt,
            )
    return made


def _run(
    arm: _Arm, name: str, desired: tuple[Array, Array, Array], feedforward: Array, bandwidth: float
) -> Followed:
    position, velocity, _ = desired
    inertia = np.mean(np.diagonal(arm.robot.core.mass_matrix(position), axis1=1, axis2=2), axis=0)
    stiff, damped = bandwidth**2 * inertia, 2.0 * bandwidth * inertia
    q, v = position[0], velocity[0]
    acceleration = np.zeros_like(q)
    places, speeds, torques = (np.empty_like(position) for _ in range(3))
    for k in range(len(position)):
        torque = feedforward[k] + stiff * (position[k] - q) + damped * (velocity[k] - v)
        places[k], speeds[k], torques[k] = q, v, torque
        q, v, acceleration = arm.stepped(q, v, acceleration, torque)
    if not np.all(np.isfinite(places)):
        raise SpecError(f"{arm.robot.name}: the controlled motion diverges: give a lower bandwidth")
    error = np.sqrt(np.mean((position - places) ** 2, axis=0))
    return Followed(name, places, speeds, torques, error, np.mean(speeds == 0.0, axis=0))


class _Arm:
    """Rigid bodies and friction of all joints, moved step by step."""

    def __init__(
        self, robot: Robot, friction: Mapping[str, Model], step: float, speed: float
    ) -> None:
        self.robot, self.step = robot, step
        self.models = [
            friction_of(friction[name])[0] if name in friction else None for name in robot.names
        ]
        self.change = SPEED_STEP * speed

    def stepped(
        self, q: Array, v: Array, acceleration: Array, torque: Array
    ) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration [N] after a step."""
        h, core = self.step, self.robot.core
        mass = core.mass_matrix(q[None])[0]
        bias = core.inverse_dynamics(q[None], v[None], np.zeros((1, q.size)))[0]
        load = bias + mass @ acceleration
        dry, other, slope = self._friction(q, v, acceleration, load)
        matrix = mass + h * np.diag(slope)
        right = mass @ v + h * (torque - bias - other + slope * v)
        after = sliding(matrix, right, h * dry, v)
        return q + h * after, after, (after - v) / h

    def _friction(
        self, q: Array, v: Array, acceleration: Array, load: Array
    ) -> tuple[Array, Array, Array]:
        """Of each joint [N]: dry friction, the rest of it, and the slope of the rest."""
        dry, other, slope = np.zeros((3, q.size))
        for k, model in enumerate(self.models):
            if model is None:
                continue
            parts = model.split(
                [v[k], v[k] + self.change],
                position=[q[k]] * 2,
                acceleration=[acceleration[k]] * 2,
                load_torque=[load[k]] * 2,
            )
            rest = parts["rate"] + parts["additive"]
            dry[k], other[k] = max(float(parts["dry"][0]), 0.0), rest[0]
            slope[k] = max(float(rest[1] - rest[0]) / self.change, 0.0)
        return dry, other, slope


def sliding(matrix: Array, right: Array, dry: Array, start: Array) -> Array:
    """Velocities [N] that solve ``matrix v + dry sign(v) = right``, with sign(0) in -1 .. 1.

    Parameters
    ----------
    matrix : array [N, N]
        Symmetric, positive definite.
    dry : array [N]
        Impulse of dry friction, at least 0.
    start : array [N]
        Velocities from which the search starts.

    Examples
    --------
    >>> sliding(np.diag([2.0, 1.0]), np.array([3.0, 0.5]), np.array([1.0, 1.0]), np.zeros(2))
    array([1., 0.])
    """
    v = np.array(start)
    diagonal = np.diag(matrix)
    for _ in range(SWEEPS):
        largest = 0.0
        for k in range(v.size):
            free = right[k] - matrix[k] @ v + diagonal[k] * v[k]
            moved = np.sign(free) * max(abs(free) - dry[k], 0.0) / diagonal[k]
            largest = max(largest, abs(moved - v[k]))
            v[k] = moved
        if largest <= SETTLED * max(float(np.max(np.abs(v))), 1.0):
            break
    return v
