"""Three experiments, one after another: temperature, load, presliding.

Tadese et al. 2021, section V-A. Without load, constant speeds at several temperatures give dry and
viscous friction (eqs 13, 20). With load, what these leave is fitted, each quadrant of speed and
load by itself (eq 15). Last, presliding gives stiffness and damping of the bristle.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.fitting.evaluate import evaluate
from stribeck.fitting.methods.estimates import estimates, reached_bounds
from stribeck.fitting.methods.least_squares import BoundedLeastSquares
from stribeck.fitting.methods.presliding import Presliding
from stribeck.fitting.operating_box import operating_box
from stribeck.fitting.result import Fit
from stribeck.identify.covariance import batches, correlation_length, sandwich, seen
from stribeck.identify.figures import rms
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import model_for
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

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
        What it identifies.
    data
        Path of its recording.
    parameters
        Names of the parameters that it gave.
    rows
        Rows that were fitted to.
    rmse
        Of what is left on them, in the unit of torque.
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

    def to_dict(self) -> dict[str, Any]:
        """The contract's JSON of `stribeck fit`, and the three steps."""
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

    Which parameters a step gives follows from the law: the first those that act on steady friction
    without load, the second those that act with it, the third stiffness and damping.

    Parameters
    ----------
    spec : str or Model
        ``"tadese_full"``, or another law and effects with load and bristle.
    no_load, loaded : Recording
        Steady-state points (`segment_points`): over the temperatures, and over
        the loads.
    presliding : Recording
        Position and torque while a slow torque below the Coulomb friction swings the joint, read
        with ``standstill=True``. Its longest stretch without a gap is used.
    damping_velocity : float
        Speed at which the bristle's damping has fallen to 1/e, rad/s or m/s, where the law has one:
        it is chosen and not identified, 0.001 rad/s by the paper (section IV).
    starts, seed : int
        Random starts of the nonlinear parameters in the first two steps.

    Returns
    -------
    ThreeStepFit
        `steps` tells the error that each step reached. Standard errors are those of a parameter's
        own step: what a step before it left open is not in them.

    Raises
    ------
    FitError
        A law that leaves a step without parameters; recordings that are not steady-state points;
        too few rows; a presliding log without position.

    Examples
    --------
    >>> names = ("temperature.csv", "load.csv")
    >>> warm, loaded = map(sb.read, names)  # doctest: +SKIP
    >>> small = sb.read("presliding.csv", standstill=True)  # doctest: +SKIP
    >>> fit = three_step_fit("tadese_full", warm, loaded, small)  # doctest: +SKIP
    """
    began = time.perf_counter()
    made = model_for(spec, loaded)
    warm, heavy = _steady(no_load, made), _steady(loaded, made)
    search = BoundedLeastSquares(made, loaded, starts, seed)
    if "damping_velocity" in made.names:
        search.start[made.names.index("damping_velocity")] = damping_velocity
    first, second, third = _groups(warm, heavy, search)
    values = search.solve(heavy, search.solve(warm, search.start, first), second)
    slow = Presliding(presliding, made, *_bristle(made, third))
    values, first_torque, evaluations = slow.fit(values)
    # The simplex knows no bounds: where it ended lies inside.
    lower, upper = np.minimum(search.lower, values), np.maximum(search.upper, values)
    made = replace(
        made,
        bounds={n: (float(a), float(b)) for n, a, b in zip(made.names, lower, upper, strict=True)},
        box=operating_box(made, loaded, None),
    ).with_values(values)
    steps = (
        _step("speed and temperature", warm, values, first),
        _step("load", heavy, values, second),
        Step(
            "presliding", presliding.path, tuple(made.names[k] for k in slow.searched),
            slow.target.size, rms(slow.target - slow.predict(values, first_torque)),
        ),
    )  # fmt: skip
    errors = _standard_errors(warm, values, first)
    errors[second] = _standard_errors(heavy, values, second)[second]
    fitted = _as_fit(made, loaded, errors, steps)
    return replace(
        fitted,
        starts=search.starts,
        evaluations=search.evaluations + evaluations,
        seconds=time.perf_counter() - began,
    )


def _steady(recording: Recording, made: Model) -> Problem:
    """`made` on steady-state points, whose bristle has settled.

    Raises
    ------
    FitError
        Where the recording is none of points, or has too few.
    """
    if not recording.averaged:
        raise FitError(
            f"{recording.path} does not hold steady-state points: make them with `stribeck points "
            f"{recording.path} --method segments --bins 10 -o points.csv`"
        )
    return Problem(recording, model_for(made, recording), np.flatnonzero(recording.moving))


def _groups(
    warm: Problem, heavy: Problem, search: BoundedLeastSquares
) -> tuple[Indices, Indices, Indices]:
    """Parameters of the three steps, by what they act on.

    Raises
    ------
    FitError
        Where a step is left without any.
    """
    made = warm.model
    # Neither a bound nor zero, where a parameter that acts may seem not to.
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
            f"{made.spec} has no parameter of {missing[0]}, and three steps need all of them: take "
            f"tadese_full, or add the effects load and presliding"
        )
    return groups


def _acting(problem: Problem, values: Array) -> NDArray[np.bool_]:
    """Which parameters act on the torque of the problem's rows, bool array [p]."""
    _, jacobian = problem.linearise(values)
    size = np.abs(jacobian * values).max(axis=0)
    return size > ACTS * np.abs(problem.target).max()


