"""Model files: a model, the data it was fitted to and its operating box, as editable TOML."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field

import tomlkit
from tomlkit.items import Table

from stribeck.models.fitted import Fitted, FittedOn, HasModel, Origin, PerRun
from stribeck.models.model import Model
from stribeck.models.writer import add_model, model_toml, write_model


@dataclass(frozen=True, eq=False)
class ModelFile:
    """A model with its standard errors and provenance, as stored.

    Attributes
    ----------
    model : Model
        With a value for each parameter.
    stderr : dict of float
        Standard errors by parameter name, in the parameters' units, where known.
    fitted_on : dict
        ``path``, ``sha256``, ``files`` (hashes of several files), ``rows`` (moving samples),
        ``time_span`` [s, s], ``rmse``, ``rmse_held_out``.
    per_run : dict of dicts of pairs
        Value and standard error in each run, by parameter and run, of parameters that have one
        value in each; `model` has their means.

    Examples
    --------
    >>> import stribeck as sb
    >>> sb.read_model_file("published:bam/mx64/bam_m1").model.torque_unit
    'N m'
    """

    model: Model
    stderr: Mapping[str, float] = field(default_factory=dict)
    fitted_on: FittedOn = field(default_factory=FittedOn)
    per_run: PerRun = field(default_factory=dict)

    @classmethod
    def of(cls, fitted: Fitted) -> ModelFile:
        """Keep the model of a fit with its standard errors and provenance."""
        recording = fitted.recording
        fitted_on: FittedOn = {
            "path": recording.path,
            "sha256": recording.sha256,
            **({"files": list(hashes)} if (hashes := recording.hashes[1:]) else {}),
            "rows": int(recording.moving.sum()),
            "time_span": [float(recording.time[0]), float(recording.time[-1])],
            "rmse": fitted.rmse,
        }
        if fitted.rmse_held_out is not None:
            fitted_on["rmse_held_out"] = fitted.rmse_held_out
        errors = {n: e.stderr for n, e in fitted.estimates.items() if e.stderr is not None}
        per_run = {
            name: {run: (e.value, e.stderr) for run, e in of_runs.items()}
            for name, of_runs in fitted.per_run.items()
        }
        return cls(fitted.model, errors, fitted_on, per_run)

    @property
    def origin(self) -> Origin:
        """What the file holds besides the model."""
        return Origin(self.stderr, self.fitted_on, self.per_run)

    @property
    def hashes(self) -> tuple[str, ...]:
        """SHA-256 of what the model was fitted to, and of each file where there are several."""
        whole = self.fitted_on.get("sha256")
        return (() if whole is None else (whole,)) + tuple(self.fitted_on.get("files", ()))

    def to_toml(self) -> str:
        """The file's text; numbers are written so that they read back with the same bits."""
        return model_toml(self.model, self.stderr, self.fitted_on, self.per_run)

    def write_into(self, document: tomlkit.TOMLDocument | Table) -> None:
        """Add what the file holds to a document or table of tomlkit."""
        add_model(document, self.model, self.stderr, self.fitted_on, self.per_run)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the file whole or not at all.

        Raises
        ------
        ModelFileError
            A parameter has no value, or the path cannot be written.
        """
        write_model(self.model, path, self.stderr, self.fitted_on, self.per_run)


#: For `stribeck.base.arguments.door`.
MODEL = ("a spec or a model", (str, Model))
WITH_MODEL = ("a model, a model file or a fit", (Model, HasModel))
