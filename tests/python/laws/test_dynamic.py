"""Laws with a memory against their differential equations and their exact steps."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import stribeck as sb
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from stribeck.models.catalog import catalog, law_ids
from stribeck.models.parameter import Parameter

from laws import dynamics, exact_steps
from laws.dynamics import DYNAMIC, Motion
from laws.exact_steps import EXACT
from laws.points import draw, draw_constants, generator
from laws.published import DYNAMIC_LAWS

Array = NDArray[np.float64]

DYNAMIC_IDS = [law for law in law_ids() if sb.model(law).has_state]

#: Sizes of sets: laws of several elements with one, some and many.
SPECS = [
    spec
    for law in DYNAMIC_IDS
    for spec in ((f"{law}:1", f"{law}:4", f"{law}:16") if law in ("gms", "leuven") else (law,))
]


def base(spec: str) -> str:
    """The law's id."""
    return spec.partition(":")[0]


def cases(*, exact: bool | None = None) -> list[Any]:
    """The specs that `exact_steps` holds, or that it does not, or all; 16 elements are slow."""
    wanted = [spec for spec in SPECS if exact is None or (base(spec) in EXACT) == exact]
    slow = pytest.mark.slow
    return [pytest.param(spec, marks=slow if spec.endswith(":16") else ()) for spec in wanted]


#: Deflection errors allowed, in multiples of max(D)/s0. The elastoplastic bristle has no closed
#: form: a fixed number of Runge-Kutta stages steps it.
DEFLECTION = {"elastoplastic": 1e-5}


def allowed(spec: str) -> float:
    return DEFLECTION.get(base(spec), 1e-8)


#: A real joint's part of the bounds, where a stiff solver takes seconds instead of hours.
PLAUSIBLE = {
    "bristle_stiffness": (1e2, 1e5),
    "dahl_exponent": (1.0, 3.0),
    "sliding_distance": (1e-3, 1e-1),
    "distance_ratio": (0.1, 0.9),
    "attraction": (1e1, 1e4),
    **{f"element_stiffness_{i}": (1e2, 1e4) for i in range(1, 17)},
    **{f"element_friction_{i}": (0.1, 10.0) for i in range(1, 17)},
}


def parameter_sets(spec: str, *, wide: bool = False) -> dict[str, dict[str, float]]:
    """Table 7 where it has the law, and drawn sets that keep the dry friction positive.

    `wide` draws between all of the catalog's bounds.
    """
    law = base(spec)
    sets = {"table 7": DYNAMIC_LAWS[law]} if law in DYNAMIC_LAWS else {}
    rng = generator(spec, "dynamic")
    table = sb.model(spec).parameters
    if not wide:
        table = tuple(replace_bounds(p) for p in table)
    while len(sets) < (8 if wide and not spec.endswith(":16") else 3):
        drawn = {p.symbol: draw(rng, p) for p in table}
        if least_dry(spec, drawn) > 0.1:
            sets[f"drawn {len(sets)}"] = drawn
    return sets


def vanishing_sets(spec: str) -> dict[str, dict[str, float]]:
    """Each parameter that may be 0 at 0: the end of its bounds, where a fit may come to rest."""
    drawn = parameter_sets(spec, wide=True)["drawn 1"]
    sets = {p.symbol: {**drawn, p.symbol: 0.0} for p in sb.model(spec).parameters if p.lower == 0}
    return {f"{name} = 0": values for name, values in sets.items() if least_dry(spec, values) > 0.1}


def replace_bounds(p: Parameter) -> Parameter:
    """The parameter between plausible bounds."""
    if p.name not in PLAUSIBLE:
        return p
    lower, upper = PLAUSIBLE[p.name]
    return replace(p, lower=lower, upper=upper, scale="none")


def least_dry(spec: str, parameters: dict[str, float]) -> float:
    """The smallest dry magnitude over the motion of `steps`."""
    motion, constants = steps(spec)
    p = SimpleNamespace(**parameters)
    return min(
        DYNAMIC[base(spec)].dry(v, p, motion.inputs(k, constants))
        for k, v in enumerate(motion.velocity.tolist())
    )


