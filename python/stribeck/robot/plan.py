"""Motions of a whole robot that show its base parameters and friction well.

Fourier series of all joints from rest to rest (Swevers et al. 1997), by D-optimal design: the
product of the standard errors of all parameters is as small as the search makes it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.checks import check_count, check_number
from stribeck.base.errors import SpecError, listed, nearest
from stribeck.base.shown import Shown
from stribeck.identify.triangle import Triangle
from stribeck.motion.design.fourier import FourierMotions
from stribeck.motion.design.motion import Limits
from stribeck.robot.arm import Robot
from stribeck.robot.base_parameters import BaseParameters
from stribeck.robot.spheres import clearance

Array = NDArray[np.float64]

#: Motions that are tried; random ones among them, from which the search starts.
TRIED, RANDOM = 1500, 20
#: Samples per second during the search: several in a period of the fastest harmonic.
COARSE = 20.0
#: Share of a torque limit, and distance between spheres, m, that the search keeps at its samples: a
#: motion comes closer between them.
TORQUE_SHARE, APART = 0.98, 0.01
#: Random motions that are drawn to find those within the limits, and fewest of them for a median.
DRAWN, FEWEST = 400, 3
#: Spread of a change of the design of one joint, of ranges from 0 to 1.
SPREAD = 0.15


@dataclass(frozen=True, repr=False)
class RobotPlan(Shown):
    """A planned motion of all joints.

    Attributes
    ----------
    time, position, velocity, acceleration : arrays [n] and [n, N]
        In s; rad or m, and their derivatives.
    gain
        By how much the standard errors are smaller than on a random motion within the same limits:
        the median of random motions, geometric mean over all parameters. None: too few random
        motions are within the limits.
    parameters
        Number of base and friction parameters.
    torque : array [N]
        Largest torque of the rigid bodies by joint, N m or N; None: inertia is not known.
    clearance
        Smallest distance between spheres of links, m; infinite without spheres.

    Examples
    --------
    >>> from stribeck import robot
    >>> from stribeck.motion.design.motion import Limits
    >>> arm = robot.from_tables("planar", [{"a": 0.4}, {"a": 0.3}], gravity=(0.0, -9.81, 0.0))
    >>> planned = robot.plan_robot(arm, Limits(-1.0, 1.0, 1.5, 6.0), seconds=10.0, tried=50)
    >>> planned.gain > 1.0, planned.parameters
    (True, 13)
    >>> planned.to_frame().columns[:4]
    ['time', 'position_1', 'velocity_1', 'acceleration_1']
    """

    robot: Robot
    time: Array
    position: Array
    velocity: Array
    acceleration: Array
    gain: float | None
    parameters: int
    torque: Array | None
    clearance: float

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck robot plan`."""
        joints = [
            {
                "joint": name,
                "position": [float(self.position[:, k].min()), float(self.position[:, k].max())],
                "speed": float(np.abs(self.velocity[:, k]).max()),
                "acceleration": float(np.abs(self.acceleration[:, k]).max()),
                "torque": None if self.torque is None else float(self.torque[k]),
                "torque_limit": self.robot.joints[k].torque_limit,
            }
            for k, name in enumerate(self.robot.names)
        ]
        return {
            "robot": self.robot.name,
            "seconds": float(self.time[-1]),
            "gain": self.gain,
            "parameters": self.parameters,
            "clearance": self.clearance if self.robot.spheres else None,
            "joints": joints,
        }

    def to_frame(self) -> pl.DataFrame:
        """One row per sample: time, and the motion of each joint."""
        made = {"time": self.time}
        for k, name in enumerate(self.robot.names):
            made[f"position_{name}"] = self.position[:, k]
            made[f"velocity_{name}"] = self.velocity[:, k]
            made[f"acceleration_{name}"] = self.acceleration[:, k]
        return pl.DataFrame(made)


