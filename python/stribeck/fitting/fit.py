"""Identify a model's parameters on a recording."""

from __future__ import annotations

import time
from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stribeck.base.arguments import door
from stribeck.base.errors import FitError, SpecError, option
from stribeck.base.pool import serial_linear_algebra
from stribeck.fitting.exogenous import check_estimator
from stribeck.fitting.finish import finish
from stribeck.fitting.instrumented import instrumented
from stribeck.fitting.made_passive import made_passive
from stribeck.fitting.per_run import named_per_run, refuse_beside, with_own_values
from stribeck.fitting.result import Estimator, Fit
from stribeck.fitting.solve import Solution, solve, with_own_load
from stribeck.fitting.stated import Under, prior_conflicts, solve_under
from stribeck.identify.errors.estimates import Errors
from stribeck.identify.errors.uncertainty import RESAMPLES, Uncertainty
from stribeck.identify.left_out.rows import rows_left_out
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds as scaled_bounds
from stribeck.identify.scaling import model_for
from stribeck.identify.search.effort import THOROUGH, Effort
from stribeck.identify.stated.choices import ChoiceArguments, Choices, refuse_statements
from stribeck.models.model import Model
from stribeck.models.model_file import MODEL
from stribeck.recording.recording import Recording
from stribeck.recording.several.concat import Recordings, as_one
from stribeck.recording.weights import with_weights

if TYPE_CHECKING:
    from typing_extensions import Unpack


@door(FitError, spec=MODEL)
@serial_linear_algebra
def fit(
    spec: str | Model,
    recording: Recordings,
    *,
    starts: int = 20,
    seed: int = 0,
    errors: Errors = "robust",
    resamples: int = RESAMPLES,
    transient: NDArray[np.bool_] | None = None,
    effort: Effort = THOROUGH,
    passive: bool = False,
    weights: ArrayLike | None = None,
    estimator: Estimator = "ls",
    per_run: str | Collection[str] = (),
    **choices: Unpack[ChoiceArguments],
) -> Fit:
    """Identify the parameters of `spec` on `recording` by bounded least squares.

    Parameters
    ----------
    spec : str or Model
        ``"coulomb+load"``, a law by formula, or a model, whose values are the first start.
    recording : Recording or sequence of them
        Several are runs of one joint.
    starts, seed, effort : int, int, Effort
        Random starts (UR5e review, eqs 4-5), their seed, and how thorough the search is.
    errors : {"robust", "independent", "profile", "bootstrap"}
        For noise correlated in time; for independent noise (``s^2 (J'J)^-1``); as robust, with
        profile-likelihood intervals; from refits to `resamples` of blocks.
    transient : bool array [n], optional
        Samples that are excluded from the fit. Detected by default.
    passive : bool
        If true, passivity is imposed and proved. `Fit.passive_cost` states what that costs.
    weights : array [n], optional
        Weight of each sample's squared error, in place of those that were read with the recording.
    estimator : {"ls", "iv"}
        Least squares, or instrumental variables from the reference trajectory (Janot et al. 2014).
    per_run : str or collection of str
        Parameters, by name or symbol, that have a value of their own in each run.
    **choices : mappings from parameter name or symbol
        ``bounds={"c2": (0.0, 5.0)}, fix={"c1": 0.3}`` and others: see `ChoiceArguments`.

    Raises
    ------
    SpecError, FitError
        Unknown names; a channel that is missing; too few moving samples; no proof of passivity.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=60.0, rate=100.0, seed=1)[0])
    >>> found = sb.fit("coulomb+load", recording, starts=2)
    >>> found.model.names[:3]
    ('viscous_friction', 'coulomb_friction', 'load_coulomb')
    >>> found.rmse_held_out < 0.2
    True
    """
    began = time.perf_counter()
    recording = with_weights(as_one(recording), weights)
    check_estimator(estimator, recording, passive=passive)
    made = Choices.of(choices).applied(model_for(spec, recording))
    plain = not (passive or made.stated.changes_the_search)
    uncertainty = Uncertainty(errors, resamples, seed, estimator == "ls" and plain)
    varied = named_per_run(per_run, made, recording)
    refuse_beside(varied, errors, estimator, passive=passive)
    searched = (starts, seed, effort.by(made.stated.algorithm))
    squares, solution = _least_squares(made, recording, transient, searched, uncertainty, began)
    if varied:
        return with_own_values(squares, solution, made, varied, searched, uncertainty)
    return refined(squares, solution, searched[2], estimator, passive)