def steps(spec: str, count: int = 40) -> tuple[Motion, dict[str, float]]:
    """Speeds and steps over five decades, reversals, rests, and the constants of the law."""
    rng = generator(spec, "steps")
    velocity = rng.choice([-1.0, 1.0], count) * 10 ** rng.uniform(-4, 0.5, count)
    velocity[[5, 6, 12]] = 0.0
    velocity[7:11] = np.abs(velocity[7:11])
    others = {
        "T": rng.uniform(20, 40, count),
        "tl": rng.uniform(-20, 20, count),
        "tm": rng.uniform(-20, 20, count),
        "te": rng.uniform(-20, 20, count),
        "a": rng.uniform(-5, 5, count),
        "q": rng.uniform(-1, 1, count),
    }
    constants = draw_constants(rng, base(spec))
    return Motion(10 ** rng.uniform(-4, -1.5, count), velocity, others), constants


def made(spec: str, parameters: dict[str, float], constants: dict[str, float]) -> sb.Model:
    return sb.model(spec, constants=constants, **parameters)


def columns(motion: Motion) -> dict[str, Array]:
    """The motion as a model takes it."""
    return {
        "velocity": motion.velocity,
        "dt": motion.dt,
        "temperature": motion.others["T"],
        "load_torque": motion.others["tl"],
        "motor_torque": motion.others["tm"],
        "external_torque": motion.others["te"],
        "acceleration": motion.others["a"],
        "position": motion.others["q"],
    }


def test_every_law_with_a_memory_has_a_reference() -> None:
    missing = set(DYNAMIC_IDS) - set(DYNAMIC)
    assert not missing, f"no reference for {sorted(missing)}: write it in laws/dynamics.py"


@pytest.mark.parametrize("spec", cases())
def test_steps_solve_the_differential_equation(spec: str) -> None:
    motion, constants = steps(spec)
    for name, parameters in parameter_sets(spec).items():
        solved = dynamics.solve(DYNAMIC[base(spec)], parameters, motion, constants)
        torque = made(spec, parameters, constants).torque(**columns(motion))
        error = np.abs(torque - solved.torque) / solved.size
        assert np.all(error <= allowed(spec)), (name, int(np.argmax(error)), np.max(error))


@pytest.mark.parametrize("spec", cases(exact=True))
def test_steps_and_their_gradients_are_exact(spec: str) -> None:
    """Against the solution at 50 digits: 1e-11 of the size of the torque, gradients 1e-9 of their
    largest entry over the motion and of the torque per parameter."""
    check_steps_and_gradients(spec, parameter_sets(spec, wide=True))


#: Of GMS with 16 elements one that lies exactly at its limit, where the level begins to rise with
#: dFs, counts as slipping still: the slope is that from outside the bounds at that one point.
LIMITED = pytest.mark.xfail(
    strict=True, reason="an element exactly at its limit counts as slipping"
)


@pytest.mark.parametrize(
    "spec",
    [
        pytest.param(*case.values, marks=[*case.marks, *([LIMITED] * ("gms:16" in case.values))])
        for case in cases(exact=True)
    ],
)
def test_gradients_at_the_end_of_the_bounds(spec: str) -> None:
    """The same where parameters are 0."""
    check_steps_and_gradients(spec, vanishing_sets(spec))


def check_steps_and_gradients(spec: str, sets: dict[str, dict[str, float]]) -> None:
    motion, constants = steps(spec)
    for name, parameters in sets.items():
        model = made(spec, parameters, constants)
        symbols = [p.symbol for p in model.parameters]
        inside = {symbol: x or INSIDE for symbol, x in parameters.items()}
        duals = exact_steps.solve(EXACT[base(spec)], inside, motion, constants)
        value, slope = exact_steps.as_arrays(duals, symbols)
        size = np.max(np.abs(value)) + np.array([sensitivity(d, parameters) for d in duals])
        error = np.abs(model.torque(**columns(motion)) - value) / size
        assert np.all(error <= 1e-11), (name, int(np.argmax(error)), np.max(error))
        given = np.abs([parameters[s] for s in symbols])
        scale = np.max(np.abs(slope), axis=0) + np.max(size) / np.where(given > 0, given, np.inf)
        wrong = np.abs(model.gradient(**columns(motion)) - slope) / (scale + 1e-290)
        where = np.unravel_index(np.argmax(wrong), wrong.shape)
        assert np.all(wrong <= 1e-9), (name, symbols[where[1]], where[0], np.max(wrong))


