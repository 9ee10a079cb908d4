"""Fits: known parameters come back, with honest errors, the same bits every time."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from scipy.stats import binom
from synthetic import COULOMB, VISCOUS, ar1, joint, motion, record


def stribeck_part(v: np.ndarray, height: float = 2.0, speed: float = 0.15) -> np.ndarray:
    """Dry friction that falls with speed, exponent 1.5."""
    return height * np.exp(-((np.abs(v) / speed) ** 1.5)) * np.sign(v)


@pytest.fixture(scope="module")
def curved(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve."""
    v = motion()[2]
    return record(tmp_path_factory.mktemp("curved"), joint(stribeck_part(v)))


def test_linear_parameters_come_back(plain: sb.Recording) -> None:
    fit = sb.fit("coulomb", plain)
    for name, truth in (("coulomb_friction", COULOMB), ("viscous_friction", VISCOUS)):
        estimate = fit.estimates[name]
        assert estimate.stderr is not None and estimate.stderr < 0.01 * truth
        assert abs(estimate.value - truth) < 5.0 * estimate.stderr
        assert estimate.identifiable and not estimate.at_bound
    assert fit.rmse == pytest.approx(0.03, rel=0.05)
    assert fit.rmse_held_out == pytest.approx(fit.rmse, rel=0.02)
    assert fit.converged and fit.starts == 1


def test_linear_fit_is_numpys(plain: sb.Recording) -> None:
    """The measured torque less the load torque, on moving rows, as recorded."""
    fit = sb.fit("coulomb+offset", plain)
    rows = fit.rows
    np.testing.assert_array_equal(rows, np.flatnonzero(plain.moving))
    v = plain.velocity[rows]
    columns = np.column_stack([v, np.sign(v), np.ones_like(v)])
    expected = np.linalg.lstsq(columns, (plain.torque - plain.load_torque)[rows], rcond=None)[0]
    value = [fit.estimates[n].value for n in ("viscous_friction", "coulomb_friction", "offset")]
    np.testing.assert_allclose(value, expected, rtol=1e-9)


def test_stribeck_curve_comes_back(curved: sb.Recording) -> None:
    fit = sb.fit("coulomb+stribeck", curved)
    truth = {
        "coulomb_friction": COULOMB,
        "viscous_friction": VISCOUS,
        "stribeck_height": 2.0,
        "stribeck_velocity": 0.15,
        "stribeck_exponent": 1.5,
    }
    for name, value in truth.items():
        estimate = fit.estimates[name]
        assert estimate.stderr is not None, name
        assert abs(estimate.value - value) < 4.5 * estimate.stderr, name
        assert estimate.value == pytest.approx(value, rel=0.1), name
    assert fit.rmse == pytest.approx(0.03, rel=0.05)


def test_any_seed_finds_the_optimum(curved: sb.Recording) -> None:
    """The starts of five seeds end where scipy ends from the truth."""
    from scipy.optimize import least_squares

    v = curved.velocity[curved.moving]
    target = (curved.torque - curved.load_torque)[curved.moving]

    def error(p: np.ndarray) -> np.ndarray:
        curve = p[2] * np.exp(-((np.abs(v) / p[3]) ** p[4]))
        return (p[1] + curve) * np.sign(v) + p[0] * v - target

    best = least_squares(error, [VISCOUS, COULOMB, 2.0, 0.15, 1.5], xtol=1e-14, ftol=1e-14)
    optimum = np.sqrt(2.0 * best.cost / v.size)
    for seed in range(5):
        found = sb.fit("coulomb+stribeck", curved, seed=seed).rmse
        assert found == pytest.approx(optimum, rel=1e-7), seed


