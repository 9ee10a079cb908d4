"""Friction that changes steadily along a recording, without a thermometer that could say why.

The parts of a fitted model may each change in proportion to time: dry friction, friction that grows
with speed, and the load torque of inertia and gravity. Lubricant that warms changes friction alone.
Magnets that warm, or an amplifier, change the motor torque of every part by the same share.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.base.errors import StribeckError
from stribeck.diagnosis.carrying import FEWEST_MOVES, fewest
from stribeck.diagnosis.least_fall import LEAST_FALL
from stribeck.fitting.result import Fit
from stribeck.identify.errors.covariance import batches, correlation_length, covariance_of
from stribeck.identify.errors.estimates import APART
from stribeck.identify.figures import rms
from stribeck.identify.problem import Problem
from stribeck.models.parts import friction_parts
from stribeck.recording.motion.moves import moves
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Names of the parts.
DRY, VISCOUS, LOAD = "dry friction", "viscous friction", "load"
#: Significance level of a trend, over all parts together.
SIGNIFICANCE = 0.001
#: Standard errors within which shares of change are the same.
SAME = 2.0
#: A part with a smaller share of the torque says nothing about a change of its own.
LEAST_PART = 0.02
#: Rank correlation of the size of the moves with time from which the motion changes steadily.
STEADY = 0.8
#: Of fewer moves that is chance.
FEWEST_RANKED = 8
#: Relative difference below which sizes are the same.
ROUNDING = 1e-9
#: A part that changes steadily by a larger share of its mean has another sign at one end.
LARGEST = 2.0


@dataclass(frozen=True)
class Change:
    """Change of one part from the start of a recording to its end, as a share of its mean."""

    share: float
    stderr: float
    clear: bool

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {"share": self.share, "stderr": self.stderr, "clear": self.clear}


@dataclass(frozen=True)
class Trend:
    """Parts of a model that change steadily along a recording.

    Attributes
    ----------
    seconds
        Duration of the recording.
    changes
        By part, ``"dry friction"``, ``"viscous friction"`` and ``"load"``; `clear` where the change
        is significant.
    fall
        Relative fall of the RMSE with these changes.
    cause : {"gain", "load", "zero", "friction"}
        ``"gain"`` where the load changes, and friction by the same share; ``"load"`` where the load
        alone changes clearly; ``"zero"`` where a drifting zero of the torque explains that as well.
    """

    seconds: float
    changes: Mapping[str, Change]
    fall: float
    cause: str

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "seconds": self.seconds,
            "changes": {name: change.to_dict() for name, change in self.changes.items()},
            "fall": self.fall,
            "cause": self.cause,
            "indistinguishable_from": ["temperature", "drift"] if self.cause == "friction" else [],
        }


def trend(fitted: Fit) -> Trend | None:
    """The trend that `fitted` leaves; None where there is none, or a temperature was recorded.

    The model is linearised, and each part multiplied by time is added to it. Nothing is said where
    fewer than five moves carry the change, a part would change its sign, or the motion itself
    changes steadily, as in a sweep of the frequency.
    """
    r = fitted.recording
    if r.temperature is not None or r.averaged or "drift" in fitted.model.effects:
        return None
    if _motion_changes(r):
        return None
    try:
        parts = _parts(fitted)
        problem = Problem(r, fitted.model, fitted.rows, fitted.load)
        _, jacobian = problem.linearise(fitted.model.values)
    except StribeckError:
        return None
    seconds = float(r.elapsed[-1] - r.elapsed[0])
    if DRY not in parts or not seconds > 0.0:
        return None
    share = (r.elapsed[fitted.rows] - r.elapsed[0]) / seconds - 0.5
    # A known load has no parameter of its own; its scale may be wrong throughout.
    known = [parts[LOAD]] if r.load_torque is not None and LOAD in parts else []
    columns = np.column_stack([jacobian, *known, *(part * share for part in parts.values())])
    found = _found(fitted, columns, list(parts), seconds)
    if found is None or found.cause != "load":
        return found
    base = columns[:, : columns.shape[1] - len(parts)]
    with_zero = np.column_stack([base, np.ones_like(share), share])
    return (
        replace(found, cause="zero") if _Solved.of(fitted, with_zero).fall >= found.fall else found
    )


def _motion_changes(recording: Recording) -> bool:
    """Whether the speed or the acceleration of the moves rises or falls steadily with time.

    What depends on either is then indistinguishable from a trend.
    """
    move = moves(recording)
    rows = np.flatnonzero(recording.moving & (move >= 0))
    channels = [recording.velocity_smooth, recording.acceleration_smooth]
    count = np.bincount(move[rows])
    kept = count > 0
    sizes = [np.bincount(move[rows], c[rows] ** 2)[kept] / count[kept] for c in channels]
    if kept.sum() < FEWEST_RANKED:
        return False
    return any(abs(_rank_correlation(size)) > STEADY for size in sizes)


def _rank_correlation(sizes: Array) -> float:
    """Of sizes [k] with their order, -1..1 (Spearman); 0 where all are the same."""
    if np.ptp(sizes) <= ROUNDING * np.max(sizes):
        return 0.0
    rank = np.argsort(np.argsort(sizes, kind="stable"), kind="stable")
    return float(np.corrcoef(np.arange(sizes.size), rank)[0, 1])


def _found(fitted: Fit, columns: Array, names: list[str], seconds: float) -> Trend | None:
    """The trend in the last columns [m, p + k] of a linearised fit."""
    solved = _Solved.of(fitted, columns)
    scaled, size, values, left = solved.scaled, solved.size, solved.values, solved.left
    move = np.maximum(moves(fitted.recording)[fitted.rows], 0)
    gains = np.bincount(move, (solved.residual - left) ** 2).astype(np.float64)
    if solved.fall < LEAST_FALL or fewest(gains) < FEWEST_MOVES:
        return None
    batch = batches(left.size, correlation_length(left), fewest=20)
    free = np.ones(scaled.shape[1], dtype=bool)
    covariance, freedom = covariance_of(scaled, left, batch, free, APART)
    count = len(names)
    shares = values[-count:] / size[-count:]
    errors = np.sqrt(np.diag(covariance)[-count:]) / size[-count:]
    least = float(scipy.special.stdtrit(freedom, 1.0 - SIGNIFICANCE / 2.0 / count))
    clear = (errors > 0.0) & (np.abs(shares) > least * errors)
    if not clear.any() or np.any(np.abs(shares[clear]) > LARGEST):
        return None
    changes = {
        name: Change(float(share), float(error), bool(shown))
        for name, share, error, shown in zip(names, shares, errors, clear, strict=True)
    }
    return Trend(seconds, changes, solved.fall, _cause(changes))


@dataclass(frozen=True)
class _Solved:
    """Least squares of a fit's weighted residual [m] on columns of RMS one, without zero ones.

    `size` [k] is the RMS of every column, `left` what remains of the residual.
    """

    residual: Array
    scaled: Array
    size: Array
    values: Array
    left: Array

    @classmethod
    def of(cls, fitted: Fit, columns: Array) -> _Solved:
        """On columns [m, k], which are weighted as the residual is."""
        residual = fitted.weighted(fitted.residual[fitted.rows])
        weighted = np.column_stack([fitted.weighted(column) for column in columns.T])
        size = np.sqrt((weighted**2).mean(axis=0))
        scaled = weighted[:, size > 0.0] / size[size > 0.0]
        values = linear.least_norm(scaled, residual, 1e-8)
        return cls(residual, scaled, size, values, residual - scaled @ values)

    @property
    def fall(self) -> float:
        """Relative fall of the RMSE."""
        before = rms(self.residual)
        return 1.0 - rms(self.left) / before if before > 0.0 else 0.0


def _parts(fitted: Fit) -> dict[str, Array]:
    """Torque of each part on the samples fitted to, arrays [m]; without those that are small."""
    r, rows = fitted.recording, fitted.rows
    load = fitted.load_torque
    friction = friction_parts(fitted.model, r, load, rows)
    made = {
        DRY: np.sign(r.velocity[rows]) * friction["dry"],
        VISCOUS: friction["rate"],
    }
    if load is not None and (r.load_torque is None or r.torque_holds_load):
        made[LOAD] = load[rows]
    whole = rms(r.torque[rows])
    return {name: part for name, part in made.items() if rms(part) > LEAST_PART * whole}


def _cause(changes: Mapping[str, Change]) -> str:
    """What the parts that change have in common."""
    load = changes.get(LOAD)
    if load is None or not load.clear:
        return "friction"
    others = [change for name, change in changes.items() if name != LOAD]
    if not any(change.clear for change in others):
        return "load"
    same = all(
        abs(change.share - load.share) <= SAME * float(np.hypot(change.stderr, load.stderr))
        for change in others
    )
    return "gain" if same else "friction"
