"""The arm's rigid body: virtual work, symmetry and balance of power, without its formulas."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from stribeck.motion.generate.arm import GRAVITY, Arm
from stribeck.motion.generate.ur5e import UR5E

Array = NDArray[np.float64]


def centres(arm: Arm, q: Array) -> Array:
    """Where each link's mass is, by multiplying the frames out, m, array [joints, 3]."""
    frame = np.eye(4)
    found = []
    for k, angle in enumerate(q):
        c, s, ca, sa = np.cos(angle), np.sin(angle), np.cos(arm.twist[k]), np.sin(arm.twist[k])
        a, d = arm.length[k], arm.offset[k]
        frame = frame @ np.array(
            [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
        )
        found.append((frame @ np.append(arm.centre[k], 1.0))[:3])
    return np.array(found)


def potential(q: Array) -> float:
    """Height times weight, J."""
    return float(GRAVITY * UR5E.mass @ centres(UR5E, q)[:, 2])


def kinetic(q: Array, v: Array) -> float:
    """Of the point masses by their velocities, and of the rotors, J."""
    step = 1e-6
    speed = (centres(UR5E, q + step * v) - centres(UR5E, q - step * v)) / (2.0 * step)
    return float(0.5 * UR5E.mass @ (speed**2).sum(axis=1) + 0.5 * UR5E.rotor_inertia @ v**2)


def test_gravity_is_the_slope_of_the_potential() -> None:
    q = np.array([0.3, -1.2, 0.9, -0.4, 1.1, 0.2])
    still = np.zeros((1, 6))
    slope = [(potential(q + 1e-6 * axis) - potential(q - 1e-6 * axis)) / 2e-6 for axis in np.eye(6)]
    np.testing.assert_allclose(UR5E.load_torque(q[None], still, still)[0], slope, atol=1e-6)


def test_the_mass_matrix_is_symmetric_and_positive() -> None:
    q = np.tile([0.3, -1.2, 0.9, -0.4, 1.1, 0.2], (6, 1))
    still = np.zeros((6, 6))
    mass = UR5E.load_torque(q, still, np.eye(6)) - UR5E.load_torque(q, still, still)
    np.testing.assert_allclose(mass, mass.T, atol=1e-12)
    assert np.linalg.eigvalsh(mass).min() > 0.0


def test_power_in_is_energy_gained() -> None:
    """Along a motion: torque times speed is the rate of kinetic and potential energy."""
    t = 0.7
    size, rate = np.array([0.5, 0.4, 0.6, 0.8, 0.7, 0.9]), np.array([1.1, 0.7, 1.3, 0.9, 1.7, 0.5])

    def state(t: float) -> tuple[Array, Array, Array]:
        s, c = np.sin(rate * t), np.cos(rate * t)
        return size * s - 0.5, size * rate * c, -size * rate**2 * s

    q, v, a = (part[None] for part in state(t))
    power = float(UR5E.load_torque(q, v, a)[0] @ v[0])
    step = 1e-4
    before, after = state(t - step), state(t + step)
    gained = kinetic(*after[:2]) + potential(after[0]) - kinetic(*before[:2]) - potential(before[0])
    np.testing.assert_allclose(power, gained / (2.0 * step), rtol=1e-5)