def test_bristle_comes_back(tmp_path: Path) -> None:
    """Presliding made by integrating the bristle in fine Euler steps."""
    rows, fine, stiffness = 3000, 40, 150.0
    v = motion(rows * fine, 100.0 * fine)[2]
    z, deflection = 0.0, np.empty(rows * fine)
    for k, speed in enumerate(v.tolist()):
        z += (speed - stiffness * abs(speed) / COULOMB * z) / (100.0 * fine)
        deflection[k] = z
    extra = (stiffness * deflection - COULOMB * np.sign(v))[::fine]
    fit = sb.fit("coulomb+presliding", record(tmp_path, joint(extra, rows=rows)))
    assert fit.estimates["presliding_stiffness"].value == pytest.approx(stiffness, rel=0.1)
    assert fit.rmse == pytest.approx(0.03, rel=0.1)


def test_rigid_body_is_identified_when_no_load_is_given(tmp_path: Path) -> None:
    t, q, v, a = motion()
    inertia, cos, sin = 0.8, 5.0, -2.0
    rng = np.random.default_rng(5)
    torque = inertia * a + cos * np.cos(q) + sin * np.sin(q) + COULOMB * np.sign(v) + VISCOUS * v
    frame = (
        joint()
        .drop("load_torque")
        .with_columns(torque=pl.Series(torque + 0.03 * rng.standard_normal(t.size)))
    )
    recording = record(tmp_path, frame)
    fit = sb.fit("coulomb", recording)
    assert fit.model.rigid_body == ("inertia", "gravity")
    truth = {
        "inertia": inertia,
        "gravity_cos": cos,
        "gravity_sin": sin,
        "coulomb_friction": COULOMB,
        "viscous_friction": VISCOUS,
    }
    for name, value in truth.items():
        estimate = fit.estimates[name]
        assert estimate.stderr is not None
        assert abs(estimate.value - value) < 5.0 * estimate.stderr + 1e-3, name
    assert any("inertia" in note for note in fit.to_dict()["notes"])
    # Given as friction torque it is friction alone.
    friction = frame.with_columns(friction_torque=pl.col("torque")).drop("torque")
    assert sb.fit("coulomb", record(tmp_path, friction, "friction")).model.rigid_body == ()
    with pytest.raises(sb.StribeckError, match="inertia"):
        sb.fit("coulomb+inertia+load", recording, starts=1).model.with_effect("inertia", {})


def test_inertia_of_a_prismatic_joint_comes_without_gravity(tmp_path: Path) -> None:
    recording = record(tmp_path, joint().drop("load_torque"), joint_kind="prismatic")
    fit = sb.fit("coulomb", recording, starts=2)
    assert fit.model.rigid_body == ("inertia",)
    assert fit.estimates["inertia"].unit == "kg"


def test_bounds_that_are_reached_are_said(tmp_path: Path) -> None:
    """A joint whose friction falls with speed has no viscous friction to find."""
    v = motion()[2]
    fit = sb.fit("coulomb", record(tmp_path, joint(-1.5 * VISCOUS * v)))
    viscous = fit.estimates["viscous_friction"]
    assert viscous.value == 0.0 and viscous.at_bound and viscous.stderr is None
    assert viscous.ci95 is None
    assert not fit.estimates["coulomb_friction"].at_bound
    assert fit.to_dict()["parameters"]["viscous_friction"]["at_bound"] is True


def test_what_the_data_cannot_show_is_said(tmp_path: Path) -> None:
    """Moving one way, an offset is Coulomb friction; at one speed viscous friction is too."""
    frame = joint()
    t = frame["time"].to_numpy()
    v = 0.5 + 0.4 * np.sin(1.3 * t)
    noise = 0.03 * np.random.default_rng(0).standard_normal(t.size)
    one_way = frame.drop("acceleration").with_columns(
        position=pl.Series(0.5 * t - 0.4 / 1.3 * np.cos(1.3 * t)),
        velocity=pl.Series(v),
        load_torque=pl.lit(0.0),
        torque=pl.Series(COULOMB + VISCOUS * v + noise),
    )
    fit = sb.fit("coulomb+offset", record(tmp_path, one_way))
    for name in ("coulomb_friction", "offset"):
        assert not fit.estimates[name].identifiable, name
        assert fit.estimates[name].stderr is None
    assert fit.estimates["viscous_friction"].identifiable
    assert fit.rmse == pytest.approx(0.03, rel=0.1)


