"""Constraints and ties between parameters: against closed forms, and as constrained minima."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import stribeck as sb
from as_user import stribeck
from numpy.typing import NDArray
from scipy.optimize import minimize, nnls
from stribeck.identify.problem import Problem
from synthetic import joint, motion, record

Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve of 1.2 N m at 0.12 rad/s."""
    v = motion()[2]
    frame = joint(1.2 * np.exp(-np.abs(v / 0.12)) * np.sign(v))
    return record(tmp_path_factory.mktemp("stated"), frame)


def linear(recording: sb.Recording) -> tuple[Array, Array]:
    """Columns of viscous and Coulomb friction, and the friction torque, of the scored samples."""
    r = recording
    columns = np.column_stack([r.velocity, np.sign(r.velocity)])
    return columns[r.moving], (r.torque - r.load_torque)[r.moving]


def test_an_active_constraint_of_a_linear_law(recording: sb.Recording) -> None:
    """With viscous = Coulomb friction the sum of both columns has one parameter."""
    fitted = sb.fit("coulomb", recording, constraints="a1 >= a2", errors="independent")
    columns, torque = linear(recording)
    one = columns.sum(axis=1)
    value = one @ torque / (one @ one)
    rest = torque - value * one
    error = np.sqrt(rest @ rest / (rest.size - 1) / (one @ one))
    assert fitted.model.values == pytest.approx([value, value], rel=1e-10)
    assert [e.stderr for e in fitted.estimates.values()] == pytest.approx([error] * 2, rel=1e-8)
    (held,) = fitted.constraints
    assert held.active and held.slack == pytest.approx(0.0, abs=1e-9)
    assert any("active at the solution: a1 >= a2; standard errors are" in n for n in fitted.notes)


def test_a_constraint_that_holds_anyway_changes_nothing(recording: sb.Recording) -> None:
    free = sb.fit("coulomb", recording)
    fitted = sb.fit("coulomb", recording, constraints=["a2 >= a1"])
    assert fitted.model.values == pytest.approx(free.model.values, rel=1e-12)
    (held,) = fitted.constraints
    assert not held.active and held.slack == pytest.approx(-np.diff(free.model.values)[0] * -1)
    for name, e in free.estimates.items():
        assert fitted.estimates[name].stderr == pytest.approx(e.stderr, rel=1e-6)


CURVE = "c1*v + c2*sgn(v) + c3*exp(-abs(v)/c4)*sgn(v)"
CASES = [
    ("coulomb+stribeck", {"constraints": ["dFs <= 0.3*a2", "a1*a2 >= 3.7"]}),
    ("coulomb+stribeck", {"constraints": "vs*alpha >= 0.3"}),
    ("coulomb+stribeck", {"constraints": "a1 >= 1.3", "bounds": {"alpha": (0.9, 1.1)}}),
    ("coulomb+stribeck", {"constraints": "a1^2 + a2^2 <= 9", "ties": {"dFs": "0.5*a2"}}),
    (
        "lugre",
        {"constraints": ["a3 <= 0.9", "a4 <= 0.85*a5"], "bounds": {"a6": (0.02, 1.0)}},
    ),
    (CURVE, {"constraints": "exp(c1) >= 1.2*c2", "start": {"c4": 0.1}}),
    ("coulomb+stribeck", {"constraints": "a1 >= 1.25", "loss": "huber"}),
]


@pytest.mark.slow
@pytest.mark.parametrize(("spec", "said"), CASES)
def test_the_conditions_of_karush_kuhn_and_tucker(
    recording: sb.Recording, spec: str, said: dict[str, Any]
) -> None:
    """Computed here from finite differences of the constraints, and in the result."""
    fitted = sb.fit(spec, recording, starts=3, **said)
    assert fitted.converged, fitted.outcome
    assert fitted.to_dict()["kkt_residual"] <= 1e-8
    assert any(held.active for held in fitted.constraints)
    assert all(held.slack >= -1e-9 for held in fitted.constraints)
    problem = Problem(recording, fitted.model, fitted.rows, fitted.load)
    residual, jacobian = problem.linearise(fitted.model.values)
    if fitted.loss_weight is not None:
        root = np.sqrt(fitted.loss_weight[fitted.rows])
        residual, jacobian = residual * root, jacobian * root[:, None]
    region = fitted.under.region
    jacobian = jacobian @ region.directions(fitted.model.values)
    size = np.sqrt((jacobian**2).sum(axis=0))
    gradient = -(jacobian.T @ residual) / (size * np.sqrt(residual @ residual))
    values = fitted.model.values
    slopes = []
    for k, held in enumerate(fitted.constraints):
        if held.active:
            slopes.append(_differences(fitted, k, values) / size)
    for k, j in enumerate(region.free):
        for side, bound in ((1.0, region.lower[j]), (-1.0, region.upper[j])):
            if abs(values[j] - bound) <= 1e-9 * max(abs(bound), 1e-9):
                slopes.append(side * np.eye(region.free.size)[k])
    normals = np.array([slope / np.sqrt(slope @ slope) for slope in slopes]).T
    _, left = nnls(normals, gradient)
    assert left < 1e-7