@pytest.mark.parametrize("spec", cases(exact=True))
def test_steps_in_single_precision(spec: str) -> None:
    """2e-6 of the size of the torque and of the dry magnitudes it is made of, over 40 steps."""
    motion, constants = steps(spec)
    motion = Motion(
        rounded(motion.dt),
        rounded(motion.velocity),
        {letter: rounded(column) for letter, column in motion.others.items()},
    )
    constants = {name: float(rounded(x)) for name, x in constants.items()}
    for name, drawn in parameter_sets(spec).items():
        parameters = {symbol: float(rounded(x)) for symbol, x in drawn.items()}
        model = made(spec, parameters, constants)
        duals = exact_steps.solve(EXACT[base(spec)], parameters, motion, constants)
        value, _ = exact_steps.as_arrays(duals, list(parameters))
        roles = {row["symbol"]: row["role"] for row in catalog()["laws"][base(spec)]["parameters"]}
        dry = sum(abs(x) for symbol, x in parameters.items() if roles[symbol] == "dry")
        size = np.max(np.abs(value)) + dry
        size += np.array([sensitivity(d, parameters) for d in duals])
        torque = model.torque(**columns(motion), precision="single")
        error = np.abs(torque - value) / size
        assert np.all(error <= 2e-6), (name, int(np.argmax(error)), np.max(error))


def rounded(x: Any) -> Array:
    """In single precision."""
    return np.asarray(x, dtype=np.float32).astype(np.float64)


#: Stands for a parameter of 0 in the reference: a derivative at the end of the bounds is the one
#: from inside, where elements that reach their limit all at once at 0 do so one after the other.
INSIDE = 1e-30


def sensitivity(torque: exact_steps.Dual, parameters: dict[str, float]) -> float:
    """sum |p df/dp|: what relative errors of the parameters do to the torque."""
    return float(sum(abs(parameters[name] * d) for name, d in torque.slope.items()))


@pytest.mark.parametrize("spec", cases(exact=True))
def test_the_references_agree(spec: str) -> None:
    """Radau and the exact steps: neither shares a formula for the step with the other."""
    motion, constants = steps(spec, count=15)
    for parameters in parameter_sets(spec).values():
        solved = dynamics.solve(DYNAMIC[base(spec)], parameters, motion, constants)
        duals = exact_steps.solve(EXACT[base(spec)], parameters, motion, constants)
        value, _ = exact_steps.as_arrays(duals, list(parameters))
        assert np.max(np.abs(value - solved.torque) / solved.size) <= 5e-9


@pytest.mark.parametrize("spec", cases(exact=False))
def test_gradients_are_slopes_of_the_solution(spec: str) -> None:
    """Against difference quotients of Radau, where no closed form gives the derivative."""
    motion, constants = steps(spec, count=15)
    parameters = parameter_sets(spec)["drawn 1"]
    model = made(spec, parameters, constants)
    gradient = model.gradient(**columns(motion))
    for column, p in zip(gradient.T, model.parameters, strict=True):
        h = 1e-4 * parameters[p.symbol]
        high, low = (
            dynamics.solve(
                DYNAMIC[base(spec)],
                {**parameters, p.symbol: parameters[p.symbol] + d},
                motion,
                constants,
            )
            for d in (h, -h)
        )
        slope = (high.torque - low.torque) / (2 * h)
        allowed = 1e-3 * np.max(np.abs(slope)) + 1e-5 * high.size / parameters[p.symbol]
        assert np.all(np.abs(column - slope) <= allowed), p.symbol


#: The smooth motion: 0.05 rad at 1 Hz, compared at equal instants.
AMPLITUDE, OMEGA = 0.05, 2 * np.pi
DURATION, INSTANTS = 1.25, 500
#: Steps by thirds: a reversal in the middle of a coarse step is in the middle of a finer one, so
#: that its part of the error does not depend on where the grid happens to lie.
ROWS = (4000, 12000, 36000)
PHASE = OMEGA * (0.05 + 0.5 * DURATION / ROWS[0])


def position(t: Array) -> Array:
    return AMPLITUDE * np.sin(OMEGA * t - PHASE)


def speed(t: Array | float) -> Array:
    return AMPLITUDE * OMEGA * np.cos(OMEGA * t - PHASE)


def acceleration(t: Array | float) -> Array:
    return -AMPLITUDE * OMEGA**2 * np.sin(OMEGA * t - PHASE)