@pytest.mark.slow
def test_standard_errors_cover_under_noise_with_a_memory(tmp_path: Path) -> None:
    """AR(1) noise, rho 0.9, 60 recordings: 95 % intervals hold the truth in about 95 % of them."""
    trials, held = 60, {"coulomb_friction": 0, "viscous_friction": 0, "stribeck_height": 0}
    truth = {"coulomb_friction": COULOMB, "viscous_friction": VISCOUS, "stribeck_height": 2.0}
    v = motion()[2]
    for seed in range(trials):
        frame = joint(stribeck_part(v), seed=seed, noise=0.15, rho=0.9)
        fit = sb.fit("coulomb+stribeck", record(tmp_path, frame, f"r{seed}"), starts=3)
        for name in held:
            interval = fit.estimates[name].ci95
            held[name] += interval is not None and interval[0] <= truth[name] <= interval[1]
    fewest = int(binom.ppf(0.001, trials, 0.95))
    assert min(held.values()) >= fewest, held


@pytest.mark.slow
def test_linear_standard_errors_cover_under_noise_with_a_memory(tmp_path: Path) -> None:
    """The same for a linear model; white-noise formulas would cover about half."""
    trials, covered, naive = 60, 0, 0
    for seed in range(trials):
        fit = sb.fit("coulomb", record(tmp_path, joint(seed=seed, noise=0.15, rho=0.9)))
        estimate = fit.estimates["viscous_friction"]
        assert estimate.ci95 is not None
        covered += estimate.ci95[0] <= VISCOUS <= estimate.ci95[1]
        v = fit.recording.velocity[fit.rows]
        columns = np.column_stack([v, np.sign(v)])
        error = fit.rmse * np.sqrt(np.linalg.inv(columns.T @ columns)[0, 0])
        naive += abs(estimate.value - VISCOUS) <= 1.96 * error
    assert covered >= int(binom.ppf(0.001, trials, 0.95))
    assert naive < covered


def test_held_out_is_a_refit_without_each_block(plain: sb.Recording) -> None:
    fit = sb.fit("coulomb+offset", plain)
    v = plain.velocity
    columns = np.column_stack([v, np.sign(v), np.ones_like(v)])
    target = plain.torque - plain.load_torque
    predicted = np.empty_like(target)
    assert plain.block_count == 10
    for block in range(plain.block_count):
        kept = plain.moving & (plain.block != block)
        values = np.linalg.lstsq(columns[kept], target[kept], rcond=None)[0]
        rows = plain.block == block
        predicted[rows] = columns[rows] @ values
    error = np.sqrt(np.mean((target - predicted)[plain.moving] ** 2))
    assert fit.rmse_held_out == pytest.approx(error, rel=1e-9)
    np.testing.assert_allclose(
        fit.held_out[plain.moving] - plain.load_torque[plain.moving],
        predicted[plain.moving],
        rtol=1e-9,
    )


def test_held_out_of_a_nonlinear_model_is_near_a_full_refit(curved: sb.Recording) -> None:
    """Gauss-Newton from the solution on all rows reaches what scipy finds from there."""
    from scipy.optimize import least_squares

    fit = sb.fit("coulomb+stribeck", curved)
    target = curved.torque - curved.load_torque
    v, block, square, count = curved.velocity, curved.block, 0.0, 0

    def formula(p: np.ndarray, rows: np.ndarray) -> np.ndarray:
        curve = p[2] * np.exp(-((np.abs(v[rows]) / p[3]) ** p[4]))
        return (p[1] + curve) * np.sign(v[rows]) + p[0] * v[rows]

    start = [
        fit.estimates[n].value
        for n in (
            "viscous_friction",
            "coulomb_friction",
            "stribeck_height",
            "stribeck_velocity",
            "stribeck_exponent",
        )
    ]
    for b in range(curved.block_count):
        kept, out = curved.moving & (block != b), curved.moving & (block == b)
        solved = least_squares(lambda p: formula(p, kept) - target[kept], start, xtol=1e-12)  # noqa: B023
        square += float(np.sum((target[out] - formula(solved.x, out)) ** 2))
        count += int(out.sum())
    assert fit.rmse_held_out == pytest.approx(np.sqrt(square / count), rel=1e-5)


