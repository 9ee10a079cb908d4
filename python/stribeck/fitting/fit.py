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

    Linear parameters are eliminated (variable projection); the others are searched from `starts`
    seeded starts. The measured torque is the target as recorded.

    Parameters
    ----------
    spec : str or Model
        ``"coulomb+load"``, a law by formula (``"c1*v + c2*tanh(v/c3)"``), or a model. The values of
        a model are the first start.
    starts, seed : int
        Random starts of the nonlinear parameters (20 in the UR5e review, eqs 4-5), and their seed.
    start, bounds, fix : mapping from parameter name or symbol
        Start values, bounds (infinite: unbounded) and fixed values of single parameters:
        ``start={"c3": 0.1}, bounds={"c2": (0.0, 5.0)}, fix={"c1": 0.3}``.
    errors : {"robust", "independent"}
        Noise assumed by the standard errors: correlated in time, as in a sampled motion, or
        independent with equal variance, as in separate points, which gives ``s^2 (J'J)^-1``.
    transient : bool array [n], optional
        Samples that are scored but excluded from the fit. Detected by default.
    effort : Effort
        Tolerances of the search. The default is for final results; `QUICK` refines values that are
        roughly known.
    passive : bool
        If true, the friction is fitted under passivity conditions until passivity is proved over
        the operating box. `Fit.passive_cost` states the increase of the error.

    Raises
    ------
    SpecError, FitError
        The law or an effect is unknown; the recording lacks a channel that the model needs, has too
        few moving samples, or no values with a proof of passivity were found.
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
    """Return `fitted`, or its model refitted if `recording` is a different one."""
    if recording is None or recording is fitted.recording:
        return fitted
    return fit(fitted.model, recording, seed=seed)


def rows_to_fit(made: Model, recording: Recording, marked: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Indices of the samples to fit: moving and not transient.

    Raises `FitError` if there are fewer than the free parameters of the model plus two.
    """
    rows = np.flatnonzero(recording.moving & ~marked)
    lower, upper, _ = scaled_bounds(made, recording)
    fewest = int((lower < upper).sum()) + 2
    if rows.size < fewest:
        raise FitError(
            f"{recording.path} has {rows.size} moving samples, {made.spec} needs at least "
            f"{fewest}: record more motion"
        )
    return rows
