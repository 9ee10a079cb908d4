"""Identify a model's parameters on a recording."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.errors import FitError, StribeckError
from stribeck.identify.choices import Choices
from stribeck.identify.estimates import Errors, Estimate, estimates
from stribeck.identify.figures import relative_residual, rms, torque_cutoff
from stribeck.identify.held_out import Refit, held_out_prediction
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds as scaled_bounds
from stribeck.identify.scaling import check_channels, effect_constants, model_for
from stribeck.identify.search import QUICK, THOROUGH, Effort, Ended, multi_start, search_each
from stribeck.identify.separable import minimise
from stribeck.identify.transients import stretches, transient_rows
from stribeck.models.catalog import catalog
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

if TYPE_CHECKING:
    from stribeck.passivity.imposed import PassiveCost

__all__ = [
    "QUICK", "THOROUGH", "Effort", "Estimate", "Fit", "evaluate", "fit", "fit_each", "on_recording",
    "operating_box", "own_load",
]  # fmt: skip

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Fit:
    """A model identified on a recording.

    Attributes
    ----------
    prediction, held_out
        Predicted torque of every row: by the fit, and by the refit without the row's block.
    rmse, rmse_held_out
        Over the scored (moving) rows, in the unit of torque.
    passive_cost
        What passivity costs, where it was asked for.
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

    @property
    def residual(self) -> Array:
        """Measured minus predicted, every row."""
        return self.recording.torque - self.prediction

    @property
    def held_out_residual(self) -> Array:
        """Measured minus predicted by the refit that has not seen the row, every row."""
        return self.recording.torque - self.held_out

    @property
    def rows(self) -> NDArray[np.intp]:
        """The rows that the parameters were fitted to."""
        return np.flatnonzero(self.recording.moving & ~self.transient)

    @property
    def passive(self) -> bool | None:
        """Whether friction gives off no energy over the ranges seen; None where undecided."""
        from stribeck.passivity.check import check

        try:
            return check(self.model).passive
        except StribeckError:
            # A box over which the law has no limit, or a bristle without dry friction.
            return None

    def to_dict(self) -> dict[str, Any]:
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
            "passive": self.passive,
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

    def plot(self) -> Any:
        """Measured and modelled torque, and the residual, as a matplotlib figure."""
        from stribeck.report.figures import fit_figure

        return fit_figure(self)

    def __repr__(self) -> str:
        from stribeck.report.text import fit_text

        return fit_text(self)

    def _repr_html_(self) -> str:
        return str(self.to_frame()._repr_html_())


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
    rows = _rows_to_fit(made, recording, marked)
    made, load = _with_own_load(made, recording, rows, starts, seed, effort)
    solution = _identify(made, recording, rows, load, starts, seed, effort)
    values, load = solution.values, solution.load
    made = made.with_values(values)
    fitted = _finish(
        made, recording, marked, rows, load, solution, effort, errors, time.perf_counter() - began
    )
    return _made_passive(fitted, solution, effort) if passive else fitted


@dataclass(frozen=True)
class FittedStart:
    """Where one of several starts ended; its errors as in `Fit`."""

    model: Model
    rmse: float
    rmse_held_out: float | None
    converged: bool
    outcome: str
    evaluations: int

    @classmethod
    def of(cls, fitted: Fit) -> FittedStart:
        """The same of a fit by itself."""
        return cls(
            fitted.model, fitted.rmse, fitted.rmse_held_out, fitted.converged, fitted.outcome,
            fitted.evaluations,
        )  # fmt: skip