def _differences(fitted: sb.Fit, k: int, values: Array) -> Array:
    """Slopes of a constraint by the free parameters, from central differences."""
    region, formula = fitted.under.region, fitted.under.formulas.formulas[k]
    made = np.zeros(region.free.size)
    for i, j in enumerate(region.free):
        ends = []
        for sign in (1.0, -1.0):
            moved = values.copy()
            moved[j] *= 1.0 + sign * 1e-6
            ends.append(formula.at(region.ties.filled(moved))[0])
        made[i] = (ends[0] - ends[1]) / (2e-6 * values[j])
    return made


def test_no_other_minimum_is_lower(recording: sb.Recording) -> None:
    """SciPy's SLSQP from many starts, on the same sum of squares."""
    fitted = sb.fit("coulomb+stribeck", recording, constraints="vs*alpha >= 0.3", starts=3)
    problem = Problem(recording, fitted.model, fitted.rows, fitted.load)
    lower, upper = fitted.under.region.lower, fitted.under.region.upper
    scale = float(problem.residual(fitted.model.values) @ problem.residual(fitted.model.values))

    def cost(values: Array) -> tuple[float, Array]:
        residual, jacobian = problem.linearise(values)
        return residual @ residual / scale, -2.0 * jacobian.T @ residual / scale

    rng = np.random.default_rng(3)
    for _ in range(6):
        start = np.clip(fitted.model.values * rng.uniform(0.5, 2.0, lower.size), lower, upper)
        end = minimize(
            cost,
            start,
            jac=True,
            method="SLSQP",
            bounds=list(zip(lower, upper, strict=True)),
            constraints={"type": "ineq", "fun": lambda x: x[3] * x[4] - 0.3},
            options={"maxiter": 300, "ftol": 1e-12},
        )
        assert end.fun > 1.0 - 1e-6


def test_a_tie_is_the_formula_with_the_parameter_replaced(recording: sb.Recording) -> None:
    tied = sb.fit(CURVE, recording, ties={"c3": "0.41*c2"}, start={"c4": 0.1})
    text = CURVE.replace("c3", "0.41*c2")
    written = sb.fit(text, recording, start={"c4": 0.1})
    assert tied.rmse == pytest.approx(written.rmse, rel=1e-9)
    for name in ("c1", "c2", "c4"):
        one, other = tied.estimates[name], written.estimates[name]
        assert one.value == pytest.approx(other.value, rel=1e-6)
        assert one.stderr == pytest.approx(other.stderr, rel=1e-4)
    c2, c3 = tied.estimates["c2"], tied.estimates["c3"]
    assert c3.value == 0.41 * c2.value and c3.stderr == pytest.approx(0.41 * c2.stderr)
    assert tied.to_dict()["ties"] == {"c3": "0.41*c2"}
    assert tied.rmse_held_out == pytest.approx(written.rmse_held_out, rel=1e-4)


def test_a_bound_of_a_tied_parameter_holds(recording: sb.Recording) -> None:
    fitted = sb.fit("coulomb+stribeck", recording, ties="dFs = 0.5*a2", bounds={"dFs": (0.0, 1.3)})
    assert fitted.model.value("stribeck_height") <= 1.3 + 1e-9
    assert fitted.model.value("coulomb_friction") == pytest.approx(2.6, abs=1e-6)


def test_passivity_and_a_constraint_at_once(tmp_path: Path) -> None:
    v = motion()[2]
    falling = np.sign(v) * (1.0 - 1.2 * v * v + 0.45 * np.abs(v) ** 3)
    frame = joint(falling - 3.0 * np.sign(v) - 1.2 * v)
    made = record(tmp_path, frame)
    law = "c1*sgn(v) + c2*v*abs(v) + c3*abs(v)^3*sgn(v)"
    passive = sb.fit(law, made, passive=True)
    both = sb.fit(law, made, passive=True, constraints="c1 <= 0.7")
    assert passive.model.value("c1") > 0.75
    assert both.model.value("c1") <= 0.7 + 1e-8
    assert sb.check(both.model).passive is True
    assert both.constraints[0].active


