"""Simulated against measured motion."""

from __future__ import annotations

import json
import math
import warnings
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from as_user import stribeck
from click.testing import CliRunner
from stribeck.base.errors import SpecError
from stribeck.cli.main import cli
from stribeck.motion.simulate.drive import Controller, Follow
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.trajectory import Trapezoid
from stribeck.motion.simulate.validation import validate, validate_closed_loop

EMPS = Path(__file__).resolve().parents[5] / "shared" / "data" / "emps"
SIDECARS = Path(__file__).resolve().parents[3] / "sidecars"

STEP = 2e-3
JOINT = Joint.revolute(0.3, gravity_cos=1.0)
#: The joint of a recording whose load torque holds the gravity.
JOINT_ALONE = Joint.revolute(0.3)
CONTROLLER = Controller(300.0, 19.0)
TRAPEZOID = Trapezoid(0.0, 1.0, 1.2, 6.0, dwell=0.0)


def friction(**changed: float) -> sb.Model:
    values = {"coulomb_friction": 2.0, "viscous_friction": 0.5, **changed}
    return sb.model("coulomb", **values)


def recorded(folder: Path) -> sb.Recording:
    """A closed loop as a controller would log it: posture and torque at the instants."""
    moved = sb.simulate(friction(), JOINT, Follow(TRAPEZOID, CONTROLLER), seconds=10.0, step=STEP)
    gravity = np.cos(moved.instant_position[:-1])
    frame = pl.DataFrame(
        {
            "time": moved.instants[:-1],
            "position": moved.instant_position[:-1],
            "velocity": moved.instant_velocity[:-1],
            "acceleration": moved.acceleration,
            "torque": moved.torque,
            "load_torque": JOINT.inertia * moved.acceleration + gravity,
        }
    )
    path = folder / "logged.csv"
    frame.write_csv(path)
    return sb.read(str(path))


def test_the_true_model_makes_the_measured_motion(tmp_path):
    found = validate(friction(), recorded(tmp_path), JOINT_ALONE)
    assert found.relative_error < 1e-2
    assert [g.seconds for g in found.growth] == [0.1, 0.3, 1.0, 3.0]
    assert all(g.error < 5e-3 * g.way for g in found.growth)


def test_a_wrong_model_runs_away_from_it(tmp_path):
    recording = recorded(tmp_path)
    wrong = validate(friction(coulomb_friction=2.2), recording, JOINT_ALONE)
    right = validate(friction(), recording, JOINT_ALONE)
    assert wrong.relative_error > 10.0 * right.relative_error
    assert wrong.growth[-1].error > wrong.growth[0].error


def test_the_closed_loop_is_simulated_with_its_controller(tmp_path):
    recording = recorded(tmp_path)
    desired = TRAPEZOID(recording.time)[0]
    found = validate_closed_loop(friction(), recording, desired, CONTROLLER, JOINT_ALONE)
    assert found.relative_error < 1e-2
    assert found.relative_torque_error < 0.2
    with pytest.raises(SpecError, match="give one per row"):
        validate_closed_loop(friction(), recording, desired[1:], CONTROLLER, JOINT_ALONE)


def test_time_steps_may_be_uneven(tmp_path):
    whole = recorded(tmp_path).to_frame()
    keep = np.flatnonzero(np.arange(whole.height) % 3 > 0)
    path = tmp_path / "uneven.csv"
    whole[keep].write_csv(path)
    recording = sb.read(str(path))
    found = validate(friction(), recording, JOINT_ALONE, horizons=(0.3,))
    assert all(g.error < 0.1 * g.way for g in found.growth)
    desired = TRAPEZOID(recording.time)[0]
    with pytest.raises(SpecError, match="samples evenly"):
        validate_closed_loop(friction(), recording, desired, CONTROLLER, JOINT_ALONE)


def test_the_command_prints_one_object(tmp_path):
    recorded(tmp_path)
    words = ["validate", str(tmp_path / "logged.csv"), "coulomb", "--inertia", "0.3", "--json"]
    done = CliRunner().invoke(cli, words, standalone_mode=False)
    assert done.exception is None
    answer = json.loads(done.stdout)
    assert answer["closed_loop"] is False
    assert answer["position_relative_error"] < 0.05


@pytest.mark.slow
@pytest.mark.skipif(not EMPS.exists(), reason="needs the shared recordings")
def test_emps_simulated_against_measured():
    """Identified, then driven by the measured force alone for 24.8 s; in closed loop likewise."""
    recording = sb.read(str(EMPS / "emps.parquet"), sidecar=str(SIDECARS / "emps.sidecar.toml"))
    fit = sb.fit("coulomb+direction", recording)
    alone = validate(fit, recording, horizons=(0.3,))
    assert alone.relative_error < 0.05
    desired = pl.read_parquet(EMPS / "emps.parquet")["q_ref_m"].to_numpy()
    # Gains of the drive (Janot, Gautier and Brunot 2019).
    controller = Controller.cascade(160.18, 243.45 * 35.15)
    closed = validate_closed_loop(fit, recording, desired, controller)
    assert closed.relative_error < 1e-3
    assert closed.relative_torque_error < 0.05


def test_a_model_without_inertia_is_told_which_option_to_give(tmp_path):
    recorded(tmp_path)
    still = ["--derive", "load_torque=0*position"]
    done = stribeck("validate", tmp_path / "logged.csv", "coulomb", *still)
    assert done.returncode == 2
    assert "give that of the joint with --inertia" in done.stderr and "--mass" not in done.stderr


def test_a_constant_torque_leaves_its_relative_error_open(tmp_path):
    """Nothing varies, so no error is a share of it; and no warning of NumPy is printed."""
    t = np.arange(1000) / 200.0
    frame = {"time": t, "position": 0.5 * t, "velocity": 0.5 + 0.0 * t, "torque": 1.0 + 0.0 * t}
    recording = sb.Recording.from_columns(**frame, load_torque=0.0 * t)
    model = sb.model("coulomb", coulomb_friction=0.8, viscous_friction=0.4)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = validate(model, recording, JOINT_ALONE, horizons=(0.3,))
        assert found.to_dict()["position_rmse"] < 1e-3
    assert math.isnan(found.relative_torque_error)


def slow_log() -> sb.Recording:
    """A joint logged every two seconds, with a temperature that its friction does not read."""
    t = 2.0 * np.arange(400)
    v = 0.2 * np.cos(0.2 * t)
    torque = friction().torque(v, dt=2.0)
    return sb.Recording.from_columns(
        time=t, position=np.sin(0.2 * t), velocity=v, torque=torque, temperature=20.0 + 0.01 * t
    )


def test_a_horizon_is_said_as_the_samples_that_it_takes() -> None:
    """At 0.5 Hz, 3 s is rounded to two samples, 4 s."""
    made = validate(friction(), slow_log(), JOINT_ALONE)
    assert [growth.seconds for growth in made.growth] == [4.0, 10.0]
    r = slow_log()
    assert r.position is not None
    ways = r.position[2:] - r.position[:-2]
    assert made.growth[0].way == pytest.approx(np.sqrt(np.mean(ways**2)), rel=0.05)