def plan_robot(
    robot: Robot,
    limits: Limits | Mapping[str, Limits],
    *,
    seconds: float = 20.0,
    rate: float = 200.0,
    tried: int = TRIED,
    seed: int = 0,
) -> RobotPlan:
    """Plan a motion of all joints within limits of position, speed and acceleration.

    Torques of the rigid bodies stay within the torque limits of the robot's joints, and the spheres
    of its links apart. Friction is not part of these torques; run the motion in a simulator first.

    Parameters
    ----------
    limits
        Of all joints, or by name of the joint.
    seconds, rate
        Duration, s, and samples per second of the result, Hz.
    tried
        Motions that the search compares.

    Raises
    ------
    SpecError
        A joint has no limits; torques are limited, but inertia is not known; no motion is found
        within the limits.

    Examples
    --------
    >>> import numpy as np
    >>> from stribeck import model, robot
    >>> arm = robot.from_tables("planar", [{"a": 0.4}, {"a": 0.3}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, -0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]] * 2))
    >>> friction = {
    ...     name: model("coulomb", coulomb_friction=2.0, viscous_friction=1.0) for name in arm.names
    ... }
    >>> from stribeck.motion.design.motion import Limits
    >>> limits = Limits(-1.0, 1.0, 1.5, 6.0)
    >>> planned = robot.plan_robot(arm, limits, seconds=10.0, rate=50.0, tried=20)
    >>> bool(abs(planned.velocity).max() <= 1.5)
    True
    """
    check_number("seconds", seconds, 2.0, 600.0, " s")
    check_number("rate", rate, 10.0, 10_000.0, " Hz")
    check_count("tried", tried, RANDOM)
    if any(joint.torque_limit for joint in robot.joints) and not robot.has_inertia:
        raise SpecError(
            f"{robot.name} has torque limits, but the inertial parameters of its links are not "
            f"known: give a robot file of `stribeck robot fit -o`, or a URDF"
        )
    search = _Search(robot, _families(robot, limits, seconds))
    design, usual = search.best(np.random.default_rng(seed), tried)
    time, position, velocity, acceleration = search.sampled(design, rate)
    torque = None
    if robot.has_inertia:
        torque = robot.motor_torque(robot.torque(position, velocity, acceleration))
    apart = float(clearance(robot, position).min())
    if apart < 0.0 or (torque is not None and _excess(robot, torque) > 1.0):
        raise SpecError(
            f"{robot.name}: no motion within the torque limits and without collision is found: "
            f"allow less position, speed or acceleration"
        )
    score = search.score(search.motions(design))
    gain = None if usual is None else float(np.exp((score - usual) / search.parameters))
    largest = None if torque is None else np.abs(torque).max(axis=0)
    return RobotPlan(
        robot, time, position, velocity, acceleration, gain, search.parameters, largest, apart
    )


def _excess(robot: Robot, torque: Array) -> float:
    """Largest share of its limit that a joint's torque [n, N] reaches; 0 without limits."""
    limits = np.array([joint.torque_limit or np.inf for joint in robot.joints])
    return float(np.max(np.abs(torque) / limits))


def _families(
    robot: Robot, limits: Limits | Mapping[str, Limits], seconds: float
) -> list[FourierMotions]:
    if isinstance(limits, Limits):
        return [FourierMotions(limits, seconds, COARSE) for _ in robot.joints]
    for name in limits:
        if name not in robot.names:
            hint = nearest(name, robot.names) or f"; the joints are {listed(robot.names)}"
            raise SpecError(f"{robot.name} has no joint '{name}'{hint}")
    missing = [name for name in robot.names if name not in limits]
    if missing:
        raise SpecError(f"there are no limits of joint {listed(missing)}: give them for each joint")
    return [FourierMotions(limits[name], seconds, COARSE) for name in robot.names]


def _key(rank: tuple[float, float]) -> tuple[float, float]:
    """Orders designs: less violation first, then more information."""
    return -rank[0], rank[1]