def fit_each(
    starts: Sequence[Model],
    recording: Recording,
    *,
    transient: NDArray[np.bool_],
    effort: Effort,
    seed: int = 0,
) -> list[FittedStart | StribeckError]:
    """Where several starts of one model end, or why there is no fit.

    Each start is brought to its own minimum; those that come together on fewer rows go on as one,
    and their outcome says with which.

    Parameters
    ----------
    starts : Models
        One model with different values; its nonlinear parameters lie between bounds.
    transient, effort, seed
        As of `fit`.

    Raises
    ------
    FitError
        As of `fit`, where no start could be fitted.
    """
    made = starts[0]
    rows = _rows_to_fit(made, recording, transient)
    if needs_own_load(made):
        # Each start finds a load of its own, and with it another problem.
        def alone(start: Model) -> FittedStart:
            return FittedStart.of(
                fit(start, recording, starts=1, seed=seed, transient=transient, effort=effort)
            )

        return [_said(partial(alone, start)) for start in starts]
    lower, upper, first = scaled_bounds(made, recording)
    values = np.stack([start.values for start in starts])
    at = np.where(np.isfinite(values), np.clip(values, lower, upper), first)
    ends = search_each(Problem(recording, made, rows), lower, upper, at, effort)

    def reached(end: Ended) -> FittedStart:
        values, search = end.search.values, end.search
        model = made.with_values(values)
        found = _Errors.of(Problem(recording, model, rows), values, lower, upper, effort)
        return FittedStart(
            model, found.rmse, found.rmse_held_out, search.converged, search.outcome,
            end.evaluations,
        )  # fmt: skip

    ended: dict[int, FittedStart | StribeckError] = {}
    fits = []
    for k, end in enumerate(ends):
        if end.leader == k:
            ended[k] = _said(partial(reached, end))
        fitted = ended[end.leader]
        if isinstance(fitted, FittedStart) and end.leader != k:
            outcome = f"came to where start {end.leader} went on: {fitted.outcome}"
            fitted = replace(fitted, outcome=outcome, evaluations=end.evaluations)
        fits.append(fitted)
    return fits


def _said(work: Callable[[], FittedStart]) -> FittedStart | StribeckError:
    try:
        return work()
    except StribeckError as error:
        return error


def _rows_to_fit(made: Model, recording: Recording, marked: NDArray[np.bool_]) -> NDArray[np.intp]:
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


def _made_passive(free: Fit, solution: _Solution, effort: Effort) -> Fit:
    """The fit under conditions of passivity; `free` itself where it is passive."""
    from stribeck.passivity.constrained import Conditioned
    from stribeck.passivity.imposed import PassiveCost, impose

    if free.passive:
        cost = PassiveCost(False, free.rmse, free.rmse_held_out, 0, 0.0)
        return replace(free, passive_cost=cost)
    began = time.perf_counter()
    recording, rows = free.recording, free.rows
    lower, upper = solution.lower, solution.upper

    def renewed(problem: Problem, values: Array) -> Problem:
        if not needs_own_load(free.model):
            return problem
        load = own_load(free.model.with_values(values), recording)
        return Problem(recording, free.model, rows, load)

    found = impose(
        Problem(recording, free.model, rows, free.load), solution.values,
        scaled_bounds(free.model, recording)[2], lower, upper,
        box_of=lambda at, load: operating_box(free.model.with_values(at), recording, load),
        renewed=renewed,
    )  # fmt: skip
    held = replace(
        solution,
        values=found.values,
        load=found.problem.load,
        converged=found.converged,
        outcome="converged under conditions of passivity" if found.converged else "not converged",
        evaluations=solution.evaluations + found.evaluations,
    )
    cost = PassiveCost(
        True, free.rmse, free.rmse_held_out, len(found.conditions.requirements),
        found.conditions.reserve,
    )  # fmt: skip
    seconds = free.seconds + time.perf_counter() - began
    fitted = _finish(
        free.model.with_values(found.values), recording, free.transient, rows, held.load, held,
        effort, free.errors, seconds, by=Conditioned(lower, upper, found.conditions),
    )  # fmt: skip
    return replace(fitted, passive_cost=cost)


@dataclass
class _Solution:
    values: Array
    load: Array | None
    lower: Array
    upper: Array
    starts: int
    converged: bool
    outcome: str
    evaluations: int