def test_whole_runs_are_held_out(tmp_path: Path) -> None:
    frame = joint()
    runs = np.arange(frame.height) * 6 // frame.height
    recording = record(tmp_path, frame.with_columns(run=pl.Series(runs)))
    assert recording.block_count == 6
    np.testing.assert_array_equal(recording.block, runs)


def test_seed_gives_the_same_bits(curved: sb.Recording) -> None:
    first, second = (sb.fit("coulomb+stribeck", curved, starts=4, seed=7) for _ in range(2))
    assert first.model.values.tobytes() == second.model.values.tobytes()
    assert first.prediction.tobytes() == second.prediction.tobytes()
    assert first.held_out.tobytes() == second.held_out.tobytes()


THREADS = """
import json, sys
import stribeck as sb
r = sb.read(sys.argv[1], joint_kind="revolute")
f = sb.fit("coulomb+stribeck+load", r, starts=3)
print(json.dumps([f.model.values.tobytes().hex(), f.rmse.hex(), f.rmse_held_out.hex(),
                  [e.stderr.hex() for e in f.estimates.values() if e.stderr is not None]]))
"""


@pytest.mark.slow
def test_number_of_threads_changes_nothing(tmp_path: Path) -> None:
    v = motion()[2]
    path = tmp_path / "made.parquet"
    joint(stribeck_part(v), rows=3000).write_parquet(path)
    answers = []
    for threads in ("1", "2"):
        names = (
            "OPENBLAS_NUM_THREADS",
            "OMP_NUM_THREADS",
            "POLARS_MAX_THREADS",
            "RAYON_NUM_THREADS",
        )
        done = subprocess.run(
            [sys.executable, "-c", THREADS, str(path)],
            env={**os.environ, **dict.fromkeys(names, threads)},
            capture_output=True,
            text=True,
            timeout=120,
        )
        assert done.returncode == 0, done.stderr
        answers.append(json.loads(done.stdout))
    assert answers[0] == answers[1]


def test_measured_torque_is_the_target_as_recorded(tmp_path: Path) -> None:
    """Noise that a filter would take out stays in the error."""
    rng = np.random.default_rng(2)
    frame = joint(0.2 * rng.standard_normal(3000), noise=0.0)
    recording = record(tmp_path, frame)
    np.testing.assert_array_equal(recording.torque, frame["torque"].to_numpy())
    fit = sb.fit("coulomb", recording)
    assert fit.rmse == pytest.approx(0.2, rel=0.05)
    np.testing.assert_array_equal(fit.residual, recording.torque - fit.prediction)
    moving = recording.moving
    assert fit.rmse == pytest.approx(np.sqrt(np.mean(fit.residual[moving] ** 2)), rel=1e-12)


def test_model_values_are_the_first_start(curved: sb.Recording) -> None:
    fit = sb.fit("coulomb+stribeck", curved)
    again = sb.fit(fit.model, curved, starts=1)
    np.testing.assert_allclose(again.model.values, fit.model.values, rtol=1e-4)


def test_contract_keys(plain: sb.Recording) -> None:
    answer = json.loads(json.dumps(sb.fit("coulomb", plain).to_dict()))
    assert {
        "model",
        "parameters",
        "rmse",
        "rmse_held_out",
        "relative_residual",
        "starts",
        "converged",
        "evaluations",
        "seconds",
        "passive",
        "scored",
    } <= set(answer)
    for row in answer["parameters"].values():
        assert {"symbol", "value", "unit", "stderr", "ci95", "at_bound", "identifiable"} <= set(row)
    assert set(answer["scored"]) == {"rows", "share", "velocity_threshold"}


def test_unusable_fits_are_refused(plain: sb.Recording, tmp_path: Path) -> None:
    cold = record(tmp_path, joint(rows=500).drop("temperature"), "cold")
    with pytest.raises(sb.FitError, match="temperature"):
        sb.fit("coulomb+temperature_dry", cold)
    with pytest.raises(sb.SpecError, match="did you mean 'coulomb'"):
        sb.fit("coulom", plain)


