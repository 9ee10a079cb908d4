"""A cause in the measurement, as columns beside a model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.result import Fit
from stribeck.models.catalog import effect_row

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MeasurementCause:
    """A cause in the measurement.

    Attributes
    ----------
    what
        The cause as a noun phrase, for sentences.
    columns
        What it may add to the torque of a fit: arrays [n]; none where it cannot act.
    rising
        How many of the columns, the last ones, cannot have a negative factor.
    through
        The channel of which it shows a wrong value: it acts where friction depends on that.
    imitates
        Effects other than friction that it looks like; friction must stand beside every cause.
    """

    what: str
    columns: Callable[[Fit], list[Array]]
    rising: int = 0
    through: str | None = None
    imitates: tuple[str, ...] = ()

    def acts_without(self, effect: str, fit: Fit) -> bool:
        """Whether it acts on a fit without `effect`, by which friction may first depend on it."""
        row = effect_row(effect)
        if self.through is None or row is None or self.through not in row["channels"]:
            return True
        return self.through in fit.model.core.needs


def load_of(fit: Fit) -> Array:
    """Load torque [n], recorded or identified; zero where the model has none."""
    load = fit.load_torque
    return np.zeros_like(fit.prediction) if load is None else load
