"""A fitted model as stored by a project: the contents of its model file, and the fit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.errors.estimates import AT_BOUND, Estimate
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.projects.source import Source


class Kept:
    """The contents of a model file; the fit is given, or computed when needed."""

    def __init__(self, file: ModelFile, fitted: Fit | None = None) -> None:
        self.file = file
        self._fitted = fitted

    @classmethod
    def of(cls, fitted: Fit, source: Source) -> Kept:
        """Store a fit to the data of the project."""
        file = ModelFile.of(fitted)
        return cls(replace(file, fitted_on={**file.fitted_on, "path": source.path}), fitted)

    @property
    def model(self) -> Model:
        """The model with its values."""
        return self.file.model

    @property
    def rmse(self) -> float:
        """RMSE over the scored samples."""
        return float(self.file.fitted_on["rmse"])

    @property
    def rmse_held_out(self) -> float | None:
        """RMSE with each block predicted by a fit without it."""
        value = self.file.fitted_on.get("rmse_held_out")
        return None if value is None else float(value)

    @property
    def estimates(self) -> dict[str, Estimate]:
        """The parameters as stored in the file, without intervals."""
        return {
            p.name: _estimate(self.file, p.name, p.symbol, p.unit) for p in self.model.parameters
        }

    def holds(self, fitted: Fit) -> bool:
        """Whether this is the stored fit object."""
        return self._fitted is fitted

    def fit(self, source: Source, seed: int) -> Fit:
        """Return the fit; it is fitted again from the stored values if not made in this session."""
        if self._fitted is None:
            self._fitted = fit(self.model, source.recording, starts=1, seed=seed)
        return self._fitted


def _estimate(file: ModelFile, name: str, symbol: str, unit: str) -> Estimate:
    """One parameter; without a standard error it is fixed, at its bound, or not identifiable."""
    value, error = file.model.value(name), file.stderr.get(name)
    lower, upper = file.model.bounds.get(name, (-np.inf, np.inf))
    held = lower == upper
    near = AT_BOUND * (upper - lower) if np.isfinite(upper - lower) else 0.0
    at_bound = error is None and not held and not lower + near < value < upper - near
    return Estimate(
        name,
        symbol,
        value,
        unit,
        error,
        None,
        at_bound,
        error is not None or held or at_bound,
        lower,
        upper,
        held,
    )
