"""How well any function of the recorded channels could predict: the error of a regressor.

Extremely randomised trees (Geurts, Ernst and Wehenkel 2006) learn the residual of the best model,
and predict blocks that they were not trained on. They need no formula. What they do not find is
noise, or does not depend on these channels.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base.pool import on_each
from stribeck.diagnosis.residual.noise_floor import state_features
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms

Array = NDArray[np.float64]

ROWS = 10000
FOLDS = 5
TREES = 40
#: Samples that a leaf averages: fewer would learn the noise.
LEAF = 20
FEWEST_BLOCKS = 2


@dataclass(frozen=True)
class Explainable:
    """How much of the torque the recorded channels explain, and how much of that the model does.

    Attributes
    ----------
    rmse
        Held-out RMSE of a flexible regressor on top of the best model, in the unit of torque.
    share
        Share of the explainable variance of the torque that the model explains, 0..1.
    left
        Share of the best model's squared held-out error that the regressor removes, 0..1.
    """

    rmse: float
    share: float
    left: float

    def to_dict(self) -> dict[str, object]:
        """The JSON of `explainable`."""
        return {"rmse": self.rmse, "share": self.share}


def explainable(fitted: Fit, best: Fit | None = None) -> Explainable | None:
    """The share of the explainable torque that `fitted` explains; None without held-out blocks.

    Parameters
    ----------
    best : Fit
        The best model on the same recording; the regressor learns its residual.
    """
    best = fitted if best is None else best
    rows = best.rows[:: -(-best.rows.size // ROWS)]
    block = best.recording.block[rows]
    if np.unique(block).size < FEWEST_BLOCKS:
        return None
    learned = _held_out(state_features(best, rows), best.residual[rows], block)
    left = best.held_out_residual[rows]
    # A prediction that fails on unseen blocks is scaled down, to zero if necessary.
    power = float(learned @ learned)
    scale = float(np.clip(learned @ left / power, 0.0, 1.0)) if power > 0.0 else 0.0
    bound = rms(left - scale * learned)
    target = (fitted.recording.torque - fitted.recording.known_torque)[rows]
    room = float(np.var(target)) - bound**2
    missed = rms(fitted.held_out_residual[rows]) ** 2 - bound**2
    if room <= 0.0:
        return None
    share = float(np.clip(1.0 - missed / room, 0.0, 1.0))
    total = rms(left) ** 2
    return Explainable(bound, share, 1.0 - bound**2 / total if total > 0.0 else 0.0)


def _held_out(features: Array, residual: Array, block: NDArray[np.intp]) -> Array:
    """Prediction of each sample by trees trained without its block, array [m]."""
    predicted = np.zeros_like(residual)
    blocks = np.unique(block)

    def learned(fold: NDArray[np.intp]) -> None:
        unseen = np.isin(block, fold)
        predicted[unseen] = _core.learn(
            features[~unseen], residual[~unseen], features[unseen], TREES, LEAF
        )

    on_each(learned, np.array_split(blocks, min(FOLDS, blocks.size)))
    return predicted