class _Search:
    """Motions of a robot, scored by what they show."""

    def __init__(self, robot: Robot, families: list[FourierMotions]) -> None:
        self.robot, self.families = robot, families
        self.base = BaseParameters.of(robot)
        self.parameters = self.base.count + 3 * len(families)

    def drawn(self, random: np.random.Generator) -> list[Array]:
        """A random design of each joint."""
        return [random.random(family.variables) for family in self.families]

    def sampled(self, design: list[Array], rate: float) -> tuple[Array, Array, Array, Array]:
        """Time [n], and position, velocity and acceleration [n, N]."""
        joints = [
            family.motion(own, rate) for family, own in zip(self.families, design, strict=True)
        ]
        position = np.stack([joint.position for joint in joints], axis=1)
        velocity = np.stack([joint.velocity for joint in joints], axis=1)
        acceleration = np.stack([joint.acceleration for joint in joints], axis=1)
        return joints[0].time, position, velocity, acceleration

    def motions(self, design: list[Array]) -> tuple[Array, Array, Array]:
        """The motion during the search."""
        return self.sampled(design, COARSE)[1:]

    def best(self, random: np.random.Generator, tried: int) -> tuple[list[Array], float | None]:
        """The best design, and the median score of random ones within the limits.

        Of two designs the one with the smaller violation of the limits is better, and of two
        without violation that with the larger score (Deb 2000).
        """
        designs = [self.drawn(random) for _ in range(RANDOM)]
        if self.is_limited:
            designs += [self.drawn(random) for _ in range(DRAWN - RANDOM)]
        ranks = [self.rank(design) for design in designs]
        usual = [score for violation, score in ranks if violation == 0.0][:RANDOM]
        design, rank = max(zip(designs, ranks, strict=True), key=lambda pair: _key(pair[1]))
        for k in range(tried - RANDOM):
            joint = k % len(self.families)
            step = SPREAD * random.normal(size=design[joint].size)
            changed = [*design]
            changed[joint] = np.clip(design[joint] + step, 0.0, 1.0)
            found = self.rank(changed)
            if _key(found) > _key(rank):
                design, rank = changed, found
        return design, float(np.median(usual)) if len(usual) >= FEWEST else None

    @property
    def is_limited(self) -> bool:
        """Whether there are limits beside those of position, speed and acceleration."""
        limited = any(joint.torque_limit for joint in self.robot.joints)
        return limited or bool(self.robot.spheres)

    def rank(self, design: list[Array]) -> tuple[float, float]:
        """Violation of the limits of torque and distance, and score, of a design."""
        motion = self.motions(design)
        violation = 0.0
        if self.is_limited:
            apart = float(clearance(self.robot, motion[0]).min())
            violation = max(0.0, APART - apart)
            if self.robot.has_inertia:
                share = _excess(self.robot, self.robot.motor_torque(self.robot.torque(*motion)))
                violation += max(0.0, share - TORQUE_SHARE)
        # Designs that are not allowed are compared by their violation alone.
        return violation, self.score(motion) if violation == 0.0 else 0.0

    def score(self, motion: tuple[Array, Array, Array]) -> float:
        """Half the logarithm of the determinant of the information on all parameters.

        The noise of a joint is taken as proportional to the size of its torque, which follows from
        its row of the regressor.
        """
        rigid = self.robot.motor_torque(self.robot.regressor(*motion)[:, :, self.base.chosen])
        count, joints, size = rigid.shape
        matrix = np.zeros((count, joints, self.parameters))
        matrix[:, :, :size] = rigid
        velocity = self.robot.motors_of(motion[1])
        for joint in range(joints):
            columns = (np.sign(velocity[:, joint]), velocity[:, joint], np.ones(count))
            for k, column in enumerate(columns):
                matrix[:, joint, size + 3 * joint + k] = column
        scale = np.sqrt(np.mean(np.sum(rigid**2, axis=2), axis=0))
        rows = (matrix / scale[:, None]).reshape(count * joints, -1)
        diagonal = np.abs(np.diag(Triangle.of(rows, np.zeros(len(rows))).factor))
        return float(np.sum(np.log(np.maximum(diagonal, 1e-300))))