def own_load(model: Model, recording: Recording) -> Array | None:
    """Load torque of the rigid body that `model` has identified, every row; None without one."""
    if not model.rigid_body:
        return None
    load = np.zeros_like(recording.torque)
    if "inertia" in model.rigid_body and recording.acceleration is not None:
        load += model.value("inertia") * recording.acceleration
    gravity = _own_gravity(model, recording)
    return load if gravity is None else load + gravity


def _own_gravity(model: Model, recording: Recording) -> Array | None:
    """Gravity that `model` has identified, every row; None without one."""
    if "gravity" not in model.rigid_body or recording.position is None:
        return None
    cosine = model.value("gravity_cos") * np.cos(recording.position)
    return cosine + model.value("gravity_sin") * np.sin(recording.position)


def needs_own_load(model: Model) -> bool:
    return bool(model.rigid_body) and "load_torque" in model.core.needs


def _with_own_load(
    made: Model,
    recording: Recording,
    rows: NDArray[np.intp],
    starts: int,
    seed: int,
    effort: Effort,
) -> tuple[Model, Array | None]:
    """A first load torque from a fit of friction that does not depend on it."""
    if not needs_own_load(made):
        return made, None
    plain = made if np.all(np.isfinite(made.values)) else _without_load(made)
    if not np.all(np.isfinite(plain.values)):
        solved = _identify(plain, recording, rows, None, min(starts, 4), seed, effort)
        plain = plain.with_values(solved.values)
    load = own_load(plain, recording)
    constants = dict(made.constants)
    if "reference_load" not in constants or constants["reference_load"] == 1.0:
        constants.update(effect_constants("load", recording, load))
    return replace(made, constants=constants), load


def _without_load(model: Model) -> Model:
    """`model` without what depends on the load; where the law itself does, Coulomb and viscous."""
    table = catalog()["effects"]
    reading = [e for e in model.effects if "load_torque" in table[e]["channels"]]
    reading += [terms.name for terms in model.own if "load_torque" in terms.channels]
    for effect in reading:
        model = model.without_effect(effect)
    if "load_torque" in model.core.needs:
        model = replace(model, law="coulomb", own=(), effects=(), values=np.empty(0))
    return model


def _identify(
    made: Model,
    recording: Recording,
    rows: NDArray[np.intp],
    load: Array | None,
    starts: int,
    seed: int,
    effort: Effort,
) -> _Solution:
    """Best values; where friction depends on the identified rigid body, to a fixed point."""
    lower, upper, first = scaled_bounds(made, recording)
    known = made.values
    start = np.where(np.isfinite(known), np.clip(known, lower, upper), first)
    problem = Problem(recording, made, rows, load)
    # What is known stays where it is at the start; only the rest is searched at random.
    unknown = ~np.isfinite(known)
    varied = unknown if unknown.any() else np.ones_like(unknown)
    found, used, evaluations = multi_start(
        problem, lower, upper, start, varied, starts, seed, effort
    )
    if load is not None and needs_own_load(made):
        for _ in range(8):
            renewed = own_load(made.with_values(found.values), recording)
            assert renewed is not None
            moved = rms(renewed - load) / (rms(renewed) or 1.0)
            load = renewed
            found = minimise(
                Problem(recording, made, rows, load),
                found.values,
                lower,
                upper,
                tolerance=effort.tolerance,
            )
            evaluations += found.evaluations
            if moved < 1e-5:
                break
    return _Solution(
        found.values, load, lower, upper, used, found.converged, found.outcome, evaluations
    )


def on_recording(fitted: Fit, recording: Recording | None, seed: int = 0) -> Fit:
    """`fitted` itself, or its model fitted again where `recording` is another one."""
    if recording is None or recording is fitted.recording:
        return fitted
    return fit(fitted.model, recording, seed=seed)


