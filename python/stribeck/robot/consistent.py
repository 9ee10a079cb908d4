"""Inertial parameters that a body of positive mass density has.

They are those whose pseudo-inertia (4 x 4: second moments, first moments, mass) is positive
definite (Wensing, Kim, Slotine, IEEE Robotics and Automation Letters 3(1), 2018), written by its
log-Cholesky factors (Rucker, Wensing, same journal 7(2), 2022), so that no constraint remains.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.identify.triangle import Triangle
from stribeck.robot.arm import PARAMETERS, Robot

if TYPE_CHECKING:
    from stribeck.robot.estimates import Errors
    from stribeck.robot.solve import Solved

Array = NDArray[np.float64]

#: A link of which nothing is known: a ball of this mass (kg) and radius of gyration (m).
MASS, GYRATION = 2.0, 0.1
#: A rotor of which nothing is known, kg m2 or kg.
ROTOR = 0.01
#: Weight of the distance from what is known before, in standard deviations of the residual.
PRIOR = 1e-2
#: Base parameters of the bodies lie within so many standard errors of the identified ones.
WITHIN = 3.0
#: Logarithms of the factors change by at most this much: nothing overflows.
FARTHEST = 12.0
_FOUR, _ABOVE = np.arange(4), np.triu_indices(4, 1)


@dataclass(frozen=True)
class Bodies:
    """Links of positive mass density whose torques are nearest to the identified ones.

    Attributes
    ----------
    parameters : array [N, 11]
        Inertial parameters of each link and rotor inertia of its drive. Those on which no torque
        depends are near what the description of the robot states.
    consistent
        Whether their base parameters agree with the identified ones within the errors.
    deviation
        Largest difference of a base parameter, in standard errors.
    """

    robot: Robot
    parameters: Array
    consistent: bool
    deviation: float

    def to_dict(self) -> list[dict[str, object]]:
        """One row per link, by symbol."""
        symbols = [symbol for symbol, _ in PARAMETERS]
        return [
            {"joint": joint.name, **dict(zip(symbols, map(float, row), strict=True))}
            for joint, row in zip(self.robot.joints, self.parameters, strict=True)
        ]


def consistent_bodies(solved: Solved, errors: Errors) -> Bodies:
    """The bodies nearest to the identified base parameters, in the sense of the torques."""
    base = solved.balance.base
    robot, count = base.robot, len(base.robot.joints)
    root = _of_base(solved)
    target = root @ solved.values.base[: base.count]
    known = [_known(joint.inertial) for joint in robot.joints]
    rotors = np.array([joint.rotor for joint in robot.joints])
    start = np.concatenate([*known, np.log(np.maximum(rotors, ROTOR))])
    _, left, _ = solved.stacked()
    weight = PRIOR * linear.length(left)

    prior = weight / np.sqrt(start.size)
    shown = root @ base.mapping

    def parameters(x: Array) -> Array:
        links = inertial_of(x[: 10 * count].reshape(count, 10))
        return np.column_stack([links, np.exp(x[10 * count :])])

    def residual(x: Array) -> Array:
        return np.concatenate([shown @ parameters(x).ravel() - target, prior * (x - start)])

    def jacobian(x: Array) -> Array:
        slopes = _slopes(x[: 10 * count].reshape(count, 10))
        by_link = shown.reshape(-1, count, 11)
        by_factors = np.einsum("ijk,jlk->ijl", by_link[:, :, :10], slopes).reshape(-1, 10 * count)
        by_rotors = by_link[:, :, 10] * np.exp(x[10 * count :])
        return np.vstack([np.hstack([by_factors, by_rotors]), prior * np.eye(x.size)])

    found = scipy.optimize.least_squares(
        residual,
        start,
        jacobian,
        bounds=(start - FARTHEST, start + FARTHEST),
        x_scale=0.1,
        max_nfev=200,
    )
    made = parameters(found.x)
    apart = base.mapping @ made.ravel() - solved.values.base[: base.count]
    error = np.array([row.stderr for row in errors.base])
    deviation = float(np.max(np.abs(apart) / np.where(error > 0.0, error, np.inf)))
    return Bodies(robot, made, deviation <= WITHIN, deviation)


def _of_base(solved: Solved) -> Array:
    """Factor [b, b] of the information on the base parameters, friction left free."""
    jacobian, residual, _ = solved.stacked()
    count = solved.balance.base.count
    order = np.concatenate([np.arange(count, jacobian.shape[1]), np.arange(count)])
    factor = Triangle.of(np.ascontiguousarray(jacobian[:, order]), residual).factor
    return factor[-count:, -count:]


def pseudo_inertia(parameters: Array) -> Array:
    """Pseudo-inertia [4, 4] of the ten inertial parameters of a body.

    Examples
    --------
    >>> ball = np.array([2.0, 0.0, 0.0, 0.0, 0.2, 0.0, 0.2, 0.0, 0.0, 0.2])
    >>> pseudo_inertia(ball).round(12).diagonal()
    array([0.1, 0.1, 0.1, 2. ])
    """
    mass, x, y, z, xx, xy, yy, xz, yz, zz = parameters
    half = 0.5 * (xx + yy + zz)
    return np.array(
        [
            [half - xx, -xy, -xz, x],
            [-xy, half - yy, -yz, y],
            [-xz, -yz, half - zz, z],
            [x, y, z, mass],
        ]
    )


def inertial_of(logarithms: Array) -> Array:
    """Ten inertial parameters [..., 10] from log-Cholesky factors [..., 10]: always of a body."""
    upper = _factors(logarithms)
    return _of_moments(upper @ np.swapaxes(upper, -1, -2))


def _factors(logarithms: Array) -> Array:
    """Upper factors [..., 4, 4] of the pseudo-inertia."""
    upper = np.zeros((*logarithms.shape[:-1], 4, 4))
    upper[..., _FOUR, _FOUR] = np.exp(logarithms[..., :4])
    upper[..., _ABOVE[0], _ABOVE[1]] = logarithms[..., 4:]
    return upper


def _slopes(logarithms: Array) -> Array:
    """Derivatives [n, 10, 10] of `inertial_of` [n, 10], by the factor in the second axis."""
    upper = _factors(logarithms)
    moved = np.zeros((len(upper), 10, 4, 4))
    moved[:, _FOUR, _FOUR, _FOUR] = np.exp(logarithms[:, :4])
    moved[:, 4 + np.arange(6), _ABOVE[0], _ABOVE[1]] = 1.0
    half = moved @ np.swapaxes(upper, -1, -2)[:, None]
    return _of_moments(half + np.swapaxes(half, -1, -2))


def _of_moments(moments: Array) -> Array:
    """Ten inertial parameters of pseudo-inertias [..., 4, 4]; linear."""
    second = moments[..., :3, :3]
    trace = np.trace(second, axis1=-2, axis2=-1)[..., None, None]
    inertia = trace * np.eye(3) - second
    rows, columns = [0, 0, 1, 0, 1, 2], [0, 1, 1, 2, 2, 2]
    parts = [moments[..., 3, 3, None], moments[..., :3, 3], inertia[..., rows, columns]]
    return np.concatenate(parts, axis=-1)


def _known(inertial: Array | None) -> Array:
    """Log-Cholesky factors [10] of a link as it is described, or of a ball."""
    moments = np.diag([MASS * GYRATION**2 / 2.0] * 3 + [MASS])
    if inertial is not None:
        stated = pseudo_inertia(inertial)
        values, vectors = linear.symmetric_eigen(stated)
        if values.max() > 0.0:
            moments = (vectors * np.maximum(values, 1e-6 * values.max())) @ vectors.T
    # An upper factor is the lower one of the matrix with rows and columns reversed.
    upper = np.linalg.cholesky(moments[::-1, ::-1])[::-1, ::-1]
    return np.concatenate([np.log(np.diag(upper)), upper[np.triu_indices(4, 1)]])
