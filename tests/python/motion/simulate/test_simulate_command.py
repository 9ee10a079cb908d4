"""`stribeck simulate`, and what it refuses."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from click.testing import CliRunner
from stribeck.base.errors import SpecError, StribeckError
from stribeck.cli.main import cli
from stribeck.motion.simulate.drive import Controller, Follow, Torque
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.trajectory import Fourier, Quintic

COULOMB = ["coulomb", "--value", "a1=0.5", "--value", "a2=2"]


def run(*words: str):
    return CliRunner().invoke(cli, ["simulate", *words], standalone_mode=False)


def test_a_closed_loop_follows_its_trajectory():
    done = run(*COULOMB, "--inertia", "0.3", "--ki", "500", "--feedforward", "--json")
    assert done.exception is None
    answer = json.loads(done.stdout)
    assert answer["model"] == "coulomb"
    assert answer["tracking_error"]["largest"] < 0.02
    assert abs(answer["energy_J"]["imbalance"]) < 1e-12 * answer["energy_J"]["motor"]


@pytest.mark.parametrize("path", ["trapezoid", "quintic", "fourier"])
def test_every_trajectory_moves_the_joint(path):
    done = run(*COULOMB, "--mass", "4", "--trajectory", path, "--json")
    assert done.exception is None
    answer = json.loads(done.stdout)
    assert answer["joint_kind"] == "prismatic"
    assert answer["position"]["max"] == pytest.approx(0.2, abs=0.05)


def test_its_file_is_a_recording(tmp_path):
    path = tmp_path / "moved.csv"
    done = run(*COULOMB, "--inertia", "0.3", "--gravity-cos", "3", "-o", str(path))
    assert done.exception is None
    recording = sb.read(str(path))
    found = sb.fit("coulomb", recording)
    assert found.model.value("coulomb_friction") == pytest.approx(2.0, rel=5e-3)


def test_a_model_file_with_its_own_inertia_needs_no_joint(tmp_path):
    path = tmp_path / "joint.toml"
    model = sb.model("coulomb+inertia+gravity", a1=0.5, a2=2.0, J=0.4, gc=1.0, gs=0.3)
    model.save(str(path))
    done = run(str(path), "--torque", "1.5", "--json")
    assert done.exception is None
    answer = json.loads(done.stdout)
    assert answer["inertia"] == pytest.approx(0.4)
    assert answer["share_at_rest"] == 1.0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["coulomb", "--inertia", "1"], "has no value for"),
        (COULOMB, "has no inertia to move"),
        ([*COULOMB, "--inertia", "1", "--mass", "1"], "give one"),
        ([*COULOMB, "--inertia", "0"], "give one above 0"),
        ([*COULOMB, "--mass", "1", "--pitch", "0.01"], "needs both"),
        ([*COULOMB, "--inertia", "1", "--spring", "3"], "needs --pull-speed"),
        ([*COULOMB, "--inertia", "1", "--torque", "1", "--spring", "3"], "give one of them"),
        ([*COULOMB, "--inertia", "1", "--step", "0"], "step 0 is invalid"),
        ([*COULOMB, "--inertia", "1", "--step", "1e-12"], "give 1 to"),
        ([*COULOMB, "--inertia", "1", "--step", "1e-320"], "give 1 to"),
        ([*COULOMB, "--inertia", "nan"], "finite number"),
        ([*COULOMB, "--inertia", "1", "--kp", "nan"], "finite number"),
        ([*COULOMB, "--inertia", "1", "--period", "0", "--trajectory", "fourier"], "above 0"),
        ([*COULOMB, "--inertia", "1", "--seconds", "nan"], "finite number"),
        ([*COULOMB, "--inertia", "1", "--torque", "1e308"], "at most 1e+100"),
        ([*COULOMB, "--inertia", "1", "--to", "0"], "give two positions"),
        ([*COULOMB, "--inertia", "1", "--value", "a2"], "write --value NAME=NUMBER"),
        ([*COULOMB, "--inertia", "1", "-o", "moved.txt"], ".csv or .parquet"),
        ([*COULOMB, "--inertia", "1", "--torque", "nan"], "finite number"),
    ],
)
def test_bad_input_is_one_sentence(words, said):
    done = run(*words)
    assert isinstance(done.exception, StribeckError)
    assert said in str(done.exception)
    assert "\n" not in str(done.exception)
    assert done.stdout == ""


def test_a_drive_train_that_explains_recordings_moves_nothing():
    model = sb.model("coulomb+elasticity", a1=0.5, a2=2.0, c=1e-4)
    with pytest.raises(SpecError, match="elasticity, which describes recordings"):
        sb.simulate(model, Joint.revolute(1.0), Torque(1.0), seconds=1.0)


def test_what_belongs_to_the_measurement_is_left_out():
    model = sb.model("coulomb+gain", a1=0.5, a2=2.0, g=0.2)
    plain = sb.model("coulomb", a1=0.5, a2=2.0)
    follow = Follow(Quintic(0.0, 1.0, 1.0), Controller(300.0, 19.0))
    moved = sb.simulate(model, Joint.revolute(0.3), follow)
    assert moved.left_out == ("gain",)
    same = sb.simulate(plain, Joint.revolute(0.3), follow)
    assert moved.position_end == same.position_end


def test_a_fourier_series_starts_and_ends_at_rest():
    series = Fourier.from_rest(0.7, 4.0, seed=3, centre=0.2)
    ends = np.array([0.0, 4.0])
    position, velocity, acceleration = series(ends)
    assert position == pytest.approx([0.2, 0.2], abs=1e-12)
    assert velocity == pytest.approx([0.0, 0.0], abs=1e-12)
    assert acceleration == pytest.approx([0.0, 0.0], abs=1e-11)
    reach = np.abs(series(np.linspace(0.0, 4.0, 5000))[0] - 0.2).max()
    assert reach == pytest.approx(0.7, rel=1e-4)


def test_a_model_of_forces_is_not_put_on_a_revolute_joint():
    model = replace(sb.model("coulomb", a1=0.5, a2=2.0), torque_unit="N", position_unit="m")
    with pytest.raises(SpecError, match="give the mass of a prismatic joint"):
        sb.simulate(model, Joint.revolute(1.0), Torque(1.0), seconds=1.0)


def test_a_temperature_is_asked_for():
    warm = sb.model("coulomb+temperature_dry", a1=0.5, a2=2.0, sd=-0.01, kd=0.0)
    with pytest.raises(SpecError, match="depends on the temperature"):
        sb.simulate(warm, Joint.revolute(0.3), Torque(1.0), seconds=1.0)


@pytest.mark.parametrize("temperature", [-273.2, np.full(1000, -300.0)])
def test_a_temperature_below_absolute_zero_is_refused(temperature: object) -> None:
    warm = sb.model("coulomb+temperature_dry", a1=0.5, a2=2.0, sd=-0.01, kd=0.0)
    with pytest.raises(SpecError, match=r"is below absolute zero: give -273\.15 degC"):
        sb.simulate(warm, Joint.revolute(0.3), Torque(1.0), seconds=1.0, temperature=temperature)
    with pytest.raises(SpecError, match=r"below absolute zero: give -273\.15 or more"):
        sb.check(warm, {"velocity": (-1.0, 1.0), "temperature": (-300.0, 20.0)})


def test_the_torque_before_a_ball_screw_is_that_of_the_motor():
    """Equation 3 of the gantry paper: the force is 2 pi/p times the torque of the motor."""
    screw = ["--mass", "11.25", "--rotor-inertia", "1.2298e-5", "--pitch", "6.41e-3"]
    force = 12.6 * 2.0 * math.pi / 6.41e-3
    named = "published:gantry/table_1/gantry_map"
    by_torque = run(named, *screw, "--torque", "12.6", "--seconds", "0.2", "--json")
    by_force = run(
        named, "--mass", "23.06646", "--torque", str(force), "--seconds", "0.2", "--json"
    )
    assert by_torque.exception is None
    turned, pushed = json.loads(by_torque.stdout), json.loads(by_force.stdout)
    assert pushed["share_at_rest"] == turned["share_at_rest"] < 1.0
    assert turned["position"]["max"] == pytest.approx(pushed["position"]["max"], rel=1e-3)


@pytest.mark.parametrize("option", [("--limit", "5"), ("--kp", "5"), ("--feedforward",)])
def test_options_of_the_closed_loop_are_refused_beside_a_push(option: tuple[str, ...]) -> None:
    done = run(*COULOMB, "--inertia", "1", "--torque", "12", *option)
    assert isinstance(done.exception, SpecError)
    assert str(done.exception).startswith(f"{option[0]} has no effect with --torque")


def test_a_bandwidth_of_zero_is_refused() -> None:
    done = run(*COULOMB, "--inertia", "1", "--bandwidth", "0")
    assert isinstance(done.exception, SpecError) and "--bandwidth 0" in str(done.exception)


def test_a_model_file_of_a_revolute_joint_is_not_put_on_a_mass(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    sb.model("coulomb", a1=0.5, a2=2.0).save(path)
    for command in (["simulate"], ["compensate"]):
        words = [*command, str(path), "--mass", "2"]
        done = CliRunner().invoke(cli, words, standalone_mode=False)
        assert isinstance(done.exception, SpecError)
        assert "is in N m and rad: give --inertia, not --mass" in str(done.exception)
