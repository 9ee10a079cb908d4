"""Inertia and friction of the planar arm of Indri et al., from its own trajectory."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import planar_arm
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import FitError
from stribeck.fitting.methods.arm import ArmFit, arm_fit, friction_columns, rigid_body_columns
from stribeck.fitting.methods.trajectory import FOUR_HARMONICS


def both(folder: Path, frame: pl.DataFrame) -> tuple[sb.Recording, sb.Recording]:
    path = folder / "arm.parquet"
    frame.write_parquet(path)
    first, second = (sb.read(path, joint=k, joint_kind="revolute") for k in ("1", "2"))
    return first, second


@pytest.fixture(scope="module")
def joints(tmp_path_factory: pytest.TempPathFactory) -> tuple[sb.Recording, sb.Recording]:
    """Ten repetitions of the four-harmonic trajectory, 2500 samples each."""
    return both(tmp_path_factory.mktemp("arm"), planar_arm.recording_frame())


@pytest.fixture(scope="module")
def arm(joints: tuple[sb.Recording, sb.Recording]) -> ArmFit:
    return arm_fit(*joints, first_link_length=planar_arm.FIRST_LINK)


def inertial_error(arm: ArmFit) -> np.ndarray:
    """Relative errors of the four inertial parameters; the third, nominally 0, in kg m."""
    nominal = np.array(planar_arm.NOMINAL)
    return np.abs(arm.values[:4] - nominal) / np.where(nominal == 0.0, 1.0, nominal)


def test_the_regressor_agrees_with_newton_and_virtual_work() -> None:
    rng = np.random.default_rng(4)
    q, v, a = rng.uniform(-3.0, 3.0, (3, 200, 2))
    columns = rigid_body_columns(q, v, a, planar_arm.FIRST_LINK)
    assert columns @ np.array(planar_arm.NOMINAL) == pytest.approx(
        planar_arm.rigid_body(q, v, a), abs=1e-12
    )


def test_the_trajectory_keeps_to_the_arm_and_its_derivatives_to_calculus() -> None:
    time = np.linspace(0.0, FOUR_HARMONICS.seconds, 30001)
    q, v, a = FOUR_HARMONICS(time)
    step = time[1]
    assert np.abs(q).max() < 2.15  # the joints' angular limit, section 3
    assert v[1:-1] == pytest.approx((q[2:] - q[:-2]) / (2 * step), abs=1e-6)
    assert a[1:-1] == pytest.approx((v[2:] - v[:-2]) / (2 * step), abs=1e-6)


def test_the_nominal_inertia_comes_back(arm: ArmFit) -> None:
    assert inertial_error(arm) == pytest.approx(0.0, abs=0.02)
    assert [p.name for p in arm.parameters[:4]] == [
        "inertia_1",
        "moment_2x",
        "moment_2y",
        "inertia_2",
    ]
    assert len(arm.parameters) == 12


def test_relative_errors_are_rms_of_error_over_rms_of_torque(arm: ArmFit) -> None:
    for k, recording in enumerate(arm.recordings):
        error = recording.torque - arm.prediction[:, k]
        share = np.sqrt(np.mean(error**2) / np.mean(recording.torque**2))
        assert arm.relative_errors[k] == pytest.approx(share)
        # No better than the noise, no worse than noise and Stribeck curve together.
        noise = planar_arm.TORQUE_NOISE[k] / np.sqrt(np.mean(recording.torque**2))
        assert 0.98 * noise < arm.relative_errors[k] < 0.06


def test_plain_least_squares_takes_the_stribeck_curve_for_inertia(
    joints: tuple[sb.Recording, sb.Recording], arm: ArmFit
) -> None:
    plain = arm_fit(*joints, first_link_length=planar_arm.FIRST_LINK, slowest=0.0, weighted=False)
    assert inertial_error(plain).max() > 0.05 > inertial_error(arm).max()


def test_with_polynomial_friction_the_errors_are_those_that_are_stated(tmp_path: Path) -> None:
    frame = planar_arm.recording_frame(repetitions=2)
    _, v, _ = FOUR_HARMONICS(frame["time"].to_numpy())
    wanted = np.array([7.0, 2.5, -1.0, 0.4])
    for k in (1, 2):
        other = friction_columns(v[:, k - 1]) @ wanted - planar_arm.friction(k, v[:, k - 1])
        frame = frame.with_columns(pl.col(f"torque_{k}") + other)
    made = arm_fit(*both(tmp_path, frame), first_link_length=planar_arm.FIRST_LINK)
    true = np.array([*planar_arm.NOMINAL, *wanted, *wanted])
    errors = np.array([p.stderr for p in made.parameters])
    assert np.abs(made.values - true).max() < 0.1
    assert np.all(np.abs(made.values - true) < 5.0 * errors)


def test_first_moments_scale_with_the_length_that_was_given(
    joints: tuple[sb.Recording, sb.Recording], arm: ArmFit
) -> None:
    longer = arm_fit(*joints, first_link_length=2.0 * planar_arm.FIRST_LINK)
    assert longer.values[1] == pytest.approx(0.5 * arm.values[1])
    assert longer.values[3] == pytest.approx(arm.values[3])


def test_friction_becomes_a_model(arm: ArmFit) -> None:
    v = np.array([-1.0, 0.5, 1.5])
    for joint in (1, 2):
        first = 4 * joint
        expected = friction_columns(v) @ arm.values[first : first + 4]
        assert arm.friction(joint).torque(v) == pytest.approx(expected)


def test_an_arm_whose_second_joint_stands_still_is_refused(tmp_path: Path) -> None:
    frame = planar_arm.recording_frame(repetitions=1)
    rng = np.random.default_rng(0)
    frame = frame.with_columns(q_2=pl.Series(1e-5 * rng.standard_normal(frame.height)))
    first, second = (
        sb.read(_written(tmp_path, frame), joint=k, joint_kind="revolute", standstill=True)
        for k in ("1", "2")
    )
    with pytest.raises(FitError, match=r"inertia_2.* cannot be distinguished"):
        arm_fit(first, second, first_link_length=0.35)


def _written(folder: Path, frame: pl.DataFrame) -> Path:
    frame.write_parquet(folder / "still.parquet")
    return folder / "still.parquet"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"first_link_length": 0.0}, "`first_link_length=0`"),
        ({"first_link_length": float("nan")}, "`first_link_length=nan`"),
        ({"first_link_length": 0.35, "slowest": 1.0}, "`slowest=1`"),
    ],
)
def test_options_out_of_range_are_refused(
    joints: tuple[sb.Recording, sb.Recording], options: dict[str, float], said: str
) -> None:
    with pytest.raises(FitError, match=said):
        arm_fit(*joints, **options)


def test_joints_of_other_times_are_refused(
    joints: tuple[sb.Recording, sb.Recording], tmp_path: Path
) -> None:
    _, other = both(tmp_path, planar_arm.recording_frame(repetitions=1))
    with pytest.raises(FitError, match="not sampled at the same times"):
        arm_fit(joints[0], other, first_link_length=0.35)


def test_load_torque_of_equation_9_is_newtons() -> None:
    rng = np.random.default_rng(4)
    q, v, a = rng.uniform(-2.0, 2.0, (3, 200, 2))
    load = sb.planar_arm_load(planar_arm.NOMINAL, q, v, a, first_link_length=planar_arm.FIRST_LINK)
    np.testing.assert_allclose(load, planar_arm.rigid_body(q, v, a), rtol=1e-12, atol=1e-12)
    with pytest.raises(sb.SpecError, match="give four numbers"):
        sb.planar_arm_load([1.0], q, v, a, first_link_length=0.35)
    with pytest.raises(sb.SpecError, match=r"give arrays \[n, 2\]"):
        sb.planar_arm_load(planar_arm.NOMINAL, q[:, 0], v, a, first_link_length=0.35)
