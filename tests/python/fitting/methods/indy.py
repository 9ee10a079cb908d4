"""The Indy-7 of Tadese et al. 2021: friction by its eqs 8-18, written with numpy alone.

Stiffness and damping are those of table 2. The paper gives the other parameters in figures only:
the numbers here, of joint 2, are of their size.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Table 2, joints 1 to 6: N m/rad, N m s/rad.
BRISTLES = (
    (16804.0, 270.0),
    (12930.0, 233.0),
    (1820.0, 105.0),
    (1649.0, 81.0),
    (1106.0, 72.0),
    (985.0, 68.0),
)
JOINT_2 = BRISTLES[1]
#: Section IV: v_d in rad/s.
DAMPING_VELOCITY = 0.001
#: Dry friction [N m] forward and backward.
COULOMB = {1: 9.0, -1: 8.2}
#: sigma_2 = level + slope T [N m], sigma_3 likewise [rad/s], T in degC (eq 13).
VISCOUS = {1: (21.0, -0.18, 0.42, 0.004), -1: (19.0, -0.15, 0.50, 0.003)}
#: gamma_1, gamma_2, gamma_3, lambda_1, lambda_2 by the signs of speed and load (eq 15), the sign
#: of friction included: positive for v > 0.
LOAD = {
    (1, 1): (1.2, 4.0, 0.4, 0.16, 0.020),
    (-1, 1): (-0.8, 5.0, -0.3, -0.05, 0.010),
    (-1, -1): (-1.1, 3.5, -0.5, 0.15, -0.018),
    (1, -1): (0.9, 4.5, 0.2, -0.06, -0.008),
}
#: Inertia at the joint [kg m2] and the encoder's step there [rad]: 16 bit before a 1:121 gear.
INERTIA, ENCODER = 1.5, 2.0 * math.pi / 65536 / 121
#: RMS noise of a sample's torque and of a point, the mean of many samples, N m.
TORQUE_NOISE, POINT_NOISE = 0.05, 0.01


def viscous(v: float, temperature: float) -> float:
    """Equation 13 with the sign of the velocity, N m."""
    way = 1 if v > 0 else -1
    level, slope, speed, speed_slope = VISCOUS[way]
    rise = 1.0 - math.exp(-abs(v) / (speed + speed_slope * temperature))
    return way * (level + slope * temperature) * rise


def load_friction(v: float, load: float) -> float:
    """Equation 15, N m; none without load or speed."""
    if v == 0.0 or load == 0.0:
        return 0.0
    g1, g2, g3, l1, l2 = LOAD[1 if v > 0 else -1, 1 if load > 0 else -1]
    return g1 * (1.0 - math.exp(-abs(g2 * v))) + g3 + (l1 + l2 * v) * load


def steady(v: float, temperature: float, load: float) -> float:
    """Friction at constant speed, N m."""
    way = 1 if v > 0 else -1
    return way * COULOMB[way] + viscous(v, temperature) + load_friction(v, load)


def points(rows: list[tuple[float, float, float]], seed: int) -> pl.DataFrame:
    """Steady-state points at (velocity, temperature, load torque), means of many samples."""
    rng = np.random.default_rng(seed)
    v, temperature, load = np.array(rows).T
    friction = [steady(*row) for row in rows] + POINT_NOISE * rng.standard_normal(len(rows))
    return pl.DataFrame(
        {
            "run": np.arange(len(rows)),
            "velocity": v,
            "temperature": temperature,
            "load_torque": load,
            "torque": friction + load,
        }
    )


SPEEDS = [
    way * s for s in (0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 1.2, 1.5, 1.8) for way in (1, -1)
]


def no_load_points() -> pl.DataFrame:
    """First step: 22 speeds at five temperatures."""
    return points([(v, t, 0.0) for t in (20.0, 30.0, 40.0, 50.0, 60.0) for v in SPEEDS], seed=1)


def loaded_points() -> pl.DataFrame:
    """Second step: 22 speeds at eight loads, all at 35 degC."""
    loads = (-60.0, -40.0, -20.0, -5.0, 5.0, 20.0, 40.0, 60.0)
    return points([(v, 35.0, load) for load in loads for v in SPEEDS], seed=2)


@dataclass
class Swing:
    """The joint under a torque, position and velocity, and its bristle."""

    bristle: tuple[float, float]
    temperature: float
    state: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def rates(self, state: tuple[float, float, float], torque: float) -> tuple[float, ...]:
        """Time derivatives of position, velocity and deflection (eqs 10, 16, 18)."""
        _, v, z = state
        way = 1 if v > 0 else -1
        stiffness, damping = self.bristle
        slip = v - stiffness * abs(v) / COULOMB[way] * z
        damping *= math.exp(-abs(v) / DAMPING_VELOCITY)
        friction = stiffness * z + damping * slip + (viscous(v, self.temperature) if v else 0.0)
        return v, (torque - friction) / INERTIA, slip

    def advance(self, torques: tuple[float, float, float], step: float) -> None:
        """One step of Runge and Kutta's method, with the torque at its start, middle and end."""
        y = self.state
        k1 = self.rates(y, torques[0])
        k2 = self.rates(_shifted(y, k1, step / 2), torques[1])
        k3 = self.rates(_shifted(y, k2, step / 2), torques[1])
        k4 = self.rates(_shifted(y, k3, step), torques[2])
        slope = [(a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(k1, k2, k3, k4, strict=True)]
        self.state = _shifted(y, slope, step)


def _shifted(y: tuple[float, ...], slope: object, step: float) -> tuple[float, float, float]:
    a, b, c = (x + step * s for x, s in zip(y, slope, strict=True))
    return a, b, c


def presliding_log(
    bristle: tuple[float, float] = JOINT_2,
    *,
    share: float = 0.7,
    cycles: float = 5.0,
    rate: float = 1000.0,
    seed: int = 3,
) -> pl.DataFrame:
    """Third step: a sinusoidal torque below the Coulomb friction, and how the joint answers.

    It has `share` of the Coulomb friction, and is so slow that the speed stays below v_d: beyond it
    there is no damping to see.
    """
    rng = np.random.default_rng(seed)
    size = share * min(COULOMB.values())
    frequency = 0.8 * DAMPING_VELOCITY * bristle[0] / (2.0 * math.pi * size)
    rows, step = int(cycles / frequency * rate), 1.0 / rate

    def torque(t: float) -> float:
        return size * math.sin(2.0 * math.pi * frequency * t)

    joint, position, applied = Swing(bristle, 35.0), np.zeros(rows), np.zeros(rows)
    for k in range(rows):
        t = k * step
        position[k], applied[k] = joint.state[0], torque(t)
        joint.advance((torque(t), torque(t + step / 2), torque(t + step)), step)
    measured = ENCODER * np.round(position / ENCODER + rng.uniform(-0.5, 0.5, rows))
    return pl.DataFrame(
        {
            "time": np.arange(rows) * step,
            "position": measured,
            "torque": applied + TORQUE_NOISE * rng.standard_normal(rows),
            "load_torque": np.zeros(rows),
            "temperature": np.full(rows, 35.0),
        }
    )
