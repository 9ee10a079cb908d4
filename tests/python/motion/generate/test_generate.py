"""Generated recordings: seeded, readable, and holding what they say."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from polars.testing import assert_frame_equal
from stribeck.base.errors import SpecError
from stribeck.effect.describe import base_of
from stribeck.models.catalog import effect_ids
from stribeck.motion.generate.demo import demo_path, demo_recording
from stribeck.motion.generate.hidden import generate
from stribeck.motion.generate.motion import JOINTS, plan_motion


def test_the_shipped_recording_is_what_its_seed_makes() -> None:
    shipped = pl.read_parquet(demo_path())
    made, truth = demo_recording()
    # Sines and exponentials may differ in the last bit between machines.
    assert_frame_equal(shipped, made, check_exact=False, rel_tol=1e-12, abs_tol=1e-12)
    assert truth["hidden"]
    assert demo_path().stat().st_size < 500_000


def test_the_same_seed_makes_the_same_recording_and_another_another() -> None:
    first, _ = generate(["load"], seed=3, seconds=30.0, rate=50.0)
    again, _ = generate(["load"], seed=3, seconds=30.0, rate=50.0)
    other, _ = generate(["load"], seed=4, seconds=30.0, rate=50.0)
    assert_frame_equal(first, again, check_exact=True)
    assert not first["torque"].equals(other["torque"])


@pytest.mark.parametrize("kind", sorted(JOINTS))
@pytest.mark.parametrize("seed", range(3))
def test_the_motion_is_smooth_and_its_derivatives_belong_to_it(kind: str, seed: int) -> None:
    joint = JOINTS[kind]
    motion = plan_motion(np.random.default_rng(seed), joint, 40.0)
    t = np.arange(0.0, 40.0, 1e-4)
    q, v, a = motion(t)
    # Where a central difference spans no corner of the acceleration it is exact to its order.
    slope, bend = np.gradient(q, t), np.gradient(v, t)
    assert np.abs(slope - v).max() < 1e-3 * joint.speed
    assert np.quantile(np.abs(bend - a), 0.99) < 1e-3 * np.abs(a).max()
    assert np.abs(q).max() <= 1.6 * joint.stroke
    assert np.abs(v).max() <= 1.3 * joint.speed


@pytest.mark.parametrize("kind", sorted(JOINTS))
@pytest.mark.parametrize("effect", effect_ids())
def test_every_effect_can_be_hidden(effect: str, kind: str) -> None:
    base = list(base_of(effect))
    said = {"seed": 1, "seconds": 30.0, "rate": 100.0, "noise": 0.0, "joint_kind": kind}
    if (effect, kind) == ("backlash", "prismatic"):
        with pytest.raises(SpecError, match="changes its sign"):
            generate([effect], **said)
        return
    plain, _ = generate(base, **said)
    frame, truth = generate([*base, effect], **said)
    assert truth["hidden"] == [*base, effect]
    assert np.isfinite(frame.to_numpy()).all()
    moving = np.abs(frame["velocity"].to_numpy()) > 0.02 * JOINTS[kind].speed
    change = (frame["torque"] - plain["torque"]).to_numpy()[moving]
    assert np.sqrt(np.mean(change**2)) > 0.005 * JOINTS[kind].coulomb


def test_the_true_model_leaves_the_noise(tmp_path: Path) -> None:
    frame, truth = generate(["stribeck", "load"], seed=2, seconds=60.0, rate=100.0)
    path = tmp_path / "made.parquet"
    frame.write_parquet(path)
    fit = sb.fit(truth["spec"], sb.read(path, joint_kind="revolute"), starts=5)
    assert fit.rmse == pytest.approx(truth["noise_rms"], rel=0.05)
    for name in ("coulomb_friction", "viscous_friction", "stribeck_height"):
        expected = truth["parameters"][name]["value"]
        assert fit.estimates[name].value == pytest.approx(expected, rel=0.03)


@pytest.mark.parametrize("law", ["lugre", "bittencourt_a", "gantry_map"])
def test_other_laws_can_lie_beneath(law: str) -> None:
    frame, truth = generate(law=law, seconds=20.0, rate=50.0)
    assert truth["spec"] == law
    assert np.isfinite(frame["torque"].to_numpy()).all()


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        ({"effects": ["lod"]}, "load"),
        ({"law": "columb"}, "coulomb"),
        ({"seconds": 1.0}, "seconds|s to"),
        ({"rate": 0.0}, "Hz"),
        ({"noise": float("nan")}, "noise"),
        ({"warming": -1.0}, "warming"),
        ({"joint_kind": "ball"}, "revolute"),
    ],
)
def test_what_makes_no_recording_is_refused(wrong: dict, word: str) -> None:
    with pytest.raises(SpecError, match=word):
        generate(**wrong)


def test_a_published_set_is_hidden_as_printed() -> None:
    """Its own values, at its own speeds, and loads that do not drown it."""
    named = "bittencourt/tables_1_2/m_star"
    frame, truth = generate(law=f"published:{named}", seconds=20.0, rate=100.0)
    printed = sb.published(named)
    for name, value in zip(printed.names, printed.values, strict=True):
        assert truth["parameters"][name]["value"] == value
    assert 140.0 < frame["velocity"].abs().max() < 290.0
    friction = frame["torque"] - frame["load_torque"]
    assert frame["load_torque"].abs().max() < 20.0 * friction.abs().median()
    assert (
        generate(law="published:gantry/table_1/gantry_map", seconds=20.0)[1]["torque_unit"] == "N"
    )
    with pytest.raises(SpecError, match="has no value"):
        generate(law="published:tadese/table_2/joint_1/tadese_full")
