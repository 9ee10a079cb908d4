"""What stands in for the Indy-7 of Tadese et al. 2021: friction by its eqs 8-18, and noise.

Table 2 prints stiffness and damping of the bristles. The other parameters are in figures without
numbers: those of joint 2 are chosen here, in size like its figures, and the other joints' follow by
one factor each.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.models.build import model
from stribeck.models.model import Model
from stribeck.models.published.sets import published
from stribeck.motion.simulate.drive import Torque
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.run import simulate

Array = NDArray[np.float64]

#: Section IV: speed at which the damping has fallen to 1/e, rad/s.
DAMPING_VELOCITY = 0.001
#: Friction of each joint, as a share of that of joint 2, by the sizes of the gears.
SIZES = (1.1, 1.0, 0.5, 0.3, 0.25, 0.22)
#: Inertia [kg m2] and gravity [N m] of the arm with the payload of 6.66 kg at each joint, and the
#: temperature, degC: "a minimum of 45 for joint 1 and a maximum of 55 for joint 5".
INERTIAS = (3.5, 3.9, 2.0, 0.35, 0.3, 0.15)
GRAVITIES = (0.0, 55.0, 30.0, 9.0, 7.0, 0.0)
WARM = (45.0, 48.0, 50.0, 53.0, 55.0, 52.0)
ROOM = 27.0
#: Encoder's step at the joint: 16 bit before a 1:121 gear, rad.
ENCODER = 2.0 * math.pi / 65536 / 121
#: RMS noise of a sample's torque, and of a point, as shares of the friction; N m for joint 2.
TORQUE_NOISE, POINT_NOISE = 0.05, 0.01
#: Eq 13 by direction: coulomb, level, level slope, speed, speed slope, T in degC.
VISCOUS = {
    "forward": (9.0, 21.0, -0.18, 0.42, 0.004),
    "backward": (8.2, 19.0, -0.15, 0.50, 0.003),
}
VISCOUS_NAMES = (
    "coulomb_friction",
    "viscous_level",
    "viscous_level_slope",
    "viscous_speed",
    "viscous_speed_slope",
)
#: Eq 15 by quadrant: gamma_1, gamma_2, gamma_3, lambda_1, lambda_2, the sign of friction included.
LOAD = {
    "forward_motoring": (1.2, 4.0, 0.4, 0.16, 0.020),
    "backward_generating": (-0.8, 5.0, -0.3, -0.05, 0.010),
    "backward_motoring": (-1.1, 3.5, -0.5, 0.15, -0.018),
    "forward_generating": (0.9, 4.5, 0.2, -0.06, -0.008),
}
LOAD_NAMES = ("load_rise", "load_rise_rate", "load_jump", "load_friction", "load_viscous")
#: Beginnings of the names without which load adds no friction.
_OF_LOAD = ("load_rise_f", "load_rise_b", "load_jump", "load_friction", "load_viscous")
#: Which of them are torques.
TORQUES = {"coulomb_friction", "viscous_level", "viscous_level_slope", "load_rise", "load_jump"}
SPEEDS = np.array([0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 1.2, 1.5, 1.8])
TEMPERATURES = np.array([20.0, 30.0, 40.0, 50.0, 60.0])
LOADS = np.array([-60.0, -40.0, -20.0, -5.0, 5.0, 20.0, 40.0, 60.0])


@dataclass(frozen=True)
class Axis:
    """One joint of the robot: its friction, and how much of joint 2's it has."""

    number: int
    friction: Model
    size: float

    @property
    def loads(self) -> Array:
        """Loads of the second experiment, N m."""
        return LOADS * self.size


def axis(number: int) -> Axis:
    """Joint 1 to 6."""
    size = SIZES[number - 1]
    printed = published(f"tadese/table_2/joint_{number}/tadese_full")
    values = {
        name: value
        for name, value in zip(printed.names, printed.values.tolist(), strict=True)
        if value == value
    }
    for names, table in ((VISCOUS_NAMES, VISCOUS), (LOAD_NAMES, LOAD)):
        for side, row in table.items():
            for name, value in zip(names, row, strict=True):
                values[f"{name}_{side}"] = value * (size if name in TORQUES else 1.0)
    return Axis(number, model("tadese_full", **values), size)


