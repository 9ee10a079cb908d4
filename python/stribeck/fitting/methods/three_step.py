"""Identification in three steps: temperature, load, presliding.

Tadese et al. 2021, section V-A. Without load, constant speeds at several temperatures give dry and
viscous friction (eqs 13, 20). With load, the residual is fitted, separately in each quadrant of
speed and load (eq 15). Last, presliding gives stiffness and damping of the bristle.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.fitting.evaluate import evaluate
from stribeck.fitting.methods.estimates import estimates, reached_bounds
from stribeck.fitting.methods.least_squares import BoundedLeastSquares
from stribeck.fitting.methods.presliding import Presliding
from stribeck.fitting.operating_box import box_of_all
from stribeck.fitting.result import Fit
from stribeck.identify.errors.covariance import batches, correlation_length, sandwich, seen
from stribeck.identify.figures import rms
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import model_for
from stribeck.identify.stated.choices import refuse_statements
from stribeck.models.model import Model
from stribeck.recording.recording import Recording
from stribeck.recording.weights import refuse_weights

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

#: A parameter acts on steady friction if its slope times its value exceeds this share of it.
ACTS = 1e-9


@dataclass(frozen=True)
class Step:
    """One of the three experiments.

    Attributes
    ----------
    name
        What the step identifies.
    data
        Path of its recording.
    parameters
        Names of the parameters that it identified.
    rows
        Number of samples of the fit.
    rmse
        RMSE of these samples, in the unit of torque.
    """

    name: str
    data: str
    parameters: tuple[str, ...]
    rows: int
    rmse: float


@dataclass(frozen=True, repr=False)
class ThreeStepFit(Fit):
    """A fit whose parameters come from three recordings; its errors are those of the loaded one."""

    steps: tuple[Step, ...] = ()

    def to_dict(self) -> dict[str, object]:
        """The JSON of a fit, and the three steps."""
        steps = [{**vars(step), "parameters": list(step.parameters)} for step in self.steps]
        return {**super().to_dict(), "steps": steps}


def three_step_fit(
    spec: str | Model,
    no_load: Recording,
    loaded: Recording,
    presliding: Recording,
    *,
    damping_velocity: float = 0.001,
    starts: int = 10,
    seed: int = 0,
) -> ThreeStepFit:
    """Identify a law with temperature, load and bristle in three steps.

    The first step identifies the parameters that act on steady friction without load, the second
    those that act with load, the third stiffness and damping of the bristle.

    Parameters
    ----------
    spec : str or Model
        ``"tadese_full"``, or another law and effects with load and bristle.
    no_load, loaded : Recording
        Steady-state points (`segment_points`) over temperatures, and over loads.
    presliding : Recording
        Motion under a slow alternating torque below the Coulomb friction, read with
        ``standstill=True``. Its longest segment without a gap is used.
    damping_velocity : float
        Speed at which the bristle's damping has fallen to 1/e, rad/s or m/s, if the law has one: it
        is not identified; 0.001 rad/s in the paper (section IV).
    starts, seed : int
        Random starts of the nonlinear parameters in the first two steps.

    Returns
    -------
    ThreeStepFit
        With the error of each step in `steps`. Standard errors are those of a parameter's own step,
        without the uncertainty of earlier steps.

    Raises
    ------
    FitError
        A step without parameters; recordings that are not steady-state points, or too short; a
        presliding recording without position.

    Examples
    --------
    >>> names = ("temperature.csv", "load.csv")
    >>> warm, loaded = map(sb.read, names)  # doctest: +SKIP
    >>> small = sb.read("presliding.csv", standstill=True)  # doctest: +SKIP
    >>> fit = three_step_fit("tadese_full", warm, loaded, small)  # doctest: +SKIP
    """
    refuse_weights("the method 'three_step'", no_load, loaded, presliding)
    began = time.perf_counter()
    made = model_for(spec, loaded)
    refuse_statements(made, "the method 'three_step'")
    search = BoundedLeastSquares(made, loaded, starts, seed)
    if "damping_velocity" in made.names:
        search.start[made.names.index("damping_velocity")] = damping_velocity
    fitted = _in_three_steps(made, no_load, loaded, presliding, search)
    return replace(fitted, seconds=time.perf_counter() - began)


def _in_three_steps(
    made: Model,
    no_load: Recording,
    loaded: Recording,
    presliding: Recording,
    search: BoundedLeastSquares,
) -> ThreeStepFit:
    warm, heavy = _steady(no_load, made), _steady(loaded, made)
    first, second, third = _groups(warm, heavy, search)
    values = search.solve(heavy, search.solve(warm, search.start, first), second)
    slow = Presliding(presliding, made, *_bristle(made, third))
    values, first_torque, evaluations = slow.fit(values)
    # The simplex has no bounds: they are widened to include its result.
    lower, upper = np.minimum(search.lower, values), np.maximum(search.upper, values)
    made = replace(
        made,
        bounds={n: (float(a), float(b)) for n, a, b in zip(made.names, lower, upper, strict=True)},
        box=box_of_all(made, (no_load, loaded, presliding)),
    ).with_values(values)
    steps = (
        _step("speed and temperature", warm, values, first),
        _step("load", heavy, values, second),
        _presliding_step(slow, values, first_torque),
    )
    errors = _standard_errors(warm, values, first)
    errors[second] = _standard_errors(heavy, values, second)[second]
    fitted = _as_fit(made, loaded, errors, steps)
    return replace(fitted, starts=search.starts, evaluations=search.evaluations + evaluations)


def _steady(recording: Recording, made: Model) -> Problem:
    """`made` on steady-state points, whose bristle has settled.

    Raises
    ------
    FitError
        The recording does not hold steady-state points.
    """
    if not recording.averaged:
        raise FitError(
            f"{recording.path} does not hold steady-state points: make them with `segment_points` "
            f"or the command `stribeck points`"
        )
    return Problem(recording, model_for(made, recording), np.flatnonzero(recording.moving))


def _groups(
    warm: Problem, heavy: Problem, search: BoundedLeastSquares
) -> tuple[Indices, Indices, Indices]:
    """Indices of the parameters of the three steps, by what they act on.

    Raises
    ------
    FitError
        A step has no parameter.
    """
    made = warm.model
    # Values that are neither a bound nor zero, where a parameter may have no effect.
    values = search.ranges.at(np.full(search.start.size, 0.6))
    free = search.upper > search.lower
    unloaded, loaded = _acting(warm, values) & free, _acting(heavy, values) & free
    groups = (
        np.flatnonzero(unloaded),
        np.flatnonzero(loaded & ~unloaded),
        np.flatnonzero(~loaded & ~unloaded & free),
    )
    missing = [
        what
        for what, group in zip(("steady friction", "the load", "a bristle"), groups, strict=True)
        if not group.size
    ]
    if missing:
        raise FitError(
            f"{made.spec} has no parameter of {missing[0]}, which the three steps need: use "
            f"tadese_full, or add the effects load and presliding"
        )
    return groups


def _acting(problem: Problem, values: Array) -> NDArray[np.bool_]:
    """Which parameters act on the torque of the problem's samples, bool array [p]."""
    _, jacobian = problem.linearise(values)
    size = np.abs(jacobian * values).max(axis=0)
    return size > ACTS * np.abs(problem.target).max()


