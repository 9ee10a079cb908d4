"""Base parameters: the combinations of inertial parameters on which torques depend.

Gautier and Khalil, IEEE Trans. Robotics and Automation 6(3), 1990; Gautier, J. Robotic Systems
8(4), 1991 (by pivoted QR of a regressor at random motions).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.robot.arm import PARAMETERS, Robot

Array = NDArray[np.float64]

#: Random states at which the structure of the regressor is found.
STATES = 400
#: A column, or what is new in it, below this share of the largest does not count.
NOTHING = 1e-8
#: Coefficients of a combination below this share are rounding.
SHOWN = 1e-6


@dataclass(frozen=True)
class BaseParameters:
    """The combinations of a robot's inertial parameters that its torques can show.

    Attributes
    ----------
    chosen : int array [b]
        Columns of the regressor that span all of them.
    mapping : array [b, 11 N]
        Base parameters are this matrix times the inertial parameters.
    """

    robot: Robot
    chosen: NDArray[np.intp]
    mapping: Array

    @classmethod
    def of(cls, robot: Robot) -> BaseParameters:
        """Find them at random states, whatever the motion of a recording."""
        random = np.random.default_rng(0)
        count = len(robot.joints)
        position, velocity, acceleration = random.uniform(-3.0, 3.0, (3, STATES, count))
        matrix = robot.regressor(position, velocity, acceleration).reshape(STATES * count, -1)
        size = np.sqrt(np.einsum("ij,ij->j", matrix, matrix))
        acts = np.flatnonzero(size > NOTHING * size.max())
        scaled = matrix[:, acts] / size[acts]
        order = linear.pivots(scaled)
        weights = linear.singular(scaled)[0]
        rank = int((weights > NOTHING * weights.max()).sum())
        chosen = np.sort(order[:rank])
        others = np.setdiff1d(np.arange(acts.size), chosen)
        mapping = np.zeros((rank, matrix.shape[1]))
        mapping[np.arange(rank), acts[chosen]] = 1.0
        for k in others:
            part = linear.least_norm(scaled[:, chosen], scaled[:, k])
            mapping[:, acts[k]] = part * size[acts[k]] / size[acts[chosen]]
        mapping[np.abs(mapping) < SHOWN * np.abs(mapping).max()] = 0.0
        return cls(robot, acts[chosen], mapping)

    @property
    def count(self) -> int:
        """Number of base parameters."""
        return int(self.chosen.size)

    @cached_property
    def texts(self) -> tuple[str, ...]:
        """Each combination in the inertial parameters, such as ``"my_3 + 0.5 m_4"``."""
        names = parameter_names(self.robot)
        return tuple(
            _combination(row, names, own)
            for row, own in zip(self.mapping, self.chosen, strict=True)
        )

    @property
    def units(self) -> tuple[str, ...]:
        """Unit of each base parameter."""
        return tuple(PARAMETERS[k % len(PARAMETERS)][1] for k in self.chosen)

    @property
    def not_shown(self) -> tuple[str, ...]:
        """Inertial parameters on which no torque depends."""
        names = parameter_names(self.robot)
        return tuple(n for n, column in zip(names, self.mapping.T, strict=True) if not column.any())


def parameter_names(robot: Robot) -> list[str]:
    """Names of the inertial parameters of all links: symbol and joint."""
    return [f"{symbol}_{joint.name}" for joint in robot.joints for symbol, _ in PARAMETERS]


def _combination(row: Array, names: list[str], own: int) -> str:
    """A row of the mapping as a sum, its own parameter first."""
    text = names[own]
    for k in np.flatnonzero(row):
        if k != own:
            factor = abs(float(row[k]))
            times = "" if abs(factor - 1.0) < SHOWN else f"{factor:.4g} "
            text += f" {'+' if row[k] > 0 else '-'} {times}{names[k]}"
    return text
