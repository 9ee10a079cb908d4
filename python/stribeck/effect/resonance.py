"""Resonance of a drive train: the oscillation of the load torque that a residual shows best.

A drive train that is stiff for the motion twists by the load torque; one that is not oscillates.
Both are the second derivative of the torque of its spring, which follows the load torque at once or
behind a resonance.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.recording.derive import Smoother
from stribeck.recording.recording import Recording
from stribeck.recording.spring_torque import spring_torque_curvature

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


def resonances(recording: Recording) -> list[tuple[float, float]]:
    """Periods, s, and shares of critical damping that the samples resolve."""
    highest = recording.rate_hz / FEWEST_SAMPLES
    if recording.load_torque is None or recording.averaged or highest <= LOWEST:
        return []
    frequencies = [LOWEST]
    while frequencies[-1] * RATIO <= highest:
        frequencies.append(frequencies[-1] * RATIO)
    return [(1.0 / frequency, damping) for frequency in frequencies for damping in DAMPINGS]


def best_resonance(recording: Recording, residual: Array | None = None) -> tuple[float, float]:
    """Period, s, and share of critical damping of the oscillation that explains most.

    Parameters
    ----------
    residual : array [n]
        Residual of a model; default: of Coulomb and viscous friction.

    Returns
    -------
    tuple of float
        A period of 0 where a drive train that follows at once explains as much.
    """
    forms = resonances(recording)
    rows = np.flatnonzero(recording.moving)
    if not forms or rows.size == 0:
        return 0.0, DAMPINGS[0]
    rows = rows[:: -(-rows.size // SAMPLES)]
    shapes, basis = _shapes(recording, forms, rows)
    given = recording.torque - recording.known_torque if residual is None else residual
    rest = _beyond(basis, given[rows, None])[:, 0]
    sizes, along = np.einsum("nk,nk->k", shapes, shapes), shapes.T @ rest
    known = sizes > 0.0
    shares = np.divide(along, sizes, out=np.zeros_like(along), where=known)
    gains = shares * along
    frequencies = np.array([2.0 * np.pi / period for period, _ in forms])
    carried = -shares[1:] * frequencies**2
    possible = (carried > 0.0) & (carried <= LARGEST_SHARE)
    if not possible.any():
        return 0.0, DAMPINGS[0]
    best = int(np.argmax(np.where(possible, gains[1:], -1.0)))
    if gains[1 + best] <= MORE * gains[0]:
        return 0.0, DAMPINGS[0]
    return forms[best]


def _shapes(
    recording: Recording, forms: list[tuple[float, float]], rows: NDArray[np.intp]
) -> tuple[Array, Array]:
    """The torque of each form beyond simpler causes, that of none first, and a basis of these.

    Simpler are dry and viscous friction, and a load torque on another scale or late.
    """
    name = "torque of springs"
    if name not in recording.kept:
        load = recording.denoised("load_torque")
        rate = Smoother(recording.time, recording.segment, None).smooth(load, 1)
        v = recording.velocity
        basis = _basis(np.column_stack([np.sign(v), v, np.ones_like(v), load, rate])[rows])
        made = (
            spring_torque_curvature(recording, period=period, damping=damping)
            for period, damping in [(0.0, DAMPINGS[0]), *forms]
        )
        columns = np.column_stack([torque[rows] for torque in made if torque is not None])
        recording.kept[name] = np.column_stack([_beyond(basis, columns), basis])
    kept = recording.kept[name]
    return kept[:, : 1 + len(forms)], kept[:, 1 + len(forms) :]


def _basis(columns: Array) -> Array:
    """Orthonormal columns of the same span."""
    scaled = columns / np.maximum(np.sqrt(np.mean(columns**2, axis=0)), np.finfo(float).tiny)
    values, vectors = linear.symmetric_eigen(scaled.T @ scaled)
    seen = values > UNSEEN * values.max()
    return np.asarray(scaled @ vectors[:, seen] / np.sqrt(values[seen]))


def _beyond(basis: Array, values: Array) -> Array:
    """Each column of `values` without what the basis explains of it."""
    return np.asarray(values - basis @ (basis.T @ values))
