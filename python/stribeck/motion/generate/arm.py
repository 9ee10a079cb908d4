"""Rigid-body torques of a serial arm: the recursive Newton-Euler equations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GRAVITY = 9.80665
#: A joint turns about the z axis of the frame before it.
AXIS = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Arm:
    """A serial arm of revolute joints in standard Denavit-Hartenberg form, arrays [joints].

    Links are point masses at their centres of mass, and the rotor of each motor adds a constant
    inertia to its joint. Gravity, coupling of the joints, centrifugal and Coriolis torques are
    included; the inertia of the links about their centres is not.

    Attributes
    ----------
    length, offset, twist
        Denavit-Hartenberg a [m], d [m] and alpha [rad].
    mass
        kg.
    centre
        Centre of mass in the link's own frame, m, array [joints, 3].
    rotor_inertia
        Inertia of motor and reducer at the joint, kg m2.

    Examples
    --------
    >>> pendulum = Arm(*(np.array([x]) for x in (1.0, 0.0, 0.0, 2.0, [0.0, 0.0, 0.0], 0.0)))
    >>> pendulum.load_torque(np.zeros((1, 1)), np.zeros((1, 1)), np.ones((1, 1)))
    array([[2.]])
    """

    length: Array
    offset: Array
    twist: Array
    mass: Array
    centre: Array
    rotor_inertia: Array

    def load_torque(self, position: Array, velocity: Array, acceleration: Array) -> Array:
        """Torque that moves the arm without friction: M(q) a + C(q, v) v + g(q).

        Parameters
        ----------
        position, velocity, acceleration : array [n, joints]
            rad, rad/s, rad/s2. The first axis is vertical.

        Returns
        -------
        array [n, joints]
            N m.
        """
        rotations = [self._rotation(k, position[:, k]) for k in range(self.mass.size)]
        forces = self._inertial_forces(rotations, velocity, acceleration)
        return self._joint_torques(rotations, forces) + self.rotor_inertia * acceleration

    def _rotation(self, k: int, angle: Array) -> Array:
        """Axes of link k's frame in the frame before it, array [n, 3, 3]."""
        c, s = np.cos(angle), np.sin(angle)
        ca, sa = np.cos(self.twist[k]), np.sin(self.twist[k])
        zero = np.zeros_like(c)
        rows = [[c, -s * ca, s * sa], [s, c * ca, -c * sa], [zero, zero + sa, zero + ca]]
        return np.moveaxis(np.array(rows), 2, 0)

    def _reach(self, k: int) -> Array:
        """Vector from the frame before link k to that of link k, in the latter, m."""
        across, along = (
            self.offset[k] * np.sin(self.twist[k]),
            self.offset[k] * np.cos(self.twist[k]),
        )
        return np.array([self.length[k], across, along])

    def _inertial_forces(self, rotations: list[Array], v: Array, a: Array) -> list[Array]:
        """Mass times acceleration of each link in its own frame, gravity included, [n, 3] each."""
        spin = np.zeros((len(v), 3))
        spin_rate = np.zeros((len(v), 3))
        # Gravity acts like an upward acceleration of the base.
        push = np.tile(GRAVITY * AXIS, (len(v), 1))
        forces = []
        for k, rotation in enumerate(rotations):
            turn, turn_rate = v[:, k, None] * AXIS, a[:, k, None] * AXIS
            spin_rate = _into(rotation, spin_rate + turn_rate + np.cross(spin, turn))
            spin = _into(rotation, spin + turn)
            push = _into(rotation, push) + _centripetal(spin, spin_rate, self._reach(k))
            forces.append(self.mass[k] * (push + _centripetal(spin, spin_rate, self.centre[k])))
        return forces

    def _joint_torques(self, rotations: list[Array], forces: list[Array]) -> Array:
        """Torque of each joint about its axis that balances the forces beyond it, [n, joints]."""
        force = np.zeros_like(forces[0])
        moment = np.zeros_like(forces[0])
        torques = np.empty((len(force), len(rotations)))
        for k in reversed(range(len(rotations))):
            if k + 1 < len(rotations):
                force, moment = _out_of(rotations[k + 1], force), _out_of(rotations[k + 1], moment)
            reach = self._reach(k)
            moment = moment + np.cross(reach, force) + np.cross(reach + self.centre[k], forces[k])
            force = force + forces[k]
            torques[:, k] = np.einsum("ni,ni->n", _out_of(rotations[k], moment), AXIS[None, :])
        return torques


def _into(rotation: Array, vector: Array) -> Array:
    """Vectors [n, 3] of the outer frame in the inner frame."""
    return np.einsum("nij,ni->nj", rotation, vector)


def _out_of(rotation: Array, vector: Array) -> Array:
    """Vectors [n, 3] of the inner frame in the outer frame."""
    return np.einsum("nij,nj->ni", rotation, vector)


def _centripetal(spin: Array, spin_rate: Array, arm: Array) -> Array:
    """Acceleration of a point at `arm` of a rotating body, m/s2, array [n, 3]."""
    return np.cross(spin_rate, arm) + np.cross(spin, np.cross(spin, arm))
