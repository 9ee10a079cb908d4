"""Friction that varies along the stroke as the load torque on the gear does.

The load torque at the joint holds the inertia of the rotor, which is on the other side of the gear.
Where that is large, the load effect fits worse than friction that varies along the stroke.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.effect.base import Identified
from stribeck.models.rigid_body import load_torque

Array = NDArray[np.float64]

#: Parts of the stroke in which the load torque is averaged.
PARTS = 40
#: Share of the variance along the stroke from which friction follows the load torque there.
FOLLOWS = 0.95


def friction_by_load(fit: Identified) -> float | None:
    """Dry friction for each unit of load torque, where it follows that along the stroke.

    None where it does not, or where no load torque is known.
    """
    r, m = fit.recording, fit.model
    load = load_torque(m, r)
    if load is None or r.position is None:
        return None
    place = r.position[fit.rows]
    if m.constants["position_periodic"]:
        place = np.mod(place, m.constants["position_length"])
    part = np.digitize(place, np.linspace(place.min(), place.max(), PARTS + 1)[1:-1])
    acceleration = None if r.acceleration is None else r.acceleration[fit.rows]
    size = np.abs(_without_inertia(load[fit.rows], acceleration, part))
    weight = np.bincount(part)
    top = max(abs(x) for x in m.box["velocity"])
    dry = m.split(top, position=_means(place, part))["dry"]
    size, dry = (x - np.average(x, weights=weight) for x in (size, dry))
    square, along, total = (float(weight @ x) for x in (size * size, size * dry, dry * dry))
    follows = along > 0.0 and along * along >= FOLLOWS * square * total
    return along / square if follows else None


def _means(values: Array, part: NDArray[np.intp]) -> Array:
    """Mean of `values` [m] in each part, 0 where it has no samples."""
    return np.bincount(part, values) / np.maximum(np.bincount(part), 1)


def _without_inertia(load: Array, acceleration: Array | None, part: NDArray[np.intp]) -> Array:
    """Mean load torque of each part of the stroke, without what follows the acceleration there."""
    mean = _means(load, part)
    if acceleration is None:
        return mean
    level = _means(acceleration, part)
    apart = acceleration - level[part]
    square = float(apart @ apart)
    inertia = float(apart @ (load - mean[part])) / square if square > 0.0 else 0.0
    return mean - inertia * level