@pytest.mark.slow
def test_the_loop_keeps_them_in_force(recording: sb.Recording) -> None:
    limit = "stribeck_height <= 0.3*coulomb_friction"
    base = sb.fit("coulomb", recording)
    added = sb.add(base, "stribeck", constraints=limit)
    assert added.constraints[0].active
    found = sb.improve("coulomb", recording, constraints=limit, most_steps=1)
    model = found.final.model
    if "stribeck" in model.effects:
        assert model.value("stribeck_height") <= 0.3 * model.value("coulomb_friction") + 1e-6


@pytest.mark.parametrize(
    ("said", "sentence"),
    [
        ({"constraints": "a1 >= b"}, "'b' is not a parameter"),
        ({"constraints": "a1 > a2"}, "write one LEFT >= RIGHT"),
        ({"constraints": "a1 + a2"}, "write LEFT >= RIGHT"),
        ({"constraints": "a1 >= "}, "a value is missing"),
        ({"constraints": "2 >= 1"}, "has no parameter"),
        ({"constraints": "a1 >= a2 + 1e9"}, "hold the constraints (a1 >= a2 + 1e9)"),
        ({"ties": {"a1": "a2 >= 1"}}, "write a formula without a comparison"),
        ({"ties": {"a1": "2*a1"}}, "depends on itself"),
        ({"ties": {"a1": "2*a2", "a2": "a1"}}, "is tied too"),
        ({"ties": {"a1": "2*a2"}, "fix": {"a1": 1.0}}, "is tied: give it no start"),
        ({"ties": "a1"}, 'write `ties="NAME=FORMULA"`'),
        ({"loss": "absolute"}, "give squares or huber or cauchy"),
        ({"prior": {"a1": (1.0, 0.0)}}, "a standard deviation above 0"),
        ({"prior": {"a1": 1.0}}, "give (mean, standard deviation)"),
        ({"prior": "a1=1"}, 'write `prior="NAME=MEAN+-SD"`'),
        ({"prior": {"a9": (1.0, 1.0)}}, "no parameter 'a9'"),
        ({"loss": "huber", "estimator": "iv"}, "reference"),
        ({"loss": "huber", "errors": "profile"}, "errors"),
    ],
)
def test_what_cannot_be(recording: sb.Recording, said: dict[str, Any], sentence: str) -> None:
    with pytest.raises(sb.StribeckError, match=r"\w") as refusal:
        sb.fit("coulomb", recording, **said)
    assert sentence in str(refusal.value) and "\n" not in str(refusal.value)


@pytest.mark.slow
def test_the_command(recording: sb.Recording) -> None:
    fit = ["fit", recording.path, "--joint-kind", "revolute", "--model", "coulomb+stribeck"]
    fit += ["--constraint", "dFs <= 0.3*a2", "--tie", "alpha = 8*vs"]
    fit += ["--prior", "viscous_friction=1.25±0.05", "--loss", "huber"]
    made = json.loads(stribeck(*fit, "--json").stdout)
    assert made["constraints"][0]["constraint"] == "dFs <= 0.3*a2"
    assert made["constraints"][0]["active"] is True
    assert made["kkt_residual"] <= 1e-8 and made["loss"] == "huber" and made["loss_scale"] > 0.0
    assert made["priors"] == {"viscous_friction": [1.25, 0.05]}
    values = {name: row["value"] for name, row in made["parameters"].items()}
    assert values["stribeck_exponent"] == pytest.approx(8.0 * values["stribeck_velocity"])
    text = stribeck(*fit).stdout
    for line in ("constraint  dFs <= 0.3*a2", "tie", "prior", "loss", "huber"):
        assert line in text, text
    wrong = stribeck(*fit, "--tie", "a1")
    assert wrong.returncode == 2 and "write --tie NAME=FORMULA" in wrong.stderr


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--stream", "--loss", "huber"], "a fit to data read in passes does not take"),
        (["--method", "grid", "--loss", "huber"], "the method 'grid' does not take"),
    ],
)
def test_what_does_not_use_them_refuses_them(
    recording: sb.Recording, words: list[str], sentence: str
) -> None:
    fit = ["fit", recording.path, "--joint-kind", "revolute", "--model", "coulomb+stribeck"]
    done = stribeck(*fit, *words)
    assert done.returncode == 2 and done.stdout == ""
    assert sentence in done.stderr