def steady(friction: Model, velocity: Array, temperature: Array, load: Array) -> Array:
    """Friction at constant speed, N m, array [n]: the bristle has settled."""
    return friction.torque(velocity, temperature=temperature, load_torque=load, dt=1e9)


def points(joint: Axis, temperature: Array, load: Array, seed: int) -> pl.DataFrame:
    """Means over passes at 22 speeds, for each pair of temperature and load [n]."""
    rng = np.random.default_rng([seed, joint.number])
    speeds = np.ravel(np.column_stack([SPEEDS, -SPEEDS]))
    v = np.tile(speeds, temperature.size)
    warm, loaded = (np.repeat(x, speeds.size) for x in (temperature, load))
    friction = steady(joint.friction, v, warm, loaded)
    friction = friction + POINT_NOISE * joint.size * rng.standard_normal(v.size)
    return pl.DataFrame(
        {
            "run": np.arange(v.size),
            "velocity": v,
            "temperature": warm,
            "load_torque": loaded,
            "torque": friction + loaded,
        }
    )


def presliding(joint: Axis, seed: int) -> pl.DataFrame:
    """The answer to a sinusoidal torque below the Coulomb friction, so slow that damping shows.

    Eq 15 has no place here: it jumps with the sign of the load, which at rest is that of noise.
    """
    rng = np.random.default_rng([seed, joint.number])
    names, step = joint.friction.names, 1e-3
    friction = joint.friction.with_values(
        [0.0 if n.startswith(_OF_LOAD) else joint.friction.value(n) for n in names]
    )
    size = 0.7 * 8.2 * joint.size
    stiffness = friction.value("bristle_stiffness")
    frequency = 0.8 * DAMPING_VELOCITY * stiffness / (2.0 * math.pi * size)
    time = np.arange(int(5.0 / frequency / step)) * step
    applied = size * np.sin(2.0 * math.pi * frequency * time)
    moved = simulate(
        friction, Joint.revolute(1.5 * joint.size), Torque(applied), step=step, temperature=35.0
    )
    measured = moved.position / ENCODER + rng.uniform(-0.5, 0.5, time.size)
    return pl.DataFrame(
        {
            "time": time,
            "position": ENCODER * np.round(measured),
            "torque": applied + TORQUE_NOISE * joint.size * rng.standard_normal(time.size),
            "load_torque": np.zeros(time.size),
            "temperature": np.full(time.size, 35.0),
        }
    )


def passes(joint: Axis, error: float, seed: int) -> pl.DataFrame:
    """Figures 2 and 7: to and fro between -90 and 90 degrees at several speeds, gravity changing.

    Parameters
    ----------
    error
        RMS of what no model explains, N m; correlated over a tenth of a second.
    """
    rng = np.random.default_rng([seed, 9])
    rate, parts = 50.0, []
    for speed in (0.1, 0.3, 0.6, 1.0, 1.5):
        count = int(math.pi / speed * rate)
        there = np.linspace(-math.pi / 2, math.pi / 2, count)
        parts += [(there, np.full(count, speed)), (there[::-1], np.full(count, -speed))]
    q, v = (np.concatenate(column) for column in zip(*parts, strict=True))
    load = LOADS[-1] * np.sin(q)
    kernel = np.ones(5) / math.sqrt(5.0)
    noise = error * np.convolve(rng.standard_normal(q.size), kernel, mode="same")
    friction = steady(joint.friction, v, np.full(q.size, 35.0), load) + noise
    return pl.DataFrame(
        {
            "run": np.arange(q.size),
            "time": np.arange(q.size) / rate,
            "position": q,
            "velocity": v,
            "temperature": np.full(q.size, 35.0),
            "load_torque": load,
            "torque": friction + load,
        }
    )