def evaluate(
    model: Model,
    recording: Recording,
    *,
    fitted_on: str | None = None,
    stderr: Mapping[str, float] | None = None,
) -> Fit:
    """A model's error on a recording without refitting it.

    Parameters
    ----------
    fitted_on : str
        SHA-256 of the file that the model was fitted on; on that same file there is no
        held-out figure.
    """
    began = time.perf_counter()
    check_channels(model, recording)
    if recording.load_torque is not None and model.rigid_body:
        raise FitError(
            f"the model {model.spec} holds an identified rigid body, and {recording.path} gives "
            f"load_torque: use one of them (--map load_torque=... or a model fitted on such data)"
        )
    load = own_load(model, recording)
    problem = Problem(recording, model, np.flatnonzero(recording.moving), load)
    prediction = problem.predict(model.values)
    _refuse_infinite(problem, prediction)
    residual = recording.torque - prediction
    moving = recording.moving
    same = fitted_on is not None and fitted_on == recording.sha256
    stored = {
        p.name: Estimate(
            p.name, p.symbol, float(value), p.unit, (stderr or {}).get(p.name), None,
            False, True, *model.bounds.get(p.name, (-np.inf, np.inf)),
        )
        for p, value in zip(model.parameters, model.values, strict=True)
    }  # fmt: skip
    return Fit(
        model=model,
        recording=recording,
        estimates=stored,
        prediction=prediction,
        held_out=prediction,
        rmse=rms(residual[moving]),
        rmse_held_out=None if same else rms(residual[moving]),
        relative_residual=None if same else relative_residual(recording, residual),
        starts=0,
        converged=True,
        outcome="not refitted",
        evaluations=0,
        seconds=time.perf_counter() - began,
        transient=np.zeros(recording.time.size, dtype=bool),
        load=load,
    )


def _finish(
    made: Model,
    recording: Recording,
    marked: NDArray[np.bool_],
    rows: NDArray[np.intp],
    load: Array | None,
    solution: _Solution,
    effort: Effort,
    errors: Errors,
    seconds: float,
    by: Refit | None = None,
) -> Fit:
    problem = Problem(recording, made, rows, load)
    values = made.values
    lower, upper = solution.lower, solution.upper
    found = _Errors.of(problem, values, lower, upper, effort, by)
    notes: tuple[str, ...] = ()
    if marked.any():
        spans = ", ".join(f"{a:.1f}-{b:.1f} s" for a, b in stretches(recording, marked))
        notes = (
            f"no friction model explains the motion at {spans} (an approach move, an abrupt "
            f"stop?): scored, but not fitted to",
        )
    if made.rigid_body:
        notes += (f"identified together with the friction: {' and '.join(made.rigid_body)}",)
    held = [n for n, a, b in zip(made.names, lower, upper, strict=True) if a == b]
    if held:
        stated = ", ".join(f"{name} = {made.value(name):.6g}" for name in held)
        notes += (f"held, not identified: {stated}",)
    return Fit(
        model=replace(
            made,
            bounds={
                n: (float(a), float(b)) for n, a, b in zip(made.names, lower, upper, strict=True)
            },
            box=operating_box(made, recording, load),
        ).with_values(values),
        recording=recording,
        estimates=estimates(problem, values, lower, upper, errors),
        prediction=found.prediction,
        held_out=found.held_out,
        rmse=found.rmse,
        rmse_held_out=found.rmse_held_out,
        relative_residual=None
        if found.rmse_held_out is None
        else relative_residual(recording, recording.torque - found.held_out),
        starts=solution.starts,
        converged=solution.converged,
        outcome=solution.outcome,
        evaluations=solution.evaluations,
        seconds=seconds,
        transient=marked,
        load=load,
        notes=notes,
        errors=errors,
    )


