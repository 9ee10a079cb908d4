"""The two-joint arm of Indri et al.: point masses in the plane, friction of its table 1.

Torques come from Newton's law of each point mass and virtual work, which shares nothing with the
regressor under test.
"""

from __future__ import annotations

import numpy as np
import polars as pl
from numpy.typing import NDArray
from stribeck.fitting.methods.trajectory import FOUR_HARMONICS

Array = NDArray[np.float64]

#: Length of the first link [m]: half of the 0.7 m that both links measure; the paper leaves it out.
FIRST_LINK = 0.35
#: Nominal inertial vector, eq 15: kg m2, kg m, kg m, kg m2.
NOMINAL = (3.689, 0.97, 0.0, 0.275)
#: Mass of the second link [kg], any: the first link's inertia about its joint makes up for it.
SECOND_MASS = 4.0

#: Table 1, one row a joint and direction: alpha0 to alpha4, omega_s1, omega_s2.
FRICTION = {
    (1, 1): (40.854, -32.454, -31.233, -0.760, -0.262, 0.19, 0.17),
    (1, -1): (-46.473, 53.873, 55.738, -0.293, 0.177, 0.14, 0.15),
    (2, 1): (17.837, -14.837, -14.998, -0.156, -0.050, 0.2, 0.19),
    (2, -1): (3.408, -0.408, -0.635, -0.104, 0.036, 0.3, 0.1),
}
#: RMS noise of the torques [N m], and the resolvers' step [rad]: 153 600 a turn.
TORQUE_NOISE, RESOLVER = (0.25, 0.08), 2.0 * np.pi / 153600


def friction(joint: int, velocity: Array) -> Array:
    """Equations 3, 6 and 7 with table 1, N m."""
    torque = np.zeros_like(velocity)
    for way in (1, -1):
        a0, a1, a2, a3, a4, w1, w2 = FRICTION[joint, way]
        v = velocity[np.sign(velocity) == way]
        dry = a0 + a1 * np.exp(-np.abs(v) / w1) + a2 * (1.0 - np.exp(-np.abs(v) / w2))
        torque[np.sign(velocity) == way] = way * dry + a3 * v + a4 * v**2
    return torque


def second_link() -> list[tuple[float, complex]]:
    """Point masses [kg] and their places [m] in the second link's frame, along its real axis."""
    _, along, across, inertia = NOMINAL
    centre = complex(along, across) / SECOND_MASS
    spread = np.sqrt(inertia / SECOND_MASS - abs(centre) ** 2)
    return [(SECOND_MASS / 2, centre + spread), (SECOND_MASS / 2, centre - spread)]


def _turned(angle: Array, rate: Array, acceleration: Array) -> tuple[Array, Array]:
    """exp(i angle) and its second derivative in time."""
    turn = np.exp(1j * angle)
    return turn, (1j * acceleration - rate**2) * turn


def rigid_body(q: Array, v: Array, a: Array) -> Array:
    """Torque of both joints without friction, N m, array [n, 2]."""
    inner, inner_rate = _turned(q[:, 0], v[:, 0], a[:, 0])
    outer, outer_rate = _turned(q.sum(axis=1), v.sum(axis=1), a.sum(axis=1))
    # What turns with the first link alone; the masses below add m2 l1^2.
    torque = np.column_stack([(NOMINAL[0] - SECOND_MASS * FIRST_LINK**2) * a[:, 0], 0.0 * a[:, 0]])
    for mass, place in second_link():
        force = mass * (FIRST_LINK * inner_rate + place * outer_rate)
        lever = 1j * place * outer
        torque[:, 0] += (force * np.conj(1j * FIRST_LINK * inner + lever)).real
        torque[:, 1] += (force * np.conj(lever)).real
    return torque


def recording_frame(*, seed: int = 0, repetitions: int = 10, rows: int = 2500) -> pl.DataFrame:
    """The four-harmonic trajectory, repeated: angles and torques of both joints."""
    rng = np.random.default_rng(seed)
    time = np.arange(rows) * FOUR_HARMONICS.seconds / rows
    q, v, a = FOUR_HARMONICS(time)
    torque = rigid_body(q, v, a) + np.column_stack([friction(j, v[:, j - 1]) for j in (1, 2)])
    runs = []
    for run in range(1, repetitions + 1):
        measured = torque + TORQUE_NOISE * rng.standard_normal(torque.shape)
        angle = RESOLVER * np.round((q + 0.5 * RESOLVER * rng.standard_normal(q.shape)) / RESOLVER)
        columns = {"run": run, "time": time}
        for k in (1, 2):
            columns |= {f"q_{k}": angle[:, k - 1], f"torque_{k}": measured[:, k - 1]}
        runs.append(pl.DataFrame(columns))
    return pl.concat(runs)
