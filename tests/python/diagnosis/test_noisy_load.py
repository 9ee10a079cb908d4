"""Noise of the load torque is no backlash, no elasticity and no friction of the quadrants."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from scipy.signal import butter, sosfiltfilt
from stribeck.effect.registry import of_catalog
from synthetic import Array, joint, record

RATE, INERTIA, NOISE = 200.0, 0.8, 0.1


def moves(seconds: float = 50.0) -> tuple[Array, Array, Array]:
    """Position, velocity and acceleration of random moves with a steady speed in between."""
    rng = np.random.default_rng(5)
    step = 1.0 / RATE
    parts: list[Array] = []
    at = 0.0
    while sum(part.size for part in parts) < seconds * RATE:
        to = float(rng.uniform(-1.5, 1.5))
        speed, ramp = float(rng.uniform(0.3, 1.2)), 0.2
        cruise = max(abs(to - at) / speed - ramp, 0.3)
        ramped, level = round(ramp * RATE), round(cruise * RATE)
        signed = np.sign(to - at) * speed / ramp
        own = np.concatenate(
            [np.full(ramped, signed), np.zeros(level), np.full(ramped, -signed), np.zeros(20)]
        )
        at += float(np.sum(np.cumsum(own)) * step**2)
        parts.append(own)
    # No drive jumps to its acceleration.
    window = np.hanning(round(0.1 * RATE) + 2)
    acceleration = np.convolve(np.concatenate(parts), window / window.sum(), mode="same")
    # By the trapezoidal rule: no channel leads another by half a sample.
    velocity = (np.cumsum(acceleration) - 0.5 * acceleration) * step
    return (np.cumsum(velocity) - 0.5 * velocity) * step, velocity, acceleration


def idle_joint(velocity_noise: float, *, load: str = "") -> pl.DataFrame:
    """A joint that lacks nothing, whose acceleration was not recorded."""
    q, v, a = moves()
    rng = np.random.default_rng(3)
    torque = 5.0 * np.sign(v) + 3.0 * v + INERTIA * a + NOISE * rng.standard_normal(v.size)
    columns = {
        "time": np.arange(v.size) / RATE,
        "position": q,
        "velocity": v + velocity_noise * rng.standard_normal(v.size),
        "torque": torque,
    }
    if load == "differences":
        columns["load_torque"] = INERTIA * np.gradient(np.gradient(q, 1.0 / RATE), 1.0 / RATE)
    return pl.DataFrame(columns)


@pytest.mark.parametrize("velocity_noise", [2e-3, 6e-3])
@pytest.mark.parametrize("given", [False, True], ids=["inertia identified", "inertia given"])
@pytest.mark.slow
def test_noise_of_the_acceleration_is_no_effect(
    tmp_path: Path, velocity_noise: float, given: bool
) -> None:
    path = tmp_path / "log.parquet"
    idle_joint(velocity_noise).write_parquet(path)
    recording = sb.read(path, joint_kind="revolute", inertia=INERTIA if given else None)
    found = sb.improve("coulomb", recording, starts=2)
    assert [step.finding.effect for step in found.steps] == []


def test_the_reason_is_said(tmp_path: Path) -> None:
    found = sb.improve("coulomb", record(tmp_path, idle_joint(3e-3)), starts=2)
    reasons = {row.effect: row.reason for row in found.last.not_claimed}
    assert "within its own noise" in reasons["backlash"]


def test_differences_are_no_elasticity(tmp_path: Path) -> None:
    recording = record(tmp_path, idle_joint(0.0, load="differences"), trust=True)
    fitted = sb.fit("coulomb+elasticity", recording, starts=1)
    # Central differences, taken twice, add dt^2/3 of the second derivative.
    share = fitted.model.value("elasticity")
    assert share == pytest.approx(-1.0 / (3.0 * RATE**2), rel=0.3)
    said = of_catalog("elasticity").unresolved(fitted)
    assert said is not None and "differences between samples" in said


@pytest.mark.slow
@pytest.mark.parametrize(("order", "hertz"), [(1, 12.0), (2, 10.0)])
def test_a_low_pass_of_the_load_torque_is_as_likely_as_elasticity(
    tmp_path: Path, order: int, hertz: float
) -> None:
    """The acceleration of the motion is known up to 13.5 Hz only."""
    filtered = sosfiltfilt(butter(order, hertz, fs=RATE, output="sos"), INERTIA * moves()[2])
    frame = idle_joint(5e-3).with_columns(load_torque=filtered)
    found = sb.improve("coulomb", record(tmp_path, frame, trust=True))
    (finding,) = [step.finding for step in found.steps if step.finding.effect == "elasticity"]
    assert finding.confidence <= 0.5
    assert "a load torque behind a low-pass near that does the same" in finding.where


def test_backlash_is_tied_with_elasticity_without_a_known_load(tmp_path: Path) -> None:
    before = sb.fit("coulomb", record(tmp_path, idle_joint(1e-3)), starts=1)
    after = sb.add(before, "backlash", starts=1)
    assert of_catalog("backlash").alike(before, after) == ("elasticity",)
    known = sb.fit("coulomb", record(tmp_path, idle_joint(1e-3, load="differences")), starts=1)
    assert of_catalog("backlash").alike(known, known) == ()


def test_noise_of_a_load_cell_is_no_elasticity(tmp_path: Path) -> None:
    """What smooths the load torque lowers the error by the noise of the cell."""
    frame = joint(rows=8000, rate=200.0)
    noise = 0.6 * np.random.default_rng(5).standard_normal(frame.height)
    found = sb.improve(
        "coulomb", record(tmp_path, frame.with_columns(load_torque=pl.col("load_torque") + noise))
    )
    assert found.steps == ()
