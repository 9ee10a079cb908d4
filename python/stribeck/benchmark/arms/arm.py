"""A drawn arm: links, basic friction and motion of every joint."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.open_loop.joint import SimulatedJoint
from stribeck.benchmark.open_loop.motion import MoveChain
from stribeck.benchmark.open_loop.schedule import schedule
from stribeck.benchmark.open_loop.world import World
from stribeck.robot.arm import Robot
from stribeck.robot.consistent import inertial_of
from stribeck.robot.tables import from_tables

Array = NDArray[np.float64]

#: a [m], d [m], alpha [rad] of a six-joint arm, and mass [kg] of its links.
LINKS = (
    (0.0, 0.18, np.pi / 2, 7.0),
    (-0.61, 0.0, 0.0, 12.0),
    (-0.57, 0.0, 0.0, 4.0),
    (0.0, 0.17, np.pi / 2, 2.0),
    (0.0, 0.12, -np.pi / 2, 2.0),
    (0.0, 0.12, 0.0, 0.5),
)
#: Coulomb friction of the first joint, N m; that of joint k is this over k.
COULOMB = 12.0
#: Range of a joint to each side, rad, and its largest acceleration over its largest speed, 1/s.
HALF, BRISK = 1.2, 3.0


def draw_arm(random: np.random.Generator, joints: int = len(LINKS)) -> Robot:
    """An arm with the proportions of `LINKS`; its bodies are drawn, and possible."""
    size = log_uniform(random, 0.7, 1.3)
    rows = [{"a": size * a, "d": size * d, "alpha": alpha} for a, d, alpha, _ in LINKS[:joints]]
    bodies = []
    for a, _, _, mass in LINKS[:joints]:
        heavy = mass * log_uniform(random, 0.7, 1.4)
        # Factors of a pseudo-inertia: every draw is a body of positive mass density.
        spread = np.log(np.sqrt(heavy) * random.uniform(0.06, 0.12, 3))
        centre = np.sqrt(heavy) * (np.array([-0.5 * size * a, 0, 0]) + random.normal(0, 0.03, 3))
        factors = np.concatenate([spread, [0.5 * np.log(heavy)], np.zeros(6)])
        factors[[6, 8, 9]] = centre
        bodies.append([*inertial_of(factors), log_uniform(random, 0.1, 0.6)])
    return from_tables("arm", rows).with_bodies(np.array(bodies))


def draw_friction(
    random: np.random.Generator, number: int, effects: Sequence[str]
) -> SimulatedJoint:
    """Basic friction and range of a joint; `number` counts from 1."""
    coulomb = COULOMB / number * log_uniform(random, 0.7, 1.4)
    fastest = HALF * log_uniform(random, 0.9, 1.6)
    share = log_uniform(random, 0.35, 1.8)
    # The effects of viscous friction need some to act on.
    if "temperature_viscous" in effects:
        share = max(share, 0.7)
    if "nonlinear_viscous" in effects:
        share = random.uniform(1.3, 2.5)
    return SimulatedJoint(
        kind="revolute",
        coulomb=coulomb,
        viscous=coulomb * share / fastest,
        vmax=fastest,
        amax=BRISK * fastest,
        half=HALF,
        centre=float(random.uniform(-0.4, 0.4)),
        inertia=0.0,
        gravity=0.0,
        phase=0.0,
        spring=0.0,
    )


@dataclass
class ArmJoint(World):
    """A joint whose load torque is that of the arm in motion.

    Attributes
    ----------
    load_at
        Load torque at times [n].
    """

    load_at: Callable[[Array], Array] = field(default=np.zeros_like)

    def true_load(self, t: Array, q: Array, a: Array) -> Array:
        """Torque of the rigid bodies."""
        return self.load_at(t)


@dataclass(frozen=True)
class ArmMotion:
    """The motion of all joints, each on a schedule of its own."""

    joints: tuple[MoveChain, ...]

    @classmethod
    def draw(
        cls,
        random: np.random.Generator,
        joints: Sequence[SimulatedJoint],
        seconds: float,
        effects: Sequence[str],
    ) -> ArmMotion:
        """Sines, moves, slow scans and strokes in random order."""
        brisk, smooth = "presliding" in effects, "delay" in effects
        return cls(
            tuple(schedule(random, j, seconds + 1.0, None, brisk, smooth)[0] for j in joints)
        )

    def __call__(self, t: Array) -> tuple[Array, Array, Array]:
        """Positions, velocities and accelerations [n, N]."""
        q, v, a = (np.stack(x, axis=1) for x in zip(*(m(t) for m in self.joints), strict=True))
        return q, v, a

    def load(self, robot: Robot, joint: int) -> Callable[[Array], Array]:
        """Load torque of one joint at given times."""
        return lambda t: np.ascontiguousarray(robot.torque(*self(t))[:, joint])
