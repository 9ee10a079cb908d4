"""Identify a model's parameters on a recording."""

from __future__ import annotations

import time
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.fitting.finish import finish
from stribeck.fitting.made_passive import made_passive
from stribeck.fitting.result import Fit
from stribeck.fitting.solve import solve, with_own_load
from stribeck.identify.choices import Choices
from stribeck.identify.estimates import Errors
from stribeck.identify.scaling import bounds as scaled_bounds
from stribeck.identify.scaling import model_for
from stribeck.identify.search import THOROUGH, Effort
from stribeck.identify.transients import transient_rows
from stribeck.models.model import Model
from stribeck.recording.recording import Recording


def fit(
    spec: str | Model,
    recording: Recording,
    *,
    starts: int = 20,
    seed: int = 0,
    start: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    fix: Mapping[str, float] | None = None,
    errors: Errors = "robust",
    transient: NDArray[np.bool_] | None = None,
    effort: Effort = THOROUGH,
    passive: bool = False,
) -> Fit:
    """Identify the parameters of `spec` on `recording` by bounded least squares.

    Linear parameters are eliminated (variable projection), the others searched from `starts`
    seeded starts; a parameter whose bounds are equal is held. The measured torque is the target as
    recorded.

    Parameters
    ----------
    spec : str or Model
        ``"coulomb+load"``, a law by formula (``"c1*v + c2*tanh(v/c3)"``), or a model; a model's
        values are the first start.
    starts, seed : int
        Random starts of the nonlinear parameters (review of 25 models, eqs 4-5: 20).
    start, bounds, fix : mappings by parameter name or symbol
        Where single parameters start, between which bounds they stay (infinite ones are none), and
        which are held: ``start={"c3": 0.1}, bounds={"c2": (0.0, 5.0)}, fix={"c1": 0.3}``.
    errors : {"robust", "independent"}
        What standard errors assume of the residual: anything, right for a sampled motion; or that
        each row errs for itself and all alike, right for separately measured points, which gives
        the textbook's ``s^2 (J'J)^-1``.
    transient : bool array [n]
        Rows that are scored but not fitted to; default: looked for.
    effort : Effort
        How thoroughly; the default is for results, `QUICK` goes on from roughly known values.
    passive : bool
        Whether the friction has to be passive over the ranges seen, with a proof (`check`). What
        that costs is `Fit.passive_cost`; a fit that is passive by itself stays as it is.

    Raises
    ------
    SpecError, FitError
        Unknown law or effect; a channel that the model needs and the recording lacks; too few
        moving rows; no values with a proof of passivity.
    """
    began = time.perf_counter()
    choices = Choices(start or {}, bounds or {}, fix or {})
    made = choices.applied(model_for(spec, recording))
    marked = transient_rows(recording) if transient is None else transient
    rows = rows_to_fit(made, recording, marked)
    made, load = with_own_load(made, recording, rows, starts, seed, effort)
    solution = solve(made, recording, rows, load, starts, seed, effort)
    values, load = solution.values, solution.load
    made = made.with_values(values)
    fitted = finish(
        made, recording, marked, rows, load, solution, effort, errors, time.perf_counter() - began
    )
    return made_passive(fitted, solution, effort) if passive else fitted


def on_recording(fitted: Fit, recording: Recording | None, seed: int = 0) -> Fit:
    """`fitted` itself, or its model fitted again where `recording` is another one."""
    if recording is None or recording is fitted.recording:
        return fitted
    return fit(fitted.model, recording, seed=seed)


def rows_to_fit(made: Model, recording: Recording, marked: NDArray[np.bool_]) -> NDArray[np.intp]:
    """The rows that move and are no transients; refuses fewer than the model needs."""
    rows = np.flatnonzero(recording.moving & ~marked)
    lower, upper, _ = scaled_bounds(made, recording)
    fewest = int((lower < upper).sum()) + 2
    if rows.size < fewest:
        raise FitError(
            f"{recording.path} has {rows.size} rows that move, {made.spec} needs at least "
            f"{fewest}: record more motion"
        )
    return rows
