"""The most flexible form of the effects of a model, as columns that only a diagnosis uses.

Before a second cause is claimed, the effects already in the model get these columns: what the
columns explain was the shape of the first cause, not another cause.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.effect.base import Identified
from stribeck.effect.registry import find

Array = NDArray[np.float64]


def flexible_columns(fit: Identified) -> Array:
    """Columns [m, k] that let the effects of `fit` take any smooth form, on its samples."""
    columns = [c for effect in fit.model.effects for c in columns_of(effect, fit)]
    return np.column_stack(columns) if columns else np.empty((fit.rows.size, 0))


def columns_of(effect: str, fit: Identified) -> list[Array]:
    """Columns [m] that let one effect of `fit` take any smooth form; none for one by formula."""
    known = find(effect)
    return [] if known is None else known.flexible_shape(fit)
