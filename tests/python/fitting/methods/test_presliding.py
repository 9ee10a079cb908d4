"""Stiffness and damping from presliding: the joint of Tadese et al. 2021, table 2."""

from __future__ import annotations

from pathlib import Path

import indy
import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import FitError, RecordingError
from stribeck.fitting.methods.presliding import Presliding


def bristle(recording: sb.Recording) -> Presliding:
    """The law of the paper as the first step leaves it: all but its bristle is known."""
    known = {f"g2_{quadrant}": 1.0 for quadrant in (1, 2, 3, 4)}
    for way, sign in (("plus", 1), ("minus", -1)):
        known[f"Fc_{way}"] = indy.COULOMB[sign]
        symbols = ("s20", "s2T", "s30", "s3T")
        known |= {f"{s}_{way}": x for s, x in zip(symbols, indy.VISCOUS[sign], strict=True)}
    model = sb.model("tadese_full", s0=1.0, vd=indy.DAMPING_VELOCITY, **known)
    model = model.with_values(np.nan_to_num(model.values))
    places = [model.names.index(name) for name in ("bristle_stiffness", "bristle_damping")]
    return Presliding(recording, model, *places)


def read(folder: Path, frame: pl.DataFrame) -> sb.Recording:
    path = folder / "presliding.parquet"
    frame.write_parquet(path)
    return sb.read(path, joint_kind="revolute", standstill=True)


@pytest.mark.parametrize(
    "joint",
    [2, *(pytest.param(k, marks=pytest.mark.slow) for k in (1, 3, 4, 5, 6))],
)
def test_table_2_comes_back(tmp_path: Path, joint: int) -> None:
    stiffness, damping = indy.BRISTLES[joint - 1]
    recording = read(tmp_path, indy.presliding_log((stiffness, damping)))
    slow = bristle(recording)
    values, first_torque, _ = slow.fit(slow.model.values)
    assert values[slow.stiffness] == pytest.approx(stiffness, rel=0.01)
    assert values[slow.damping] == pytest.approx(damping, rel=0.05)
    residual = slow.target - slow.predict(values, first_torque)
    assert np.sqrt(np.mean(residual**2)) == pytest.approx(indy.TORQUE_NOISE, rel=0.05)


def test_no_row_need_move_faster_than_its_noise(tmp_path: Path) -> None:
    path = tmp_path / "log.parquet"
    indy.presliding_log(cycles=1.0).write_parquet(path)
    with pytest.raises(RecordingError, match="nothing moves"):
        sb.read(path, joint_kind="revolute")
    assert not sb.read(path, joint_kind="revolute", standstill=True).moving.any()


def test_the_bristle_need_not_start_without_deflection(tmp_path: Path) -> None:
    frame = indy.presliding_log()
    later = frame[frame.height // 7 :].with_columns(pl.col("position") + 1.0)
    slow = bristle(read(tmp_path, later))
    values, first_torque, _ = slow.fit(slow.model.values)
    assert values[slow.stiffness] == pytest.approx(indy.JOINT_2[0], rel=0.01)
    assert first_torque == pytest.approx(later["torque"][:20].mean(), abs=0.5)


def test_a_log_without_position_is_refused(tmp_path: Path) -> None:
    frame = indy.presliding_log(cycles=0.5)
    velocity = frame["position"].diff().fill_null(0.0) * 1000.0
    recording = read(tmp_path, frame.drop("position").with_columns(velocity=velocity))
    with pytest.raises(FitError, match="no position column"):
        bristle(recording).fit(np.ones(33))


def test_torque_that_falls_with_position_is_no_presliding(tmp_path: Path) -> None:
    frame = indy.presliding_log(cycles=1.0).with_columns(-pl.col("position"))
    slow = bristle(read(tmp_path, frame))
    with pytest.raises(FitError, match="not presliding"):
        slow.fit(slow.model.values)
