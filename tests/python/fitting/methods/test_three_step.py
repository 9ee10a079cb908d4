"""The three-step procedure of Tadese et al. 2021 on a joint of its Indy-7."""

from __future__ import annotations

import json
from pathlib import Path

import indy
import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import FitError
from stribeck.fitting.methods.three_step import ThreeStepFit, three_step_fit
from test_method_commands import answer, refused


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The three recordings."""
    folder = tmp_path_factory.mktemp("indy")
    frames = {
        "no_load": indy.no_load_points(),
        "loaded": indy.loaded_points(),
        "presliding": indy.presliding_log(),
    }
    for name, frame in frames.items():
        frame.write_csv(folder / f"{name}.csv")
    return {name: folder / f"{name}.csv" for name in frames}


@pytest.fixture(scope="module")
def recordings(files: dict[str, Path]) -> dict[str, sb.Recording]:
    points = {
        name: sb.read(files[name], average="run", joint_kind="revolute")
        for name in ("no_load", "loaded")
    }
    slow = sb.read(files["presliding"], joint_kind="revolute", standstill=True)
    return {**points, "presliding": slow}


@pytest.fixture(scope="module")
def fit(recordings: dict[str, sb.Recording]) -> ThreeStepFit:
    return three_step_fit("tadese_full", **recordings)


def test_parameters_come_back(fit: ThreeStepFit) -> None:
    stiffness, damping = indy.JOINT_2
    assert fit.model.value("bristle_stiffness") == pytest.approx(stiffness, rel=0.01)
    assert fit.model.value("bristle_damping") == pytest.approx(damping, rel=0.05)
    for word, way in (("forward", 1), ("backward", -1)):
        level, slope, speed, speed_slope = indy.VISCOUS[way]
        assert fit.model.value(f"coulomb_friction_{word}") == pytest.approx(
            indy.COULOMB[way], rel=0.01
        )
        assert fit.model.value(f"viscous_level_{word}") == pytest.approx(level, rel=0.01)
        assert fit.model.value(f"viscous_level_slope_{word}") == pytest.approx(slope, rel=0.02)
        assert fit.model.value(f"viscous_speed_{word}") == pytest.approx(speed, rel=0.02)
        assert fit.model.value(f"viscous_speed_slope_{word}") == pytest.approx(speed_slope, rel=0.1)


def test_the_curve_comes_back_where_no_point_was(fit: ThreeStepFit) -> None:
    rng = np.random.default_rng(8)
    v = rng.choice([-1.0, 1.0], 500) * rng.uniform(0.02, 1.8, 500)
    temperature, load = rng.uniform(20.0, 60.0, 500), rng.uniform(-60.0, 60.0, 500)
    true = [indy.steady(*row) for row in zip(v, temperature, load, strict=True)]
    predicted = fit.model.torque(v, temperature=temperature, load_torque=load, dt=1e9)
    assert np.abs(predicted - true).max() < 0.05
    assert np.abs(true).max() > 20.0


def test_each_step_gives_its_parameters_and_reaches_the_noise(fit: ThreeStepFit) -> None:
    first, second, third = fit.steps
    assert first.parameters == (
        "coulomb_friction_forward",
        "coulomb_friction_backward",
        "viscous_level_forward",
        "viscous_level_slope_forward",
        "viscous_speed_forward",
        "viscous_speed_slope_forward",
        "viscous_level_backward",
        "viscous_level_slope_backward",
        "viscous_speed_backward",
        "viscous_speed_slope_backward",
    )
    assert len(second.parameters) == 20
    assert all(name.startswith("load_") for name in second.parameters)
    assert third.parameters == ("bristle_stiffness", "bristle_damping")
    assert first.rmse == pytest.approx(indy.POINT_NOISE, rel=0.25)
    assert second.rmse == pytest.approx(indy.POINT_NOISE, rel=0.25)
    assert third.rmse == pytest.approx(indy.TORQUE_NOISE, rel=0.05)


def test_the_box_covers_what_the_steps_saw(
    fit: ThreeStepFit, recordings: dict[str, sb.Recording]
) -> None:
    box = fit.model.box
    for recording in recordings.values():
        moving = recording.moving
        for name in ("velocity", "temperature", "load_torque", "position"):
            column = getattr(recording, name)
            if column is not None and moving.any():
                low, high = box[name]
                assert low <= column[moving].min() and column[moving].max() <= high, name
    warm = recordings["no_load"].temperature
    assert warm is not None and box["temperature"] == (warm.min(), warm.max())
    assert box["temperature"][1] - box["temperature"][0] > 30.0


def test_standard_errors_are_those_of_the_scatter(fit: ThreeStepFit) -> None:
    for word, way in (("forward", 1), ("backward", -1)):
        estimate = fit.estimates[f"coulomb_friction_{word}"]
        assert estimate.stderr is not None
        assert abs(estimate.value - indy.COULOMB[way]) < 4.0 * estimate.stderr
    assert fit.estimates["bristle_stiffness"].stderr is None


def test_a_law_of_effects_has_its_three_steps_too(recordings: dict[str, sb.Recording]) -> None:
    fit = three_step_fit("coulomb+temperature_viscous+load+presliding", **recordings, starts=2)
    assert fit.steps[1].parameters == ("load_coulomb", "load_exponent")
    assert fit.steps[2].parameters == ("presliding_stiffness", "presliding_damping")
    # One dry friction for both directions bends the bristle's answer a little.
    assert fit.model.value("presliding_stiffness") == pytest.approx(indy.JOINT_2[0], rel=0.15)


def test_the_command_writes_a_model_that_reads_back(files: dict[str, Path], tmp_path: Path) -> None:
    for name in ("no_load", "loaded"):
        Path(f"{files[name]}.sidecar.toml").write_text(
            'kind = "recording"\njoint_kind = "revolute"\naverage = "run"\n'
        )
    stored = tmp_path / "indy.toml"
    made = answer(
        "fit",
        files["no_load"],
        "--model",
        "tadese_full",
        "--method",
        "three_step",
        "--loaded",
        files["loaded"],
        "--presliding",
        files["presliding"],
        "-o",
        stored,
    )
    assert [step["name"] for step in made["steps"]] == [
        "speed and temperature",
        "load",
        "presliding",
    ]
    assert json.dumps(made["rmse_held_out"]) == "null"
    model = sb.load(stored)
    for name, row in made["parameters"].items():
        assert model.value(name) == row["value"]


def test_recordings_that_are_no_points_are_refused(recordings: dict[str, sb.Recording]) -> None:
    slow = recordings["presliding"]
    with pytest.raises(FitError, match="does not hold steady-state points"):
        three_step_fit("tadese_full", slow, recordings["loaded"], slow)


def test_a_law_without_load_is_refused(recordings: dict[str, sb.Recording]) -> None:
    with pytest.raises(FitError, match="no parameter of the load"):
        three_step_fit("tadese_t", **recordings)


def test_too_few_points_are_refused(recordings: dict[str, sb.Recording], tmp_path: Path) -> None:
    path = tmp_path / "few.csv"
    indy.no_load_points().filter(pl.col("temperature") == 20.0)[:8].write_csv(path)
    few = sb.read(path, average="run", joint_kind="revolute")
    with pytest.raises(FitError, match="8 moving points for 10 parameters"):
        three_step_fit("tadese_full", few, recordings["loaded"], recordings["presliding"])


def test_files_that_do_not_go_with_the_method_are_refused(files: dict[str, Path]) -> None:
    data = files["no_load"]
    assert "needs three recordings" in refused(
        "fit", data, "--model", "tadese_full", "--method", "three_step"
    )
    assert "only with --method three_step" in refused(
        "fit", data, "--model", "coulomb", "--loaded", files["loaded"]
    )
