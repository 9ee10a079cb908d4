"""Servo laws where the motor torque is measured: it is predicted, never read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from servo_recording import GRAVITY, INERTIA, TRUTH, balanced, friction
from stribeck.base.errors import FitError


def joint(noise: float = 1e-3) -> pl.DataFrame:
    """A joint with M3 friction whose motor torque was measured."""
    rng = np.random.default_rng(5)
    t = np.arange(3000) * 0.005
    w = np.array([1.3, 2.9, 4.7])[:, None]
    size = np.array([0.9, 0.4, 0.2])[:, None]
    q = (size * np.sin(w * t + w)).sum(axis=0)
    v = (size * w * np.cos(w * t + w)).sum(axis=0)
    a = -(size * w**2 * np.sin(w * t + w)).sum(axis=0)
    external = -GRAVITY * np.sin(q)
    motor = balanced(external, INERTIA * a - external, v) + noise * rng.standard_normal(t.size)
    return pl.DataFrame(
        {
            "time": t,
            "position": q,
            "velocity": v,
            "acceleration": a,
            "torque": motor,
            "load_torque": INERTIA * a - external,
            "external_torque": external,
        }
    )


def test_friction_is_found_with_the_loads_given(tmp_path: Path) -> None:
    path = tmp_path / "joint.parquet"
    joint().write_parquet(path)
    fit = sb.fit("bam_m3", sb.read(path))
    for symbol in ("Kc", "Kl", "Kv"):
        estimate = next(e for e in fit.estimates.values() if e.symbol == symbol)
        assert estimate.value == pytest.approx(TRUTH[symbol], rel=0.02)
    assert fit.rmse == pytest.approx(1e-3, rel=0.05)


def test_gravity_identified_with_the_friction_is_the_environment(tmp_path: Path) -> None:
    path = tmp_path / "joint.parquet"
    joint().drop("load_torque", "external_torque").write_parquet(path)
    fit = sb.fit("bam_m3", sb.read(path))
    value = {name: e.value for name, e in fit.estimates.items()}
    assert value["inertia"] == pytest.approx(INERTIA, rel=0.02)
    assert value["gravity_sin"] == pytest.approx(GRAVITY, rel=0.01)
    assert value["load_coulomb"] == pytest.approx(TRUTH["Kl"], rel=0.03)
    assert fit.rmse == pytest.approx(1e-3, rel=0.05)


def test_the_measured_torque_is_never_read(tmp_path: Path) -> None:
    """Noise in the target cannot leak into the prediction, however large it is."""
    path = tmp_path / "joint.parquet"
    joint(noise=0.1).write_parquet(path)
    recording = sb.read(path)
    fit = sb.fit("bam_m3", recording)
    clean = joint(noise=0.0)["torque"].to_numpy()
    moving = recording.moving
    assert np.sqrt(np.mean((fit.prediction - clean)[moving] ** 2)) < 0.01
    assert fit.rmse == pytest.approx(0.1, rel=0.05)


def test_a_load_without_its_external_part_is_not_enough(tmp_path: Path) -> None:
    path = tmp_path / "joint.parquet"
    joint().drop("external_torque").write_parquet(path)
    with pytest.raises(FitError, match="needs the torque of the environment"):
        sb.fit("bam_m3", sb.read(path))


def test_explicit_and_balanced_torque_agree() -> None:
    frame = joint()
    model = sb.model("bam_m3", Kc=TRUTH["Kc"], Kl=TRUTH["Kl"], Kv=TRUTH["Kv"])
    v, load = frame["velocity"].to_numpy(), frame["load_torque"].to_numpy()
    external = frame["external_torque"].to_numpy()
    torque = model.torque(v, load_torque=load, external_torque=external)
    motor = load + torque
    np.testing.assert_allclose(torque, friction(external, motor, v), atol=1e-12)
    explicit = model.torque(v, motor_torque=motor, external_torque=external)
    np.testing.assert_allclose(torque, explicit, atol=1e-12)


def test_a_self_locking_joint_is_refused() -> None:
    model = sb.model("bam_m3", Kc=0.0, Kl=1.1, Kv=0.0)
    with pytest.raises(sb.SpecError, match=r"no motor torque moves the joint at sample 1"):
        model.torque([0.0, 1.0], load_torque=[1.0, 1.0], external_torque=[-1.0, -1.0])
