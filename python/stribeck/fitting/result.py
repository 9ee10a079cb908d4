"""The result of a fit: the model, its parameters with their errors, and what it predicts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike
from typing import Literal

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.arguments import door
from stribeck.base.errors import ModelFileError, StribeckError
from stribeck.base.shown import Plotted
from stribeck.fitting.evaluated import Evaluated
from stribeck.fitting.exogenous import tested
from stribeck.fitting.predict import predicted
from stribeck.fitting.stated import PLAIN, HeldConstraint, Under
from stribeck.identify.errors.confounded import Combination
from stribeck.identify.errors.estimates import Errors, Estimate
from stribeck.identify.errors.information import Information, criteria, information
from stribeck.identify.errors.matrix import ParameterMatrix
from stribeck.identify.figures import torque_cutoff
from stribeck.identify.instrumental.exogeneity import Exogeneity
from stribeck.identify.left_out.rows import counted_rows, scored_rows, transients
from stribeck.identify.search.ends import StartsReport
from stribeck.identify.weights import root_weights, weighted, weighted_rms
from stribeck.models.fitted import note_origin
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.models.rigid_body import own_load
from stribeck.passivity.check import check
from stribeck.passivity.imposed import PassiveCost
from stribeck.recording.recording import Recording
from stribeck.recording.several.concat import Recordings, as_one

Array = NDArray[np.float64]

#: Least squares, or instrumental variables from the reference trajectory.
Estimator = Literal["ls", "iv"]


@dataclass(frozen=True, repr=False, eq=False)
class Fit(Plotted):
    """A model identified on a recording.

    Attributes
    ----------
    prediction, held_out : array [n]
        Torque of every sample, predicted by the fit and by the refit without the sample's block.
    rmse, rmse_held_out : float
        Over the scored samples, in the unit of torque.
    transient : bool array [n]
        Samples that were excluded from the fit.
    load : array [n], optional
        Load torque of the identified rigid body.
    passive_cost : PassiveCost, optional
        What passivity costs, where a passive fit was asked for.
    under : Under, optional
        Priors, constraints, ties and the loss, where some were stated.
    covariance : ParameterMatrix, optional
        Of the parameters with a standard error, in products of their units; None where the method
        gives none.
    combinations : tuple of Combination
        What the data determines of the parameters that are not identifiable.
    rank : int, optional
        Number of parameters, or combinations, that the least-squares fit determined; 0 for a model
        that was not refitted, None where it is not known.
    estimator : {"ls", "iv"}, optional
        Least squares or instrumental variables; None for other methods.
    tested : Exogeneity, optional
        The test of the least squares that a fit by instrumental variables started from.
    search : StartsReport, optional
        What the starts say about the minimum; None for other methods.
    evaluated : tuple of Evaluated
        Its errors on other recordings, where some were asked for.
    per_run : mapping of mappings of Estimate
        The values of a parameter in each run, by parameter and run, where they were asked for;
        `model` and `estimates` have their mean.

    Examples
    --------
    >>> import numpy as np, stribeck as sb
    >>> t = np.arange(2000) / 100.0
    >>> v = np.sin(3.0 * t)
    >>> r = sb.Recording.from_columns(time=t, velocity=v, torque=0.5 * v + 2.0 * np.sign(v))
    >>> found = sb.fit("coulomb", r, starts=1)
    >>> round(found.estimates["coulomb_friction"].value, 3), found.rmse_held_out < 1e-6
    (2.0, True)
    >>> found.predict(r)[100:103].round(3)
    array([2.071, 2.056, 2.041])
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
    covariance: ParameterMatrix | None = None
    combinations: tuple[Combination, ...] = ()
    rank: int | None = None
    estimator: Estimator | None = None
    tested: Exogeneity | None = None
    search: StartsReport | None = None
    under: Under | None = None
    evaluated: tuple[Evaluated, ...] = ()
    per_run: Mapping[str, Mapping[str, Estimate]] = field(default_factory=dict)
    _answers: dict[str, bool | None] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def __post_init__(self) -> None:
        if self.outcome != "not refitted":
            note_origin(self.model, ModelFile.of(self).origin)

    def predict(self, recording: Recordings) -> Array:
        """The effort that the model predicts on a recording, measured motion in.

        Parameters
        ----------
        recording : Recording or sequence of them
            Of the same kind of joint. Its torque is not read.

        Returns
        -------
        array [n]
            Torque or force of every sample, in the unit of the fit.

        Raises
        ------
        FitError
            It lacks a channel that the model reads.

        Examples
        --------
        >>> fit = sb.fit("coulomb", monday)  # doctest: +SKIP
        >>> tuesday.torque - fit.predict(tuesday)  # doctest: +SKIP
        """
        return predicted(self.model, as_one(recording))[0]

    @door(ModelFileError)
    def save(self, path: str | PathLike[str]) -> None:
        """Write the model file (TOML), with standard errors and what the model was fitted to.

        Raises
        ------
        ModelFileError
            The path cannot be written.
        """
        ModelFile.of(self).write(path)

    @property
    def own_load(self) -> Array | None:
        """Load torque of the identified rigid body [n]; None where none is identified."""
        return own_load(self.model, self.recording) if self.load is None else self.load

    @property
    def load_torque(self) -> Array | None:
        """Load torque of every sample [n], recorded or identified; None where it is unknown."""
        recorded = self.recording.load_torque
        return self.own_load if recorded is None else recorded

    @property
    def residual(self) -> Array:
        """Measured minus predicted torque of every sample, [n]."""
        return self.recording.torque - self.prediction

    @property
    def held_out_residual(self) -> Array:
        """Measured minus held-out torque of every sample, [n]."""
        return self.recording.torque - self.held_out

    @property
    def rmse_weighted(self) -> float | None:
        """Weighted RMSE over the scored samples; None without weights."""
        return weighted_rms(self.recording, self.residual, self.scored)

    @property
    def rmse_held_out_weighted(self) -> float | None:
        """Weighted held-out RMSE; None without weights or held-out predictions."""
        if self.rmse_held_out is None:
            return None
        return weighted_rms(self.recording, self.held_out_residual, counted_rows(self.recording))

    @property
    def loss_weight(self) -> Array | None:
        """Weights [n] of a robust loss at the solution; None for least squares."""
        return None if self.under is None else self.under.loss_weight

    @property
    def constraints(self) -> tuple[HeldConstraint, ...]:
        """The constraints with their slacks."""
        return () if self.under is None else self.under.constraints

    def weighted(self, values: Array) -> Array:
        """`values` [m] of the samples fitted to, times the square roots of their weights."""
        root = root_weights(self.recording, self.loss_weight)
        return values if root is None else values * root[self.rows]

    @property
    def scored(self) -> NDArray[np.bool_]:
        """Which samples the errors are of, [n]: those that move and are not in doubt."""
        return scored_rows(self.recording)

    @property
    def rows(self) -> NDArray[np.intp]:
        """Indices of the samples that the parameters were fitted to."""
        return np.flatnonzero(self.recording.moving & ~self.transient)

    @property
    def correlation(self) -> ParameterMatrix | None:
        """Correlations of the parameters with a standard error; None without a covariance."""
        return None if self.covariance is None else self.covariance.correlation()

    @property
    def information(self) -> Information | None:
        """Information criteria over the samples of the fit; None without `rank`."""
        if self.rank is None:
            return None
        return information(weighted(self.recording, self.residual, self.rows), self.rank)

    @cached_property
    def exogeneity(self) -> Exogeneity | None:
        """Durbin-Wu-Hausman test of least squares; None without a reference trajectory.

        It compares estimators within bounds alone, so that there is none where more is stated.
        """
        if self.under is not None or self.per_run:
            return None
        if self.estimator != "ls":
            return self.tested
        return tested(self.model, self.recording, self.rows, self.load, self.estimates)

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

    def _search_row(self) -> dict[str, object]:
        found = self.search
        return {
            "algorithm": None if found is None else found.algorithm,
            "starts_at_minimum": None if found is None else found.at_minimum,
            "new_place_probability": None if found is None else found.new_place,
        }

    def to_dict(self) -> dict[str, object]:
        """The contract's JSON of `stribeck fit`."""
        return {
            "model": self.model.spec,
            "parameters": {name: e.to_dict() for name, e in self.estimates.items()},
            "correlation": None if self.correlation is None else self.correlation.to_dict(),
            "determined_combinations": [found.to_dict() for found in self.combinations],
            "rmse": self.rmse,
            "rmse_held_out": self.rmse_held_out,
            "rmse_weighted": self.rmse_weighted,
            "rmse_held_out_weighted": self.rmse_held_out_weighted,
            "relative_residual": self.relative_residual,
            **criteria(self.information),
            "relative_residual_cutoff_hz": torque_cutoff(self.recording),
            "unit": self.model.torque_unit,
            "starts": self.starts,
            **self._search_row(),
            "converged": self.converged,
            "outcome": self.outcome,
            "evaluations": self.evaluations,
            "seconds": self.seconds,
            "errors": self.errors,
            "estimator": self.estimator,
            "exogeneity": None if self.exogeneity is None else self.exogeneity.to_dict(),
            **(PLAIN if self.under is None else self.under.to_dict()),
            "passive": self.passive(),
            "passive_cost": None if self.passive_cost is None else self.passive_cost.to_dict(),
            "rigid_body": list(self.model.rigid_body),
            "drive": self.model.drive,
            "formulas": {terms.name: terms.text for terms in self.model.own},
            "transients": [list(pair) for pair in transients(self.recording, self.transient)],
            "scored": self.recording.scored(self.scored),
            "notes": [*self.recording.notes, *self.notes],
            **self.evaluations_dict(),
            **({"per_run": self.per_run_dict()} if self.per_run else {}),
        }

    def per_run_dict(self) -> dict[str, dict[str, object]]:
        """The JSON of the values of each run, by parameter and run."""
        return {
            name: {run: e.to_dict() for run, e in of_runs.items()}
            for name, of_runs in self.per_run.items()
        }

    def evaluations_dict(self) -> dict[str, object]:
        """The JSON of the errors on other recordings; empty without any."""
        rows = [one.to_dict() for one in self.evaluated]
        return {"evaluated": rows} if rows else {}

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


#: For `stribeck.base.arguments.door`.
FIT = ("a fit, as `stribeck.fit` returns it", Fit)