def _least_squares(
    made: Model,
    recording: Recording,
    transient: NDArray[np.bool_] | None,
    searched: tuple[int, int, Effort],
    uncertainty: Uncertainty,
    began: float,
) -> tuple[Fit, Solution]:
    """The fit by least squares within bounds, and its solution."""
    starts, seed, effort = searched
    marked = rows_left_out(recording) if transient is None else _marks(transient, recording)
    rows = rows_to_fit(made, recording, marked)
    made, load = with_own_load(made, recording, rows, starts, seed, effort)
    solution = solve(made, recording, rows, load, starts, seed, effort)
    under: Under | None = None
    further: tuple[str, ...] = ()
    if made.stated.changes_the_search:
        free, problem = solution, Problem(recording, made, rows, solution.load)
        solution, under = solve_under(made, problem, free, uncertainty.errors, effort, seed)
        further = prior_conflicts(problem, free.values, under, uncertainty.errors)
        further += under.notes() if effort.evaluations else ()
    made, load = made.with_values(solution.values), solution.load
    seconds = time.perf_counter() - began
    fitted = finish(
        made, recording, marked, rows, load, solution, effort, uncertainty, seconds, under=under
    )
    return replace(fitted, notes=(*fitted.notes, *further)), solution


def _marks(transient: ArrayLike, recording: Recording) -> NDArray[np.bool_]:
    """Marks of the caller, one for each sample."""
    marked = np.asarray(transient)
    if marked.dtype != np.bool_ or marked.shape != (recording.rows,):
        raise SpecError(
            f"`transient` has shape {list(marked.shape)} and type {marked.dtype}: give an array of "
            f"True and False, one for each of the {recording.rows} samples"
        )
    return marked


def refined(
    squares: Fit, solution: Solution, effort: Effort, estimator: Estimator, passive: bool
) -> Fit:
    """The fit by least squares, or what was asked for from there."""
    squares = replace(squares, estimator="ls")
    if estimator == "iv":
        refuse_statements(squares.model, option("estimator", "iv"))
        return instrumented(squares, solution)
    return made_passive(squares, solution, effort) if passive else squares


def on_recording(fitted: Fit, given: Recordings | None, seed: int = 0) -> Fit:
    """Return `fitted`, or its model refitted if `given` is a different recording.

    A fit by instrumental variables is refitted as well: its errors are not those of least squares,
    with which effects are compared.
    """
    recording = None if given is None else as_one(given)
    if fitted.per_run:
        raise FitError(
            f"{', '.join(fitted.per_run)} of {fitted.model.spec} have a value in each run, and "
            f"effects are sought with one value of each parameter: fit without {option('per_run')}"
        )
    if recording is None or fitted.recording.is_measured_as(recording):
        recording = fitted.recording
    if recording is fitted.recording and fitted.estimator != "iv":
        return fitted
    return fit(fitted.model, recording, seed=seed)


def with_choices(
    fitted: Fit, choices: ChoiceArguments, later: Mapping[str, str], seed: int = 0
) -> Fit:
    """The model of `fitted` fitted again with further choices; `fitted` itself without any.

    Parameters
    ----------
    later
        Parameters that effects may bring later, as `Choices.applied` takes them.
    """
    said = Choices.of(choices)
    if said.is_empty:
        return fitted
    made = said.applied(fitted.model, later)
    return fit(made, fitted.recording, seed=seed, errors=fitted.errors, transient=fitted.transient)


def rows_to_fit(made: Model, recording: Recording, marked: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Indices of the samples to fit: moving and not transient.

    Raises `FitError` if there are fewer than the free parameters of the model plus two, and
    `RecordingError` if the channels contradict each other.
    """
    recording.require_consistent()
    rows = np.flatnonzero(recording.moving & ~marked)
    lower, upper, _ = scaled_bounds(made, recording)
    fewest = int((lower < upper).sum()) + 2
    if rows.size < fewest:
        raise FitError(
            f"{recording.path} has {rows.size} moving samples, {made.spec} needs at least "
            f"{fewest}: record more motion"
        )
    return rows
