"""Noise floor: the error that no function of the recorded channels explains.

Nearest neighbours in state space are far apart in time, so that their noise is independent. Half of
their mean squared difference is the noise variance plus what the function changes between them. An
extrapolation to zero distance removes the latter (the Gamma test, Stefansson, Koncar and Jones
1997).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base.pool import threads
from stribeck.diagnosis.residual.lasting import STRUCTURE, lasting_square
from stribeck.effect.columns import displacement_since_reversal
from stribeck.fitting.result import Fit
from stribeck.identify.errors.covariance import correlation_length
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Neighbours of which one must be far in time. Most have one among the first few.
NEIGHBOURS, FIRST_NEIGHBOURS = 40, 4
FEWEST_PAIRS = 300
#: An error above this multiple of the noise floor is more than noise.
REACHED = 1.5
#: Correlation length in samples from which a residual is smooth in time.
SMOOTH = 10.0
#: A noise floor above this share of the error says that no state explains any of it. If much of the
#: residual lasts all the same, it is no noise.
AS_LARGE = 0.9
#: Travel in strokes below which hardly any position is passed twice.
ONCE = 1.5
#: Turns from which the angle within a turn is a state of its own.
TURNS = 2.0


@dataclass(frozen=True)
class NoiseFloor:
    """An estimate in the unit of torque, or None and why."""

    value: float | None
    why: str | None = None

    def is_reached_by(self, rmse: float) -> bool:
        """Whether an error may be noise: repetitions of a state differ hardly less."""
        return self.value is not None and rmse <= REACHED * self.value


def noise_floor(fit: Fit) -> NoiseFloor:
    """Estimate the noise floor from the residual of `fit`, the best model at hand.

    The model explains most of the torque, so that neighbours need not be very close.
    """
    rows = fit.rows
    residual = fit.residual[rows]
    if residual.size < FEWEST_PAIRS:
        return NoiseFloor(None, f"too few moving samples ({residual.size}) to compare repetitions")
    lasting = correlation_length(residual)
    if lasting > SMOOTH and _passes_once(fit):
        why = (
            "the residual is smooth in time and the joint passes no position twice, so that slow "
            "noise is indistinguishable from a torque that varies along the stroke"
        )
        return NoiseFloor(None, why)
    features = state_features(fit, rows)
    step = -(-residual.size // 20000)
    index = np.arange(0, residual.size, step)
    apart = max(4.0 * lasting, 20.0) / step
    pick, neighbour, distance = _far_neighbours(features[index], apart)
    if pick.size < FEWEST_PAIRS:
        return NoiseFloor(None, "the motion does not pass the same state twice")
    gap = distance**2
    gamma = (residual[index[pick]] - residual[index[neighbour]]) ** 2 / 2.0
    # The nearest half says most about zero distance.
    near = gap <= np.median(gap)
    found = float(min(np.sqrt(_at_zero(gap[near], gamma[near])), fit.rmse))
    if found > AS_LARGE * fit.rmse and lasting_square(fit) > STRUCTURE * fit.rmse**2:
        why = (
            "repeats of the same state differ as much as any two samples, and yet the residual is "
            "no noise, since it lasts. Its cause is not recorded (the motion of other joints, for "
            "example)"
        )
        return NoiseFloor(None, why)
    return NoiseFloor(found)


def _far_neighbours(
    points: Array, apart: float
) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """The points with a neighbour more than `apart` rows away, the nearest such, its distance."""
    tree = scipy.spatial.cKDTree(points)
    neighbour = np.full(len(points), -1, dtype=np.intp)
    distance = np.full(len(points), np.inf)
    for count in (FIRST_NEIGHBOURS, NEIGHBOURS):
        left = np.flatnonzero(neighbour < 0)
        gaps, near = tree.query(points[left], k=count + 1, workers=threads())
        far = np.abs(near - left[:, None]) > apart
        first = np.argmax(far, axis=1)
        found = np.flatnonzero(far[np.arange(left.size), first])
        neighbour[left[found]] = near[found, first[found]]
        distance[left[found]] = gaps[found, first[found]]
    pick = np.flatnonzero(neighbour >= 0)
    return pick, neighbour[pick], distance[pick]


def _passes_once(fit: Fit) -> bool:
    """Whether the joint moves at most along its stroke and half of the way back.

    Over several turns it passes each angle once a turn.
    """
    r = fit.recording
    if r.position is None:
        return False
    stroke = float(np.ptp(r.position[r.moving]))
    if r.joint_kind == "revolute" and stroke >= TURNS * 2.0 * np.pi:
        return False
    travel = float(np.sum(np.abs(r.velocity[r.moving]) * r.dt[r.moving]))
    return travel < ONCE * stroke


def _at_zero(gap: Array, gamma: Array) -> float:
    """`gamma` at zero gap: from a line where it clearly rises with the gap, else its mean."""
    mean = float(gamma.mean())
    if np.ptp(gap) == 0:
        return mean
    (slope, intercept), covariance = np.polyfit(gap, gamma, 1, cov=True)
    if slope > 3.0 * np.sqrt(covariance[0, 0]) and intercept > 0:
        return float(intercept)
    return mean


def _angle_in_turn(r: Recording, rows: NDArray[np.intp]) -> list[Array]:
    """Cosine and sine of a joint that turns round and round: a ripple repeats with each turn."""
    if r.position is None or r.joint_kind != "revolute":
        return []
    if np.ptp(r.position[rows]) < TURNS * 2.0 * np.pi:
        return []
    return [np.cos(r.position[rows]), np.sin(r.position[rows])]


def state_features(fit: Fit, rows: NDArray[np.intp]) -> Array:
    """The channels that friction may depend on, scaled to unit variance, array [m, k]."""
    r = fit.recording
    v = r.velocity[rows]
    load = r.load_torque if r.load_torque is not None else fit.load
    travel = displacement_since_reversal(r)[rows]
    channels: list[Array | None] = [
        v,
        r.position[rows] if r.position is not None else None,
        r.acceleration[rows] if r.acceleration is not None else None,
        r.temperature[rows] if r.temperature is not None else None,
        load[rows] if load is not None else None,
        np.sqrt(travel),
        *_angle_in_turn(r, rows),
    ]
    scaled = [(c - c.mean()) / c.std() for c in channels if c is not None and c.std() > 1e-12]
    # Opposite directions are different states, at any speed.
    scaled.append(3.0 * np.sign(v))
    return np.column_stack(scaled)
