"""Error figures of models on one recording, over all scored samples and by regime."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.arguments import door
from stribeck.base.errors import FitError
from stribeck.base.pool import serial_linear_algebra
from stribeck.base.shown import Plotted
from stribeck.diagnosis.residual.noise_floor import noise_floor
from stribeck.diagnosis.residual.regimes import regime_rows
from stribeck.fitting.energy import electrical_energy, joules
from stribeck.fitting.evaluate import evaluate
from stribeck.fitting.result import Fit
from stribeck.identify.errors.information import (
    Information,
    criteria,
    effective_samples,
    information,
)
from stribeck.identify.figures import relative_residual, rms
from stribeck.identify.left_out.rows import scored_rows
from stribeck.identify.weights import weighted
from stribeck.recording.recording import Recording
from stribeck.recording.several.concat import Recordings, as_one

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Regime:
    """Error within one part of the data.

    Attributes
    ----------
    share
        Share of the scored samples; of ``"standstill"``, of all samples.
    bias
        Mean of measured minus modelled torque, in the unit of torque.
    """

    regime: str
    share: float
    rmse: float
    bias: float

    def to_dict(self) -> dict[str, object]:
        """The JSON of one regime."""
        return {"regime": self.regime, "share": self.share, "rmse": self.rmse, "bias": self.bias}


@dataclass(frozen=True)
class Assessment:
    """One model's error figures on a recording, in the unit of torque, over the scored samples.

    Attributes
    ----------
    mean, std
        Of measured minus modelled torque.
    mean_absolute, largest_absolute
        Mean and maximum of its size.
    energy, energy_all_rows
        Electrical energy over the scored samples, and over all samples with those at rest, where
        the model holds what a joint at rest needs: the load.
    """

    model: str
    rmse: float
    rmse_held_out: float | None
    relative_residual: float | None
    mean: float
    std: float
    r2: float
    rmse_low_speed: float
    mean_absolute: float
    largest_absolute: float
    energy: dict[str, float] | None
    energy_all_rows: dict[str, float] | None
    regimes: tuple[Regime, ...]
    information: Information | None
    fit: Fit

    def to_dict(self) -> dict[str, object]:
        """The JSON of one model."""
        return {
            "model": self.model,
            "rmse": self.rmse,
            "rmse_held_out": self.rmse_held_out,
            "relative_residual": self.relative_residual,
            **criteria(self.information),
            "mean": self.mean,
            "std": self.std,
            "r2": self.r2,
            "rmse_low_speed": self.rmse_low_speed,
            "mean_absolute_error": self.mean_absolute,
            "largest_absolute_error": self.largest_absolute,
            "energy": self.energy,
            "energy_all_rows": self.energy_all_rows,
            "regimes": [regime.to_dict() for regime in self.regimes],
        }


@dataclass(frozen=True, repr=False)
class Comparison(Plotted):
    """Several models on the same samples of one recording.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=20.0, rate=50.0, seed=1)[0])
    >>> fits = [sb.fit(spec, recording, starts=1) for spec in ("coulomb", "coulomb+load")]
    >>> found = sb.compare(fits, recording)
    >>> min(found.models, key=lambda one: one.rmse_held_out).model
    'coulomb+load'
    >>> found.to_frame().columns
    ['model', 'regime', 'share', 'rmse', 'bias']
    """

    recording: Recording
    models: tuple[Assessment, ...]
    noise_floor: float | None
    noise_floor_why: str | None

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck compare`."""
        made: dict[str, object] = {
            "data": {
                "path": self.recording.path,
                "joint": self.recording.joint,
                "rows": int(self.recording.time.size),
                "unit": self.recording.torque_unit,
                "notes": list(self.recording.notes),
            },
            "models": [assessment.to_dict() for assessment in self.models],
            "noise_floor": self.noise_floor,
            "scored": self.recording.scored(scored_rows(self.recording)),
        }
        if self.noise_floor is None:
            made["noise_floor_why"] = self.noise_floor_why
        return made

    def to_frame(self) -> pl.DataFrame:
        """One row per model and regime."""
        return pl.DataFrame(
            [
                {"model": a.model, **r.to_dict()}
                for a in self.models
                for r in (Regime("all", 1.0, a.rmse, a.mean), *a.regimes)
            ]
        )