def smooth_torque(spec: str, parameters: dict[str, float], constants: dict[str, float]) -> Array:
    """Radau over the continuous motion, at equal instants."""
    law, p = DYNAMIC[base(spec)], SimpleNamespace(**parameters)

    def inputs(t: float) -> SimpleNamespace:
        return SimpleNamespace(**STILL, a=float(acceleration(t)), **constants)

    def velocity(t: float) -> float:
        return float(speed(t))

    times = np.linspace(0, DURATION, INSTANTS + 1)[1:]
    z = np.zeros(law.states(p))
    tolerance = 1e-10 * law.dry(velocity(0.0), p, inputs(0.0)) / law.stiffness(p)
    solved = solve_ivp(
        lambda t, z: law.rate(z, velocity(t), p, inputs(t)),
        (0.0, DURATION),
        z,
        method="Radau",
        rtol=1e-11,
        atol=tolerance,
        t_eval=times,
        max_step=0.02,
    )
    assert solved.success, solved.message
    return np.array(
        [
            law.torque(z, law.rate(z, velocity(t), p, inputs(t)), velocity(t), p, inputs(t))
            for t, z in zip(times, solved.y.T, strict=True)
        ]
    )


STILL = {"T": 30.0, "tl": 8.0, "tm": 9.0, "te": -8.0, "q": 0.0}


def sampled_torque(model: sb.Model, rows: int, *, mean: bool) -> Array:
    """The core over the sampled motion, at the instants of `smooth_torque`."""
    t = np.linspace(0, DURATION, rows + 1)
    dt = np.diff(t)
    torque = model.core.torque(
        model.values,
        dt,
        speed(t[1:]),
        acceleration=acceleration(t[1:]),
        position=np.zeros(rows),
        mean_velocity=np.diff(position(t)) / dt if mean else None,
        **{
            name: np.full(rows, STILL[letter])
            for name, letter in {
                "temperature": "T",
                "load_torque": "tl",
                "motor_torque": "tm",
                "external_torque": "te",
            }.items()
        },
    )
    return torque[rows // INSTANTS - 1 :: rows // INSTANTS]


@pytest.mark.parametrize("mean", [False, True], ids=["end of step", "mean velocity"])
@pytest.mark.parametrize("spec", cases())
def test_order_on_a_smooth_motion(spec: str, mean: bool) -> None:
    """First order in the step; second with the step's mean velocity.

    Against Radau over the continuous motion; for laws of several elements, which switch at
    instants that no solver meets, against their own steps 27 times finer than the finest. A level
    that moves while an element of GMS reaches it costs an error of first order there, so its
    second order is that of a constant level.
    """
    _, constants = steps(spec)
    for name, parameters in smooth_sets(spec).items():
        if mean and base(spec) == "gms":
            parameters["dFs"] = 0.0
        model = made(spec, parameters, constants)
        if DYNAMIC[base(spec)].switches is None:
            expected = smooth_torque(spec, parameters, constants)
        else:
            expected = sampled_torque(model, 27 * ROWS[-1], mean=True)
        errors = np.array(
            [
                np.sqrt(np.mean((sampled_torque(model, rows, mean=mean) - expected) ** 2))
                for rows in ROWS
            ]
        )
        order = np.log(errors[:-1] / errors[1:]) / np.log(3)
        above_the_solver = errors[1:] > 3e-9 * np.max(np.abs(expected))
        least = 1.8 if mean else 0.9
        assert np.all(order[above_the_solver] >= least), (name, errors.tolist(), order.tolist())
        assert above_the_solver[0] or mean


def smooth_sets(spec: str) -> dict[str, dict[str, float]]:
    """Parameters whose bristle the steps resolve."""
    return {
        k: v for k, v in parameter_sets(spec).items() if pace(spec, v) * DURATION / ROWS[0] < 0.3
    }


def pace(spec: str, parameters: dict[str, float]) -> float:
    """How fast the state moves at the largest speed of the smooth motion (1/s): s0 v/D.

    Dahl's turns back faster: from u = 2 the slope of |u|^a3 is a3 2^(a3 - 1). Bliman and Sorine
    give the distance itself; springs side by side add up.
    """
    _, constants = steps(spec)
    p, v = SimpleNamespace(**parameters), AMPLITUDE * OMEGA
    x = SimpleNamespace(**STILL, a=0.0, **constants)
    law = DYNAMIC[base(spec)]
    if base(spec) == "bliman_sorine":
        return v / (p.eta * p.eps)
    if base(spec) in ("gms", "leuven"):
        return float(np.sum(dynamics.elements(p)[1])) * v / law.dry(v, p, x)
    steepest = p.a3 * 2 ** (p.a3 - 1) if base(spec) == "dahl" else 1.0
    return steepest * law.stiffness(p) * v / law.dry(v, p, x)
