"""Does a wider model predict better, by more than chance?

Two questions. How much does the error fall on held-out blocks? Could noise alone explain the torque
that the wider model adds?
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.diagnosis.least_fall import reduced
from stribeck.effect.registry import of_catalog
from stribeck.fitting.result import Fit
from stribeck.identify.errors.added_torque import added_torque_test
from stribeck.identify.errors.covariance import batches, correlation_length
from stribeck.identify.figures import bridged, rms, zero_phase

Array = NDArray[np.float64]

#: Where the error falls by less than it must, that in the band of the motion must fall by as many
#: times more, and with no larger probability of chance. With the usual 1 % that is a tenth of its
#: square, a share that counts as structure.
IN_BAND, CERTAIN = 5.0, 1e-6


@dataclass(frozen=True)
class Evidence:
    """The evidence for a wider model.

    Attributes
    ----------
    fall : float
        Relative fall of the held-out RMSE, on the samples fitted to.
    everywhere : bool
        Whether the error falls also without the block that gains most: it is no single event.
    fall_in_band : float
        Relative fall in the band of the motion, where friction acts and vibration does not.
    p_value : float
        Probability that noise alone yields an added torque this large, times the number of forms
        tried; it may exceed 1.
    """

    fall: float
    everywhere: bool
    fall_in_band: float
    p_value: float

    def is_large(self, least: float, tried: int) -> bool:
        """Whether the error falls by at least `least`, or clearly in the band of the motion.

        Vibration and noise may be most of the error outside the band. On all samples half of that
        is needed all the same: less is of no use. It must also be certain, over all effects
        `tried`.
        """
        clearly = self.fall_in_band >= IN_BAND * least and self.p_value * tried <= CERTAIN
        return self.fall >= least or (self.fall >= reduced(least) and clearly)


def held_out_square(fit: Fit, before: Fit) -> float:
    """Held-out sum of squares on the samples fitted to, with the weights of `before`.

    Fits are compared with the same weights: those of a robust loss follow the residual.
    """
    return float(np.sum(before.weighted(fit.held_out_residual[before.rows]) ** 2))


def evidence(before: Fit, after: Fit) -> Evidence:
    """The evidence for a wider fit `after` against `before`."""
    r, rows = before.recording, before.rows
    square_before = before.weighted(before.held_out_residual[rows]) ** 2
    square_after = before.weighted(after.held_out_residual[rows]) ** 2
    gain = np.bincount(r.block[rows], square_before - square_after)
    level = float(square_before.mean())
    fall = 1.0 - float(np.sqrt(square_after.mean() / level)) if level > 0 else 0.0
    slow_before = zero_phase(r, bridged(r, before.held_out_residual))[rows]
    slow_after = zero_phase(r, bridged(r, after.held_out_residual))[rows]
    added = before.weighted((after.prediction - before.prediction)[rows])
    return Evidence(
        fall,
        bool(gain.sum() - gain.max() > 0),
        1.0 - rms(slow_after) / (rms(slow_before) or 1.0),
        added_torque_test(
            added,
            before.weighted(after.residual[rows]),
            len(after.model.names) - len(before.model.names),
        )
        * _forms(before, after),
    )


def _forms(before: Fit, after: Fit) -> int:
    """From how many forms the wider model was chosen by looking at the data, such as periods."""
    added = [e for e in after.model.effects if e not in before.model.effects]
    return math.prod(of_catalog(effect).forms(after.recording) for effect in added)


@dataclass(frozen=True)
class Difference:
    """Mean difference of two models' held-out squared errors, and its standard error."""

    total: float
    error: float

    @property
    def statistic(self) -> float:
        """Standard errors by which the first model is worse."""
        if self.total <= 0:
            return 0.0
        return self.total / self.error if self.error > 0 else np.inf

    @property
    def certainty(self) -> float:
        """Probability that the first model is worse on new samples of this kind, 0..1."""
        z = self.total / self.error if self.error > 0 else np.inf * np.sign(self.total)
        return float(scipy.special.ndtr(z))

    @classmethod
    def of(cls, change: Array) -> Difference:
        """From the differences of the squared errors of each sample [m]."""
        batch = batches(change.size, correlation_length(change), fewest=20, most=100)
        count = int(batch.max()) + 1
        sums = np.bincount(batch, change, count)
        error = float(np.sqrt(count) * sums.std(ddof=1)) if count > 2 else np.inf
        return cls(float(sums.sum()), error)


def difference(worse: Fit, better: Fit, *, everywhere: bool = False) -> Difference:
    """Compare two models, nested or not, on held-out samples; `everywhere`, also at reversals."""
    whole = everywhere and worse.loss_weight is None
    rows = np.flatnonzero(worse.scored) if whole else worse.rows
    return Difference.of(_gain(worse, better, rows))


def gain_by_block(worse: Fit, better: Fit) -> Array:
    """What a model gains on another in each held-out block, squared errors summed, [blocks]."""
    rows = worse.rows
    return np.asarray(
        np.bincount(worse.recording.block[rows], _gain(worse, better, rows)), np.float64
    )


def _gain(worse: Fit, better: Fit, rows: NDArray[np.intp]) -> Array:
    """Difference of the squared held-out errors of two models on some samples, [m]."""
    left, remains = (worse.weighted(f.held_out_residual[rows]) ** 2 for f in (worse, better))
    return np.asarray(left - remains)
