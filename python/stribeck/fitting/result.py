"""The result of a fit: the model, its parameters with their errors, and what it predicts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.errors import StribeckError
from stribeck.base.shown import Plotted
from stribeck.identify.estimates import Errors, Estimate
from stribeck.identify.figures import torque_cutoff
from stribeck.identify.transients import stretches
from stribeck.models.model import Model
from stribeck.passivity.check import check
from stribeck.passivity.imposed import PassiveCost
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass(frozen=True, repr=False)
class Fit(Plotted):
    """A model identified on a recording.

    Attributes
    ----------
    prediction, held_out : array [n]
        Torque of every sample, predicted by the fit and by the refit without the sample's block.
    rmse, rmse_held_out : float
        Over the scored (moving) samples, in the unit of torque.
    transient : bool array [n]
        Samples that are scored but were excluded from the fit.
    load : array [n], optional
        Load torque of the identified rigid body.
    passive_cost : PassiveCost, optional
        What passivity costs, where a passive fit was asked for.
    """

    model: Model
    recording: Recording
    estimates: Mapping[str, Estimate]
    prediction: Array
    held_out: Array
    rmse: float
    rmse_held_out: float | None
    relative_residual: float | None
    starts: int
    converged: bool
    outcome: str
    evaluations: int
    seconds: float
    transient: NDArray[np.bool_]
    load: Array | None
    notes: tuple[str, ...] = field(default=())
    errors: Errors = "robust"
    passive_cost: PassiveCost | None = None
    _answers: dict[str, bool | None] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    @property
    def residual(self) -> Array:
        """Measured minus predicted torque of every sample, [n]."""
        return self.recording.torque - self.prediction

    @property
    def held_out_residual(self) -> Array:
        """Measured minus held-out torque of every sample, [n]."""
        return self.recording.torque - self.held_out

    @property
    def rows(self) -> NDArray[np.intp]:
        """Indices of the samples that the parameters were fitted to."""
        return np.flatnonzero(self.recording.moving & ~self.transient)

    def passive(self) -> bool | None:
        """Whether the friction is passive over its operating box; None where undecided.

        The first call runs the proof (`stribeck.check`), later ones return its answer.
        """
        if "passive" not in self._answers:
            try:
                self._answers["passive"] = check(self.model).passive
            except StribeckError:
                # A box over which the law has no limit, or a bristle without dry friction.
                self._answers["passive"] = None
        return self._answers["passive"]

    def to_dict(self) -> dict[str, object]:
        """The contract's JSON of `stribeck fit`."""
        return {
            "model": self.model.spec,
            "parameters": {name: e.to_dict() for name, e in self.estimates.items()},
            "rmse": self.rmse,
            "rmse_held_out": self.rmse_held_out,
            "relative_residual": self.relative_residual,
            "relative_residual_cutoff_hz": torque_cutoff(self.recording),
            "unit": self.model.torque_unit,
            "starts": self.starts,
            "converged": self.converged,
            "outcome": self.outcome,
            "evaluations": self.evaluations,
            "seconds": self.seconds,
            "errors": self.errors,
            "passive": self.passive(),
            "passive_cost": None if self.passive_cost is None else self.passive_cost.to_dict(),
            "rigid_body": list(self.model.rigid_body),
            "drive": self.model.drive,
            "formulas": {terms.name: terms.text for terms in self.model.own},
            "transients": [list(pair) for pair in stretches(self.recording, self.transient)],
            "scored": self.recording.scored(),
            "notes": [*self.recording.notes, *self.notes],
        }

    def to_frame(self) -> pl.DataFrame:
        """The parameters as a table."""
        return pl.DataFrame(
            [
                {
                    "parameter": e.name,
                    "symbol": e.symbol,
                    "value": e.value,
                    "stderr": e.stderr,
                    "unit": e.unit,
                    "at_bound": e.at_bound,
                    "identifiable": e.identifiable,
                }
                for e in self.estimates.values()
            ]
        )
