"""The result of a fit to a data set."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import polars as pl

from stribeck.base.errors import StribeckError
from stribeck.base.shown import Shown
from stribeck.fitting.result import Fit
from stribeck.identify.errors.confounded import Combination
from stribeck.identify.errors.estimates import Estimate
from stribeck.identify.errors.matrix import ParameterMatrix
from stribeck.models.fitted import FittedOn
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.scale.streaming.dataset import DataSet

__all__ = ["StreamedFit"]


@dataclass(frozen=True, repr=False)
class StreamedFit(Shown):
    """A model identified on all samples of a data set.

    Attributes
    ----------
    start
        The fit to the samples in memory, from which the passes start.
    rmse, rmse_held_out
        Over all moving samples, in the unit of torque; the blocks held out cover the data set.
    rows, moving, dropped
        Number of all samples, of those fitted and scored, and of those dropped as not finite.
    passes
        How often all samples were read.
    covariance, combinations
        As of `Fit`.
    seconds, pass_seconds
        Total time, and time of the passes.

    Examples
    --------
    >>> import numpy as np, polars as pl, stribeck as sb, tempfile
    >>> v = np.sin(np.arange(900) / 50.0)
    >>> frame = pl.DataFrame({"t": np.arange(900) / 100.0, "qd": v, "tau": v + np.sign(v)})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     frame.write_parquet(f"{folder}/log.parquet")
    ...     found = sb.stream(folder).fit("coulomb", starts=1)
    ...     found.model_file().write(f"{folder}/joint.toml")
    >>> found.rows, found.moving, round(found.model.value("coulomb_friction"), 3)
    (900, 899, 1.0)
    """

    model: Model
    data: DataSet
    start: Fit
    estimates: Mapping[str, Estimate]
    rmse: float
    rmse_held_out: float | None
    rows: int
    moving: int
    dropped: int
    time_span: tuple[float, float]
    blocks: int
    converged: bool
    outcome: str
    passes: int
    seconds: float
    pass_seconds: float
    covariance: ParameterMatrix
    combinations: tuple[Combination, ...]
    notes: tuple[str, ...] = ()

    @property
    def rows_per_second(self) -> float:
        """Samples read per second of the passes."""
        return self.passes * self.rows / self.pass_seconds

    @property
    def passive(self) -> bool | None:
        """Whether friction is passive over the operating box; None if undecided."""
        from stribeck.passivity.check import check

        try:
            return check(self.model).passive
        except StribeckError:
            # The law is unbounded over the box, or it has a bristle without dry friction.
            return None

    def to_dict(self) -> dict[str, object]:
        """The contract's JSON of `stribeck fit`, with figures of the data set.

        The relative residual needs a filter over all samples; it is from those in memory.
        """
        sample = self.start.recording
        return {
            "model": self.model.spec,
            "parameters": {name: e.to_dict() for name, e in self.estimates.items()},
            "correlation": self.covariance.correlation().to_dict(),
            "determined_combinations": [found.to_dict() for found in self.combinations],
            "rmse": self.rmse,
            "rmse_held_out": self.rmse_held_out,
            "relative_residual": self.start.relative_residual,
            "unit": self.model.torque_unit,
            "starts": self.start.starts,
            "converged": self.converged,
            "outcome": self.outcome,
            "evaluations": self.start.evaluations + self.passes,
            "seconds": self.seconds,
            "passive": self.passive,
            "rigid_body": list(self.model.rigid_body),
            "scored": {
                "rows": self.moving,
                "share": self.moving / self.rows,
                "velocity_threshold": sample.velocity_threshold,
            },
            "data": {
                "path": self.data.path,
                "files": len(self.data.files),
                "rows": self.rows,
                "rows_dropped": self.dropped,
                "rows_in_memory": sample.rows,
                "passes": self.passes,
                "rows_per_second": self.rows_per_second,
            },
            "notes": [*sample.notes, *self.notes],
        }

    def to_frame(self) -> pl.DataFrame:
        """The parameters as a table."""
        return pl.DataFrame(
            [
                {
                    "parameter": n,
                    "symbol": e.symbol,
                    "value": e.value,
                    "stderr": e.stderr,
                    "unit": e.unit,
                }
                for n, e in self.estimates.items()
            ]
        )

    def model_file(self) -> ModelFile:
        """The model with its standard errors and provenance; hashes the files."""
        fitted_on: FittedOn = {
            "path": self.data.path,
            "sha256": self.data.sha256,
            "rows": self.moving,
            "time_span": list(self.time_span),
            "rmse": self.rmse,
        }
        if self.rmse_held_out is not None:
            fitted_on["rmse_held_out"] = self.rmse_held_out
        errors = {n: e.stderr for n, e in self.estimates.items() if e.stderr is not None}
        return ModelFile(self.model, errors, fitted_on)
