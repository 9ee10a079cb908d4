"""A few steps on a few rows tell which effects are worth a fit to all of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.benchmark.cases import Case
from stribeck.benchmark.generators import GENERATORS
from stribeck.diagnosis.trials.screening import screened
from stribeck.diagnosis.trials.trial import is_promising, try_effect
from synthetic import joint, motion, record

ROWS = 9000


def hardened(sign: float) -> np.ndarray:
    """More dry friction at one end of the stroke."""
    _, q, v, _ = motion(ROWS)
    return sign * 0.6 * np.sign(v) / (1.0 + np.exp(-8.0 * q))


@pytest.fixture
def fitted(tmp_path: Path) -> sb.Fit:
    return sb.fit("coulomb", record(tmp_path, joint(hardened(1.0), rows=ROWS)))


def test_it_foretells_the_fall_of_the_fit(fitted: sb.Fit) -> None:
    found = screened(fitted, "position")
    assert found is not None and is_promising(found, 0.01)
    trial = try_effect(fitted, found)
    assert trial is not None
    assert found.fall == pytest.approx(trial.evidence.fall, abs=0.03)


@pytest.mark.parametrize("effect", ["offset", "temperature_viscous", "inertia", "drift"])
def test_what_brings_nothing_is_not_fitted(fitted: sb.Fit, effect: str) -> None:
    found = screened(fitted, effect)
    assert found is not None and not is_promising(found, 0.01)


def test_a_memory_is_tried_on_one_stretch(fitted: sb.Fit) -> None:
    found = screened(fitted, "presliding")
    assert found is not None and not is_promising(found, 0.01)


def test_what_the_model_cannot_take_is_left_out(fitted: sb.Fit) -> None:
    assert screened(fitted, "no_such_effect") is None


def test_the_seed_decides(fitted: sb.Fit) -> None:
    once, again = (screened(fitted, "stribeck", seed=3) for _ in range(2))
    assert once is not None and again is not None
    assert once.fall == again.fall
    np.testing.assert_array_equal(once.model.values, again.model.values)


def rested(frame: pl.DataFrame, rows: int) -> pl.DataFrame:
    """The same after a rest, in which noise alone changes the sign of the velocity."""
    t = np.arange(rows) * 0.01
    noise = 1e-4 * np.random.default_rng(2).standard_normal(rows)
    still = frame.head(1).select(pl.all().repeat_by(rows).explode())
    rest = still.with_columns(time=pl.Series(t), velocity=pl.Series(noise), torque=pl.lit(2.0))
    return pl.concat([rest, frame.with_columns(pl.col("time") + rows * 0.01)])


def test_a_rest_hides_no_delay(tmp_path: Path) -> None:
    frame = joint(rows=ROWS).with_columns(pl.col("torque").shift(2).backward_fill())
    fitted = sb.fit("coulomb", record(tmp_path, rested(frame, 12_000), trust=True))
    found = screened(fitted, "delay")
    assert found is not None and is_promising(found, 0.01)


@pytest.mark.parametrize("seed", [3, 12])
def test_the_best_of_the_minima_of_a_delay_is_found(seed: int, tmp_path: Path) -> None:
    # Delayed, the sign of the velocity changes sample by sample: there is a minimum near each.
    made = GENERATORS["closed_loop"].make(("delay",), seed, 5.0)
    recording = record(tmp_path, made.frame, joint_kind=made.truth["kind"])
    fitted = sb.fit("coulomb", recording, starts=1)
    found = screened(fitted, "delay")
    assert found is not None
    trial = try_effect(fitted, found)
    assert trial is not None
    assert trial.fit.rmse < 1.01 * sb.fit("coulomb+delay", recording).rmse


def test_a_curve_is_found_beside_a_delay() -> None:
    """The delay keeps its value: its part of the torque is held."""
    t = np.arange(0.0, 60.0, 0.01)
    v = 0.6 * np.sin(1.3 * t) * np.sin(0.21 * t)
    late = np.interp(t - 0.03, t, v)
    torque = np.sign(late) * (2.0 + 1.5 * np.exp(-np.abs(late) / 0.08)) + 3.0 * late
    torque += 0.03 * np.random.default_rng(0).standard_normal(t.size)
    r = sb.Recording.from_columns(time=t, velocity=v, friction_torque=torque)
    before = sb.fit("coulomb+delay", r)
    found = screened(before, "stribeck")
    assert found is not None and found.fall > 0.3
    assert found.model.value("delay") == before.model.value("delay")
    trial = try_effect(before, found)
    assert trial is not None and trial.fit.model.value("delay") == pytest.approx(0.03, abs=2e-3)


def test_a_start_on_a_plateau_does_not_hide_the_minimum(tmp_path: Path) -> None:
    """After a few steps a bristle without influence fits better than one on its way."""
    nuisances = ("velocity_filter", "lagging_thermometer")
    case = Case("one", "open_loop", ("presliding",), 419106000, 5.0, nuisances=nuisances)
    case.make().frame.write_parquet(tmp_path / "recording.parquet")
    before = sb.fit("coulomb", sb.read(tmp_path / "recording.parquet"))
    found = screened(before, "presliding")
    assert found is not None and found.fall > 0.05
    assert 1e3 < found.model.value("presliding_stiffness") < 1e5


def test_a_bristle_is_found_beside_coulomb_friction_of_zero() -> None:
    """Friction that builds up over most of the stroke looks viscous; without any dry friction a
    bristle has no influence.
    """
    t = np.arange(6000) / 200.0
    slow = 1.0 + 0.3 * np.sin(0.4 * t)
    q = 0.01 * slow * np.sin(3.0 * t)
    v = 0.01 * (0.12 * np.cos(0.4 * t) * np.sin(3.0 * t) + 3.0 * slow * np.cos(3.0 * t))
    bent = np.zeros(t.size)
    for k in range(1, t.size):
        step = q[k] - q[k - 1]
        bent[k] = bent[k - 1] + step - abs(step) * bent[k - 1] / 0.006
    torque = 10.0 * bent / 0.006 + 0.05 * np.random.default_rng(2).standard_normal(t.size)
    channels = {"position": q, "velocity": v, "torque": torque, "load_torque": 0.0 * t}
    recording = sb.Recording.from_columns(time=t, joint_kind="prismatic", **channels)
    before = sb.fit("coulomb", recording)
    assert before.model.value("coulomb_friction") == 0.0
    found = screened(before, "presliding")
    assert found is not None and found.fall > 0.5
    assert found.model.value("coulomb_friction") == pytest.approx(10.0, rel=0.1)