def test_evaluate_does_not_refit(plain: sb.Recording, tmp_path: Path) -> None:
    m = sb.model("coulomb", coulomb_friction=1.0, viscous_friction=0.0)
    judged = sb.evaluate(m, plain)
    v, moving = plain.velocity, plain.moving
    error = (plain.torque - plain.load_torque - np.sign(v))[moving]
    assert judged.rmse == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-12)
    assert judged.rmse_held_out == judged.rmse
    assert judged.model.values.tobytes() == m.values.tobytes()
    assert sb.evaluate(m, plain, fitted_on=plain.sha256).rmse_held_out is None


def test_noise_has_the_memory_it_says() -> None:
    """The noise used above is what it says it is."""
    x = ar1(np.random.default_rng(0), 200_000, 0.9, 0.5)
    assert x.std() == pytest.approx(0.5, rel=0.03)
    assert np.corrcoef(x[1:], x[:-1])[0, 1] == pytest.approx(0.9, abs=0.01)


def test_more_parameters_than_the_data_shows_do_not_spoil_the_held_out_error(
    plain: sb.Recording,
) -> None:
    """Exponentials that cancel, a sigmoid steeper than the samples: still Coulomb friction."""
    simple = sb.fit("coulomb", plain).rmse_held_out
    for law in ("dong", "gaz_a", "makkar"):
        assert sb.fit(law, plain, starts=4).rmse_held_out == pytest.approx(simple, rel=0.02), law


def test_motoring_and_generating_friction_are_told_apart_by_the_motor_torque(
    tmp_path: Path,
) -> None:
    """Only the sign of the recorded torque goes in: the same fit with its size thrown away."""
    frame = joint()
    driven = frame["load_torque"] * frame["velocity"].sign() < -5.0
    recording = record(
        tmp_path, frame.with_columns(torque=frame["torque"] - frame["velocity"].sign() * driven)
    )
    fit = sb.fit("clochiatti", recording)
    signs = np.sign(recording.torque)
    shifted = fit.model.torque(recording.velocity, motor_torque=100.0 * signs)
    np.testing.assert_allclose(shifted, fit.prediction - recording.load_torque, atol=1e-12)
    assert fit.estimates["coulomb_friction_motoring"].value == pytest.approx(COULOMB, rel=0.05)
    generating = fit.estimates["coulomb_friction_generating"].value
    assert generating < fit.estimates["coulomb_friction_motoring"].value - 0.5


def test_a_law_of_the_load_finds_the_load_by_itself(tmp_path: Path) -> None:
    """Without a recorded load, inertia and gravity are identified, and friction reads them."""
    frame = joint()
    _, q, v, a = motion()
    load = 6.0 * np.sin(q + 0.4) + 0.3 * a
    friction = (COULOMB + 0.15 * np.abs(load)) * np.sign(v) + VISCOUS * v
    noise = ar1(np.random.default_rng(4), v.size, 0.0, 0.03)
    unknown = frame.drop("load_torque").with_columns(torque=load + friction + noise)
    fit = sb.fit("m1", record(tmp_path, unknown), starts=3)
    assert fit.rmse_held_out == pytest.approx(0.03, rel=0.05)
    assert fit.estimates["load_coulomb"].value == pytest.approx(0.15, abs=0.01)
    assert fit.estimates["inertia"].value == pytest.approx(0.3, abs=0.02)


def test_a_fit_says_whether_it_is_passive(plain: sb.Recording) -> None:
    """A model that pushes in one direction more than friction holds in the other gives energy."""
    assert sb.fit("coulomb", plain).passive() is True
    pushing = sb.model("gaz_a", a1=0.1, a2=-1.0, a3=5.0, a4=50.0, a5=0.0)
    box = {"velocity": (-1.0, 1.0)}
    assert replace(sb.fit("coulomb", plain), model=replace(pushing, box=box)).passive() is False