def _bristle(made: Model, third: Indices) -> tuple[int, int]:
    """Places of the bristle's stiffness and damping among the parameters.

    Raises
    ------
    FitError
        Where the law has another kind of state.
    """
    places = []
    for kind in ("_stiffness", "_damping"):
        found = [int(k) for k in third if made.names[k].endswith(kind)]
        if len(found) != 1:
            raise FitError(
                f"{made.spec} has no bristle with one stiffness and one damping, which the third "
                f"step identifies: take tadese_full, or add the effect presliding"
            )
        places.append(found[0])
    return places[0], places[1]


def _step(name: str, problem: Problem, values: Array, free: Indices) -> Step:
    residual, _ = problem.linearise(values, free)
    names = tuple(problem.model.names[k] for k in free)
    return Step(name, problem.recording.path, names, problem.rows.size, rms(residual))


def _standard_errors(problem: Problem, values: Array, free: Indices) -> Array:
    """Standard errors of the parameters `free` that the rows show, NaN for the others; [p]."""
    residual, jacobian = problem.linearise(values)
    chosen = np.zeros(values.size, dtype=bool)
    chosen[free] = True
    shown = seen(jacobian, chosen)
    batch = batches(residual.size, correlation_length(residual))
    variance = np.diag(sandwich(jacobian, residual, batch, shown))
    return np.where(shown, np.sqrt(variance), np.nan)


def _as_fit(made: Model, loaded: Recording, errors: Array, steps: Sequence[Step]) -> ThreeStepFit:
    """The fit on the loaded points: nothing there is held out, and the simplex has no errors."""
    known = ~np.isnan(errors)
    lower, upper = np.array([made.bounds[name] for name in made.names]).T
    shown = known | np.isin(made.names, steps[-1].parameters)
    unit = made.torque_unit
    notes = [
        f"step {k}, {step.name}: RMSE {step.rmse:.4g} {unit} over {step.rows} rows of {step.data}"
        for k, step in enumerate(steps, 1)
    ]
    fitted = evaluate(made, loaded)
    changed = {
        "estimates": estimates(
            made, errors, known & reached_bounds(made.values, lower, upper), shown
        ),
        "rmse_held_out": None,
        "relative_residual": None,
        "outcome": "three steps",
        "notes": (*notes, *fitted.notes),
    }
    return ThreeStepFit(
        **{**{f.name: getattr(fitted, f.name) for f in fields(Fit)}, **changed}, steps=tuple(steps)
    )
