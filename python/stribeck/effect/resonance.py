"""Resonance of a drive train: the oscillation of the load torque that a residual shows best.

A drive train that is stiff for the motion twists by the load torque; one that is not oscillates.
Both are the second derivative of the torque of its spring, which follows the load torque at once or
behind a resonance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.recording.derive import Smoother
from stribeck.recording.motion.spring_torque import Resonance
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Lowest frequency of a drive train, Hz, and fewest samples in a period.
LOWEST, FEWEST_SAMPLES = 2.0, 4.0
#: From one frequency to the next: a third of the width of a resonance that is damped by a tenth.
RATIO = 1.08
#: Shares of critical damping.
DAMPINGS = (0.03, 0.07, 0.15, 0.3)
#: Most samples that are compared.
SAMPLES = 6000
#: Largest share of the load torque that oscillates; more than one only by error.
LARGEST_SHARE = 1.2
#: It explains so many times what a drive train that follows at once does.
MORE = 1.5
#: Share of the largest eigenvalue below which columns depend on each other.
UNSEEN = 1e-10

#: A drive train that follows the load torque at once.
NONE = Resonance(damping=DAMPINGS[0])


def resonances(recording: Recording) -> list[Resonance]:
    """Those of linear springs that the samples resolve."""
    highest = recording.rate_hz / FEWEST_SAMPLES
    if recording.load_torque is None or recording.averaged or highest <= LOWEST:
        return []
    frequencies = [LOWEST]
    while frequencies[-1] * RATIO <= highest:
        frequencies.append(frequencies[-1] * RATIO)
    return [
        Resonance(1.0 / frequency, damping) for frequency in frequencies for damping in DAMPINGS
    ]


@dataclass(frozen=True)
class Shown:
    """What a residual shows of drive trains, beyond simpler causes.

    Simpler are dry and viscous friction, and a load torque on another scale or late.

    Attributes
    ----------
    rest : array [m]
        The residual beyond simpler causes.
    basis : array [m, k]
        Orthonormal columns of the simpler causes.
    """

    recording: Recording
    rows: NDArray[np.intp]
    rest: Array
    basis: Array

    @classmethod
    def of(cls, recording: Recording, residual: Array | None) -> Shown | None:
        """That of a residual; default: of Coulomb and viscous friction. None without samples."""
        rows = np.flatnonzero(recording.moving)
        if rows.size == 0:
            return None
        rows = rows[:: -(-rows.size // SAMPLES)]
        basis = _simpler(recording, rows)
        given = recording.torque - recording.known_torque if residual is None else residual
        return cls(recording, rows, beyond(basis, given[rows, None])[:, 0], basis)

    def explained(self, shapes: Array) -> tuple[Array, Array]:
        """What columns of torque [m, k], beyond simpler causes, explain of the rest.

        Returns
        -------
        gains, factors : array [k]
            Falls of the sum of squares, and factors of the columns.
        """
        sizes, along = np.einsum("nk,nk->k", shapes, shapes), shapes.T @ self.rest
        factors = np.divide(along, sizes, out=np.zeros_like(along), where=sizes > 0.0)
        return factors * along, factors


def is_possible(frequency: Array, factor: Array) -> NDArray[np.bool_]:
    """Whether no more than the load torque oscillates, at a frequency in rad/s."""
    carried = -factor * frequency**2
    return np.asarray((carried > 0.0) & (carried <= LARGEST_SHARE))


def best_resonance(recording: Recording, residual: Array | None = None) -> Resonance:
    """The oscillation on a linear spring that explains most.

    `NONE` where a drive train that follows at once explains as much.

    Parameters
    ----------
    residual : array [n]
        Residual of a model; default: of Coulomb and viscous friction.
    """
    forms = resonances(recording)
    shown = Shown.of(recording, residual) if forms else None
    if shown is None:
        return NONE
    gains, factors = shown.explained(_shapes(recording, forms, shown))
    frequencies = np.array([2.0 * np.pi / form.period for form in forms])
    possible = is_possible(frequencies, factors[1:])
    if not possible.any():
        return NONE
    best = int(np.argmax(np.where(possible, gains[1:], -1.0)))
    return forms[best] if gains[1 + best] > MORE * gains[0] else NONE


def _simpler(recording: Recording, rows: NDArray[np.intp]) -> Array:
    """Orthonormal columns [m, k] of causes that are simpler than a drive train that twists."""
    name = "causes simpler than springs"
    if name not in recording.kept:
        load = recording.denoised("load_torque")
        rate = Smoother(recording.time, recording.segment, None).smooth(load, 1)
        v = recording.velocity
        simpler = [np.sign(v), v, np.ones_like(v), load, rate]
        recording.kept[name] = _basis(np.column_stack(simpler)[rows])
    return recording.kept[name]


def _shapes(recording: Recording, forms: list[Resonance], shown: Shown) -> Array:
    """The torque of each form [m, k] beyond simpler causes, that of none first."""
    name = "torque of springs"
    if name not in recording.kept:
        made = (form.curvature(recording) for form in (NONE, *forms))
        columns = np.column_stack([torque[shown.rows] for torque in made if torque is not None])
        recording.kept[name] = beyond(shown.basis, columns)
    return recording.kept[name]


def _basis(columns: Array) -> Array:
    """Orthonormal columns of the same span."""
    scaled = columns / np.maximum(np.sqrt(np.mean(columns**2, axis=0)), np.finfo(float).tiny)
    values, vectors = linear.symmetric_eigen(scaled.T @ scaled)
    seen = values > UNSEEN * values.max()
    return np.asarray(scaled @ vectors[:, seen] / np.sqrt(values[seen]))


def beyond(basis: Array, values: Array) -> Array:
    """Each column of `values` without what the basis explains of it."""
    return np.asarray(values - basis @ (basis.T @ values))
