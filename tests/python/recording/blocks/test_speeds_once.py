"""A friction map is held out in turn, so that no block has the highest speeds for itself."""

from __future__ import annotations

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.recording.blocks.speeds_once import passes_speeds_once

#: Coulomb and viscous friction, the height of the Stribeck curve, and its speed.
COULOMB, VISCOUS, HEIGHT, SPEED = 6.0, 8.0, 3.0, 0.05


def friction_map(speeds: np.ndarray, travel: float = 2.0, rate: float = 100.0) -> pl.DataFrame:
    """One pass in each direction at each speed, over the same travel, with steep ramps."""
    rng = np.random.default_rng(5)
    parts = []
    for speed in speeds:
        length = int(travel / speed * rate)
        ramp = np.minimum(1.0, np.minimum(np.arange(length), np.arange(length)[::-1]) / 20.0)
        parts += [speed * ramp, -speed * ramp]
    v = np.concatenate(parts)
    friction = np.sign(v) * (COULOMB + HEIGHT * np.exp(-np.abs(v) / SPEED)) + VISCOUS * v
    torque = friction + 1.5 * np.gradient(v) * rate + 0.2 * rng.standard_normal(v.size)
    return pl.DataFrame(
        {
            "time": np.arange(v.size) / rate,
            "position": np.cumsum(v) / rate,
            "velocity": v + 1e-3 * rng.standard_normal(v.size),
            "torque": torque,
        }
    )


@pytest.fixture(scope="module")
def rising(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """Speeds that rise from pass to pass."""
    path = tmp_path_factory.mktemp("map") / "map.parquet"
    friction_map(np.geomspace(0.01, 1.5, 12)).write_parquet(path)
    return sb.read(path, joint_kind="revolute")


def test_each_block_has_a_part_of_the_highest_speeds(rising: sb.Recording) -> None:
    assert passes_speeds_once(rising) and rising.block_count == 10
    fastest = np.abs(rising.velocity) > 0.5
    assert np.unique(rising.block[fastest]).size >= 5
    (note,) = [note for note in rising.notes if "held out in turn" in note]
    assert note.startswith("one tenth of the recording has its highest speeds for itself")


def test_the_curve_of_a_friction_map_is_found(rising: sb.Recording) -> None:
    """Without its fastest passes neither the curve nor viscous friction is determined."""
    found = sb.improve("coulomb", rising)
    assert [step.finding.effect for step in found.steps] == ["stribeck"]
    model = found.final.model
    assert model.value("viscous_friction") == pytest.approx(VISCOUS, rel=0.02)
    assert model.value("stribeck_height") == pytest.approx(HEIGHT, rel=0.05)
    assert not found.final.transient.any()


def test_tenths_stay_where_the_speeds_come_again(write) -> None:
    speeds = np.geomspace(0.05, 1.5, 8)
    again = friction_map(np.concatenate([speeds, speeds[::-1]]))
    recording = sb.read(write(again), joint_kind="revolute")
    assert not passes_speeds_once(recording)
    assert np.all(np.diff(recording.block) >= 0)
