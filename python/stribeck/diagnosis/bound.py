"""How well any function of the recorded channels could predict: a flexible regressor's error.

Extremely randomised trees (Geurts, Ernst and Wehenkel 2006) learn what the best model at hand
leaves, and predict blocks that they have not seen. They know no physics and need no formula, so
what they do not find either is not in these channels, or is noise.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stribeck.base.pool import threads
from stribeck.diagnosis.floor import state_features
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms

Array = NDArray[np.float64]

ROWS = 10000
FOLDS = 5
TREES = 40
#: Rows that a leaf averages: fewer would learn the noise.
LEAF = 20
FEWEST_BLOCKS = 2


@dataclass(frozen=True)
class Explainable:
    """What the recorded channels could show of the torque, and what of that a model explains.

    Attributes
    ----------
    rmse
        Held-out RMSE of a flexible regressor on top of the best model, in the unit of torque.
    share
        Share of the torque's variance above that error which the model explains, 0..1.
    left
        Share of the best model's squared held-out error that the regressor removes, 0..1.
    """

    rmse: float
    share: float
    left: float

    def to_dict(self) -> dict[str, Any]:
        """The JSON of `explainable`."""
        return {"rmse": self.rmse, "share": self.share}


def explainable(fitted: Fit, best: Fit | None = None) -> Explainable | None:
    """How much of what can be explained `fitted` explains; None where nothing can be held out.

    Parameters
    ----------
    best : Fit
        The best model at hand on the same recording; the regressor starts from what it leaves.
    """
    best = fitted if best is None else best
    rows = best.rows[:: -(-best.rows.size // ROWS)]
    block = best.recording.block[rows]
    if np.unique(block).size < FEWEST_BLOCKS:
        return None
    learned = _held_out(state_features(best, rows), best.residual[rows], block)
    left = best.held_out_residual[rows]
    # What does not predict unseen blocks is scaled down, to nothing if need be.
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
    """Prediction of each row by trees that have not seen its blocks, array [m]."""
    from sklearn.ensemble import ExtraTreesRegressor

    predicted = np.zeros_like(residual)
    blocks = np.unique(block)
    for fold in np.array_split(blocks, min(FOLDS, blocks.size)):
        unseen = np.isin(block, fold)
        trees = ExtraTreesRegressor(
            TREES, min_samples_leaf=LEAF, random_state=0, n_jobs=threads()
        )  # fmt: skip
        trees.fit(features[~unseen], residual[~unseen])
        # On several threads their answers would be summed in any order.
        trees.set_params(n_jobs=1)
        predicted[unseen] = trees.predict(features[unseen])
    return predicted