def _bristle(made: Model, third: Indices) -> tuple[int, int]:
    """Indices of the bristle's stiffness and damping among the parameters.

    Raises
    ------
    FitError
        The law has another kind of state.
    """
    places = []
    for kind in ("_stiffness", "_damping"):
        found = [int(k) for k in third if made.names[k].endswith(kind)]
        if len(found) != 1:
            raise FitError(
                f"{made.spec} has no bristle with one stiffness and one damping, which the third "
                f"step identifies: use tadese_full, or add the effect presliding"
            )
        places.append(found[0])
    return places[0], places[1]


def _step(name: str, problem: Problem, values: Array, free: Indices) -> Step:
    residual, _ = problem.linearise(values, free)
    names = tuple(problem.model.names[k] for k in free)
    return Step(name, problem.recording.path, names, problem.rows.size, rms(residual))


def _presliding_step(slow: Presliding, values: Array, first_torque: float) -> Step:
    names = tuple(slow.model.names[k] for k in slow.searched)
    error = rms(slow.target - slow.predict(values, first_torque))
    return Step("presliding", slow.recording.path, names, slow.target.size, error)


def _standard_errors(problem: Problem, values: Array, free: Indices) -> Array:
    """Standard errors of the identifiable parameters among `free`, NaN for others; [p]."""
    residual, jacobian = problem.linearise(values)
    chosen = np.zeros(values.size, dtype=bool)
    chosen[free] = True
    shown = seen(jacobian, chosen)
    batch = batches(residual.size, correlation_length(residual))
    variance = np.diag(sandwich(jacobian, residual, batch, shown))
    return np.where(shown, np.sqrt(variance), np.nan)


def _as_fit(made: Model, loaded: Recording, errors: Array, steps: Sequence[Step]) -> ThreeStepFit:
    """The fit on the loaded points, without held-out error, or errors of the simplex."""
    known = ~np.isnan(errors)
    lower, upper = np.array([made.bounds[name] for name in made.names]).T
    shown = known | np.isin(made.names, steps[-1].parameters)
    unit = made.torque_unit
    notes = [
        f"step {k}, {step.name}: RMSE {step.rmse:.4g} {unit} over {step.rows} samples of "
        f"{step.data}"
        for k, step in enumerate(steps, 1)
    ]
    fitted = evaluate(made, loaded)
    changed = {
        "estimates": estimates(
            made, errors, known & reached_bounds(made.values, lower, upper), shown
        ),
        "rmse_held_out": None,
        "relative_residual": None,
        "rank": None,
        "outcome": "three steps",
        "notes": (*notes, *fitted.notes),
    }
    kept = {f.name: getattr(fitted, f.name) for f in fields(Fit) if f.init}
    return ThreeStepFit(**{**kept, **changed}, steps=tuple(steps))
