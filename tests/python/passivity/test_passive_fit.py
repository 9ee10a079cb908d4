"""Fits under conditions of passivity: proved, no dearer than they must be, refused in one line."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from click.testing import CliRunner
from numpy.typing import NDArray
from scipy.optimize import minimize
from stribeck.base.errors import FitError
from stribeck.cli.main import cli
from synthetic import motion, record

Array = NDArray[np.float64]


def recorded(
    folder: Path, friction: Callable[[Array, Array, Array], Array], rows: int = 1500
) -> sb.Recording:
    """A joint with this friction over time, velocity and load torque, and a little noise."""
    t, q, v, a = motion(rows)
    load = 4.0 * np.sin(1.9 * t + 1.0) + 2.0 * np.sin(0.7 * t)
    noise = 0.02 * np.random.default_rng(5).standard_normal(rows)
    frame = {
        "time": t,
        "position": q,
        "velocity": v,
        "acceleration": a,
        "load_torque": load,
        "torque": load + friction(t, v, load) + noise,
    }
    return record(folder, pl.DataFrame(frame))


def falling(_: Array, v: Array, load: Array) -> Array:
    """Friction that helps the motion between 1.2 and 2.2 rad/s."""
    return np.sign(v) * (1.0 - 1.2 * v * v + 0.45 * np.abs(v) ** 3)


def bristle(t: Array, v: Array, load: Array) -> Array:
    """A bristle so damped, over friction that falls so much, that it gives off energy."""
    truth = sb.model("lugre", a1=2000.0, a2=60.0, a3=0.3, a4=1.0, a5=1.8, a6=0.05, a7=2.0)
    return truth.torque(v, dt=t[1])


def is_proved(fitted: sb.Fit) -> bool:
    """Whether `check` proves the model as it is saved."""
    return sb.check(fitted.model).passive is True


@pytest.mark.slow
def test_bristle_is_proved_and_its_cost_is_said(tmp_path: Path) -> None:
    recording = recorded(tmp_path, bristle)
    free = sb.fit("lugre", recording, starts=2)
    assert free.passive() is False
    fitted = sb.fit("lugre", recording, starts=2, passive=True)
    assert is_proved(fitted)
    cost = fitted.passive_cost
    assert cost is not None
    assert cost.imposed
    assert (cost.rmse_free, cost.rmse_held_out_free) == (free.rmse, free.rmse_held_out)
    narrow = {"bristle_damping": (0.0, 20.0)}
    narrower = sb.fit("lugre", recording, starts=2, passive=True, bounds=narrow)
    assert free.rmse < fitted.rmse < narrower.rmse
    written = fitted.to_dict()
    assert written["passive"] is True
    assert written["passive_cost"]["conditions"] == cost.conditions > 0


def test_no_dearer_than_it_must_be(tmp_path: Path) -> None:
    """A polynomial that has to be positive on an interval, by another optimiser on a fine grid."""
    recording = recorded(tmp_path, falling)
    fitted = sb.fit("hao_a", recording, passive=True)
    assert is_proved(fitted)
    v = recording.velocity[fitted.rows]
    target = (recording.torque - recording.load_torque)[fitted.rows]
    powers = np.arange(4)
    columns = np.sign(v)[:, None] * np.abs(v)[:, None] ** powers
    low, high = fitted.model.box["velocity"]
    grid = np.linspace(0.0, max(-low, high), 400)[:, None] ** powers
    other = minimize(
        lambda x: np.mean((target - columns @ x) ** 2),
        [1.0, 0.0, 0.0, 0.0],
        jac=lambda x: -2.0 * columns.T @ (target - columns @ x) / target.size,
        bounds=[fitted.model.bounds[name] for name in fitted.model.names],
        constraints={"type": "ineq", "fun": lambda x: grid @ x, "jac": lambda x: grid},
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    )
    least = float(np.sqrt(np.mean((target - columns @ other.x) ** 2)))
    assert sb.fit("hao_a", recording).rmse < 0.95 * fitted.rmse
    own = float(np.sqrt(np.mean(fitted.residual[fitted.rows] ** 2)))
    assert own == pytest.approx(least, rel=2e-3)


def test_a_free_fit_that_is_passive_stays_as_it_is(tmp_path: Path) -> None:
    recording = recorded(tmp_path, lambda _, v, load: 2.0 * np.sign(v) + 0.5 * v)
    free, fitted = (sb.fit("coulomb", recording, passive=p) for p in (False, True))
    assert np.array_equal(free.model.values, fitted.model.values)
    assert free.passive_cost is None
    assert fitted.passive_cost is not None
    assert not fitted.passive_cost.imposed
    assert "costs nothing" in " ".join(repr(fitted).split())


def test_friction_that_depends_on_an_identified_rigid_body(tmp_path: Path) -> None:
    """The range of the load moves with the values; the proof is over the range at the end."""
    t, q, v, a = motion(1500)
    load = 2.0 * a + 6.0 * np.sin(q)
    friction = np.sign(v) * (0.6 - 0.06 * np.abs(load)) + 0.3 * v
    noise = 0.02 * np.random.default_rng(6).standard_normal(t.size)
    frame = {"time": t, "position": q, "velocity": v, "acceleration": a}
    recording = record(tmp_path, pl.DataFrame({**frame, "torque": load + friction + noise}))
    fitted = sb.fit("bam_m3", recording, passive=True, starts=2)
    assert fitted.model.rigid_body
    assert is_proved(fitted)


@pytest.mark.parametrize(
    ("law", "said"),
    [
        ("gaz_a", "no passive gaz_a was found within its bounds"),
        ("bliman_sorine", "bliman_sorine cannot be fitted as passive: no exact condition"),
        ("coulomb+stribeck+frictional_lag", "cannot be fitted as passive: no exact condition"),
    ],
)
def test_laws_without_a_proof_are_refused(tmp_path: Path, law: str, said: str) -> None:
    recording = recorded(tmp_path, lambda _, v, load: 1.2 * np.sign(v) + 0.2 * v + 0.3, 800)
    with pytest.raises(FitError, match=said) as refused:
        sb.fit(law, recording, passive=True, starts=2)
    assert "\n" not in str(refused.value)


def test_command(tmp_path: Path) -> None:
    recording = recorded(tmp_path, falling)
    asked = ["fit", recording.path, "--model", "hao_a", "--passive"]
    result = CliRunner().invoke(cli, [*asked, "--json"])
    assert result.exit_code == 0
    answer = json.loads(result.stdout)
    assert answer["passive"] is True
    assert answer["passive_cost"]["rmse_free"] < answer["rmse"]
    refused = CliRunner().invoke(cli, [*asked, "--method", "grid"])
    assert "--passive has no effect with --method grid" in str(refused.exception)