@door(FitError)
@serial_linear_algebra
def compare(
    fits: Sequence[Fit],
    recording: Recordings,
    *,
    floor: bool = True,
) -> Comparison:
    """Error figures of `fits` over the scored samples of `recording`, all and by regime.

    A fit made on another recording is not refitted: its error here is a held-out error.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=60.0, rate=100.0, seed=1)[0])
    >>> fits = [sb.fit(spec, recording, starts=2) for spec in ("coulomb", "coulomb+load")]
    >>> first, second = sb.compare(fits, recording).models
    >>> first.rmse > 5.0 * second.rmse
    True
    """
    if not isinstance(fits, Sequence) or not fits or not all(isinstance(f, Fit) for f in fits):
        raise FitError("there is nothing to compare: give a list of fits")
    recording = as_one(recording)
    fits = [
        f
        if f.recording.is_measured_as(recording)
        else evaluate(f.model, recording, fitted_on=f.recording.hashes)
        for f in fits
    ]
    best = min(fits, key=lambda f: f.rmse)
    estimate = noise_floor(best) if floor else None
    return Comparison(
        recording,
        tuple(assess(f, i) for f, i in zip(fits, _informations(fits), strict=True)),
        None if estimate is None else estimate.value,
        None if estimate is None else estimate.why,
    )


def _informations(fits: Sequence[Fit]) -> list[Information | None]:
    """The criteria of each fit, over the same samples: scored, and excluded from no fit.

    The effective number of samples is that of the residual with the least sum of squares: it is the
    closest to noise.
    """
    rows = np.logical_and.reduce([f.recording.moving & ~f.transient for f in fits])
    residuals = [weighted(f.recording, f.residual, np.flatnonzero(rows)) for f in fits]
    least = min(residuals, key=lambda residual: float(residual @ residual))
    effective = effective_samples(least)
    return [
        None if f.rank is None else information(residual, f.rank, effective)
        for f, residual in zip(fits, residuals, strict=True)
    ]


def assess(fit: Fit, criteria: Information | None) -> Assessment:
    """One model's error figures."""
    r = fit.recording
    scored = fit.scored
    residual = fit.residual
    at = residual[scored]
    torque = r.torque[scored]
    spread = float(np.sum((torque - torque.mean()) ** 2))
    regimes = []
    for name, rows in regime_rows(fit).items():
        if rows.any():
            regimes.append(
                Regime(
                    name,
                    float(rows.mean() if name == "standstill" else rows.sum() / scored.sum()),
                    rms(residual[rows]),
                    float(residual[rows].mean()),
                )
            )
    low = next(g for g in regimes if g.regime == "low_speed")
    return Assessment(
        model=fit.model.spec,
        rmse=rms(at),
        rmse_held_out=fit.rmse_held_out,
        relative_residual=(
            fit.relative_residual
            if fit.rmse_held_out is not None
            else relative_residual(r, residual)
        ),
        mean=float(at.mean()),
        std=float(at.std()),
        r2=1.0 - float(np.sum(at**2)) / spread if spread > 0 else float("nan"),
        rmse_low_speed=low.rmse,
        mean_absolute=float(np.abs(at).mean()),
        largest_absolute=float(np.abs(at).max()),
        energy=joules(electrical_energy(r, fit.prediction, scored)),
        energy_all_rows=joules(electrical_energy(r, fit.prediction, np.ones_like(scored))),
        regimes=tuple(regimes),
        information=criteria,
        fit=fit,
    )
