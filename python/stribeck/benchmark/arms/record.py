"""Recordings of an arm with a hidden effect of one joint, or a cause in the rigid bodies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.benchmark.arms.arm import ArmJoint, ArmMotion, draw_arm, draw_friction
from stribeck.benchmark.arms.cases import ArmCase
from stribeck.benchmark.draws import log_uniform, size_beyond
from stribeck.benchmark.open_loop.amplitude import find_amplitudes
from stribeck.benchmark.open_loop.joint import SimulatedJoint
from stribeck.benchmark.open_loop.record import coloured_noise
from stribeck.benchmark.open_loop.shapes import (
    Shapes,
    draw_additive_shapes,
    draw_quadrant_shape,
    draw_shapes,
)
from stribeck.benchmark.open_loop.temperature import joint_temperature
from stribeck.robot.arm import Robot
from stribeck.robot.base_parameters import BaseParameters

Array = NDArray[np.float64]

#: Runs of an arm, their duration, s, and samples per second, Hz.
RUNS, SECONDS, RATE = 2, 60.0, 100.0
#: Size of what is hidden, relative to the noise.
SIZE = 5.0
#: Time excluded from all sizes, s, in which filters settle.
SETTLED = 1.0
#: Where the payload of 1 kg is, and where else; m in the frame of the last link.
CENTRE, ELSEWHERE = np.array([0.02, 0.03, 0.1]), np.array([0.12, -0.05, 0.1])
#: Error of a centre of mass along x of its link, m.
WRONG_CENTRE = 0.05


@dataclass(frozen=True)
class ArmSample:
    """The runs of one arm, and the truth.

    Attributes
    ----------
    robot
        With its true bodies.
    size
        Of what is hidden, relative to the noise of the joint that shows it most, beyond what base
        parameters, Coulomb and viscous friction and an offset hold.
    """

    robot: Robot
    frames: tuple[pl.DataFrame, ...]
    size: float


def arm_sample(case: ArmCase) -> ArmSample:
    """Simulate the arm of a case."""
    return _Session(case).sample()


@dataclass
class _Run:
    """One run: its motion, the arm that moves, and every joint."""

    t: Array
    motion: ArmMotion
    robot: Robot
    joints: list[ArmJoint]


class _Session:
    """The random quantities of one seed."""

    def __init__(self, case: ArmCase) -> None:
        self.case = case
        self.random = np.random.default_rng(case.seed)
        self.robot = draw_arm(self.random)
        count = len(self.robot.joints)
        self.friction = [draw_friction(self.random, k + 1, self._effects(k)) for k in range(count)]
        self.noise = [j.coulomb * log_uniform(self.random, 0.015, 0.05) for j in self.friction]
        self.sigma = [j.vmax * log_uniform(self.random, 1e-4, 4e-4) for j in self.friction]
        self.runs = [self._run(number) for number in range(RUNS)]
        self._shape()
        base = BaseParameters.of(self.robot)
        self.state = [run.motion(run.t) for run in self.runs]
        self.rigid = [self.robot.regressor(*state)[:, :, base.chosen] for state in self.state]

    def _effects(self, joint: int) -> tuple[str, ...]:
        case = self.case
        return (case.hidden,) if case.group == "effect" and case.joint == joint + 1 else ()

    def _run(self, number: int) -> _Run:
        effects = self._effects(self.case.joint - 1)
        motion = ArmMotion.draw(self.random, self.friction, SECONDS, effects)
        t = np.arange(round(SECONDS * RATE)) / RATE
        joints = [self._joint(own, motion, k) for k, own in enumerate(self.friction)]
        return _Run(t, motion, self.robot, joints)

    def _joint(self, own: SimulatedJoint, motion: ArmMotion, k: int) -> ArmJoint:
        heat = joint_temperature(self.random, SECONDS, None)
        holds = self.random.uniform(-0.9, 0.9, (997, 2))
        nothing, one = np.zeros(0), np.ones(1)
        over = int(self.random.integers(8, 17))
        load = motion.load(self.robot, k)
        return ArmJoint(
            own, motion.joints[k], nothing, one, heat, holds, {}, None, 1 / RATE, over, load_at=load
        )

    def _shape(self) -> None:
        """One form of each dependence for each joint; runs follow each other as it ages."""
        for k, own in enumerate(self.friction):
            parts = [run.joints[k] for run in self.runs]
            loads = np.concatenate([p.load_at(r.t) for p, r in zip(parts, self.runs, strict=True)])
            heat = np.concatenate(
                [p.temperature(r.t) for p, r in zip(parts, self.runs, strict=True)]
            )
            shapes = draw_shapes(self.random, own, loads, heat)
            shapes |= draw_additive_shapes(self.random, own, loads, RUNS * SECONDS)
            shapes |= draw_quadrant_shape(self.random, own, loads)
            for number, part in enumerate(parts):
                part.shapes = shapes | {"drift": _later(shapes, number * SECONDS)}

    def moving(self, k: int, run: int) -> NDArray[np.bool_]:
        """Samples at which a joint moves."""
        return np.asarray(
            (np.abs(self.state[run][1][:, k]) > 5 * self.sigma[k]) & (self.runs[run].t > SETTLED)
        )

    def beyond(self, parts: list[Array], k: int) -> float:
        """RMS of the torques [n] of each run beyond the ordinary model of a joint."""
        values, basis = [], []
        for run, part in enumerate(parts):
            on, v = self.moving(k, run), self.state[run][1][:, k]
            columns = [np.sign(v), v, np.ones_like(v)]
            values.append(part[on])
            basis.append(np.column_stack([*columns, self.rigid[run][:, k]])[on])
        return size_beyond(np.concatenate(values), np.concatenate(basis))

    def sample(self) -> ArmSample:
        """The recordings."""
        case, size = self.case, 0.0
        amplitudes: dict[str, float] = {}
        rigid: Callable[[int, float], Array] = self._extra
        scale = 0.0
        if case.group == "effect":
            amplitudes, size = self._sized_effect(case.joint - 1)
        elif case.hidden in ("payload", "payload_centre", "cable"):
            units = [rigid(number, 1.0) for number in range(RUNS)]
            count = len(self.friction)
            sizes = [self.beyond([u[:, k] for u in units], k) / self.noise[k] for k in range(count)]
            scale, size = SIZE / max(sizes), SIZE
        frames = tuple(
            self._frame(number, amplitudes, rigid(number, scale)) for number in range(RUNS)
        )
        return ArmSample(self.robot, frames, size)

    def _sized_effect(self, k: int) -> tuple[dict[str, float], float]:
        """The amplitude of the effect, and its size; the noise falls if it cannot be so large."""
        joints = [run.joints[k] for run in self.runs]
        for joint in joints:
            joint.coarse = True

        def size(name: str, amplitude: float) -> float:
            pairs = zip(joints, self.runs, strict=True)
            parts = [
                j.measured(r.t, {name: amplitude})[0] - j.measured(r.t, {})[0] for j, r in pairs
            ]
            return self.beyond(parts, k)

        name = self.case.hidden
        amplitudes, self.noise[k] = find_amplitudes({name: SIZE}, self.noise[k], size, ())
        for joint in joints:
            joint.coarse = False
        return amplitudes, size(name, amplitudes[name]) / self.noise[k]

    def _extra(self, number: int, scale: float) -> Array:
        """Torques [n, N] of a cause in the rigid bodies of this scale, in one run."""
        q, v, a = self.state[number]
        none = np.zeros_like(q)
        hidden = self.case.hidden
        if hidden == "cable":
            k = self.case.joint - 1
            none[:, k] = scale * cable(q[:, k] - self.friction[k].centre)
        elif hidden in ("payload", "payload_centre") and number == RUNS - 1:
            added = point_mass(CENTRE)
            if hidden == "payload_centre":
                added = point_mass(ELSEWHERE) - added
            bodies = np.zeros((len(self.friction), 11))
            bodies[-1, :10] = scale * added
            return self.robot.with_bodies(bodies).torque(q, v, a)
        return none

    def _frame(self, number: int, amplitudes: dict[str, float], extra: Array) -> pl.DataFrame:
        run, random = self.runs[number], self.random
        q, v, _ = self.state[number]
        columns = {"time": run.t}
        for k, joint in enumerate(run.joints):
            own = amplitudes if k == self.case.joint - 1 else {}
            torque = joint.measured(run.t, own)[0] + extra[:, k]
            name = self.robot.names[k]
            size = len(run.t)
            columns |= {
                f"position_{name}": q[:, k],
                f"velocity_{name}": v[:, k] + self.sigma[k] * random.standard_normal(size),
                f"torque_{name}": torque + self.noise[k] * coloured_noise(random, size),
                f"temperature_{name}": joint.temperature(run.t)
                + 0.04 * random.standard_normal(size),
            }
        return pl.DataFrame(columns)


def _later(shapes: Shapes, began: float) -> Callable[[Array], Array]:
    age: Callable[[Array], Array] = shapes["drift"]
    return lambda t: age(t + began)


def point_mass(centre: Array) -> Array:
    """Ten inertial parameters of 1 kg at a point."""
    inertia = centre @ centre * np.eye(3) - np.outer(centre, centre)
    rows, columns = [0, 0, 1, 0, 1, 2], [0, 1, 1, 2, 2, 2]
    return np.array([1.0, *centre, *inertia[rows, columns]])


def cable(angle: Array) -> Array:
    """Torque of a stretched cable between the joint's carrier and its link.

    Its ends are 0.1 m and 0.3 m from the axis, which makes a spring that is far from linear.
    """
    near, far, slack = 0.1, 0.3, 0.1
    length = np.sqrt(near**2 + far**2 - 2.0 * near * far * np.cos(angle))
    return np.asarray((length - slack) * near * far * np.sin(angle) / length)


def described(sample: ArmSample, case: ArmCase) -> Robot:
    """The arm as its maker describes it, wrong in the centre of one link if that is hidden."""
    if case.hidden != "link_centre":
        return sample.robot
    joints = list(sample.robot.joints)
    wrong = joints[case.joint - 1]
    inertial = np.array(wrong.inertial)
    inertial[1] += WRONG_CENTRE * inertial[0]
    joints[case.joint - 1] = replace(wrong, inertial=inertial)
    return replace(sample.robot, joints=tuple(joints))