@dataclass(frozen=True)
class _Errors:
    """What a model predicts, seen and unseen, and how far off that is."""

    prediction: Array
    held_out: Array
    rmse: float
    rmse_held_out: float | None

    @classmethod
    def of(
        cls,
        problem: Problem,
        values: Array,
        lower: Array,
        upper: Array,
        effort: Effort,
        by: Refit | None = None,
    ) -> _Errors:
        """Refuses a model without a finite torque, and a bristle around nothing."""
        recording = problem.recording
        prediction = problem.predict(values)
        _refuse_infinite(problem, prediction)
        if problem.model.has("presliding"):
            _refuse_slack_bristle(problem)
        held_out, _ = held_out_prediction(problem, values, lower, upper, exact=effort.exact, by=by)
        moving = recording.moving
        residual = recording.torque - held_out
        blocks = np.unique(recording.block[moving]).size
        has_held_out = blocks >= 2 and bool(np.all(np.isfinite(residual[moving])))
        counted = moving if recording.counted is None else moving & recording.counted
        rmse = rms((recording.torque - prediction)[moving])
        return cls(prediction, held_out, rmse, rms(residual[counted]) if has_held_out else None)


def _refuse_infinite(problem: Problem, prediction: Array) -> None:
    """Refuse a model whose torque is not a number somewhere, with the place."""
    wrong = np.flatnonzero(~np.isfinite(prediction))
    if wrong.size == 0:
        return
    model, recording = problem.model, problem.recording
    row = wrong[0]
    values = ", ".join(f"{n} = {v:.6g}" for n, v in zip(model.names, model.values, strict=True))
    advice = "give other starts or bounds (--start, --bound)" if model.own else "check them"
    raise FitError(
        f"{model.spec} predicts no finite torque on {recording.path} at t = "
        f"{recording.time[row]:.6g} s (velocity {recording.velocity[row]:.6g} "
        f"{recording.position_unit}/s) with {values}: {advice}"
    )


def _refuse_slack_bristle(problem: Problem) -> None:
    """A bristle needs a dry friction D > 0 wherever the joint has been; refuse it with the point.

    Where D <= 0 the bristle's deflection has no bound (physics of the bristle: |z| <= D/s0).
    """
    recording, moving = problem.recording, problem.recording.moving
    channels = {
        name: column[moving]
        for name in ("position", "acceleration", "temperature")
        if (column := getattr(recording, name)) is not None
    }
    load = problem.load if recording.load_torque is None else recording.load_torque
    if load is not None:
        channels["load_torque"] = load[moving]
    dry = problem.model.split(recording.velocity[moving], **channels)["dry"]
    worst = int(np.argmin(dry))
    if dry[worst] <= 0:
        velocity = recording.velocity[moving][worst]
        raise FitError(
            f"{problem.model.spec} has a bristle, but its dry friction is {dry[worst]:.3g} "
            f"{problem.model.torque_unit} at t = {recording.time[moving][worst]:.4g} s (velocity "
            f"{velocity:.3g} {recording.position_unit}/s): leave the bristle or the effect that "
            f"makes it negative out"
        )


def operating_box(
    model: Model, recording: Recording, load: Array | None
) -> dict[str, tuple[float, float]]:
    """Ranges of the channels over the scored rows: where the model has been seen."""
    moving = recording.moving
    given = recording.load_torque is not None
    channels = {
        "velocity": recording.velocity,
        "position": recording.position,
        "acceleration": recording.acceleration,
        "temperature": recording.temperature,
        "load_torque": recording.load_torque if given else load,
    }
    if "motor_torque" in model.core.needs and recording.drive is None:
        beside = recording.load_torque if given and not recording.torque_holds_load else None
        channels["motor_torque"] = recording.torque if beside is None else recording.torque + beside
    if "external_torque" in model.core.needs:
        gravity = _own_gravity(model, recording)
        channels["external_torque"] = recording.external_torque if gravity is None else -gravity
    return {
        name: (float(column[moving].min()), float(column[moving].max()))
        for name, column in channels.items()
        if column is not None and moving.any()
    }
