"""What changes along a recording without a thermometer, and what cannot be told of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.trend import DRY, LOAD, VISCOUS, _rank_correlation, trend
from stribeck.report.diagnosis import diagnosis_summary, trend_text
from synthetic import COULOMB, joint, motion, record
from synthetic import VISCOUS as COEFFICIENT
from synthetic import Array as Torque

ROWS, RATE = 8000, 20.0
T, _, V, _ = motion(ROWS, RATE)
LATER = T / T[-1]


def drifting(folder: Path, extra: Torque) -> sb.Recording:
    """400 s of a joint without a thermometer, with `extra` torque."""
    return record(folder, joint(extra, rows=ROWS, rate=RATE).drop("temperature"))


@pytest.mark.parametrize(
    ("part", "extra"),
    [(VISCOUS, -0.15 * COEFFICIENT * V * LATER), (DRY, -0.1 * COULOMB * np.sign(V) * LATER)],
)
def test_the_part_that_changes(tmp_path: Path, part: str, extra: Torque) -> None:
    """The share is that of the mean: 0.15 of the start is 0.162 of the middle."""
    found = trend(sb.fit("coulomb", drifting(tmp_path, extra), starts=1))
    assert found is not None and found.cause == "friction"
    assert [name for name, change in found.changes.items() if change.clear] == [part]
    share = -0.15 / 0.925 if part == VISCOUS else -0.1 / 0.95
    assert found.changes[part].share == pytest.approx(share, rel=0.03)
    said = trend_text(found)
    assert part in said and "Record the temperature to tell" in said


def test_load_and_friction_that_shrink_alike_are_the_gain(tmp_path: Path) -> None:
    load = joint(rows=ROWS, rate=RATE)["load_torque"].to_numpy()
    extra = -0.05 * LATER * (load + COULOMB * np.sign(V) + COEFFICIENT * V)
    fitted = sb.fit("coulomb", drifting(tmp_path, extra), starts=1)
    found = trend(fitted)
    assert found is not None and found.cause == "gain"
    assert found.changes[LOAD].share == pytest.approx(-0.05, rel=0.05)
    assert "rather than friction" in trend_text(found)
    assert "drift" not in {row.effect for row in sb.diagnose(fitted).findings}


def test_another_payload_is_neither_gain_nor_friction(tmp_path: Path) -> None:
    load = joint(rows=ROWS, rate=RATE)["load_torque"].to_numpy()
    found = trend(sb.fit("coulomb", drifting(tmp_path, 0.3 * LATER * load), starts=1))
    assert found is not None and found.cause == "load"
    assert found.to_dict()["indistinguishable_from"] == []
    assert "the payload may have changed" in trend_text(found)


def test_a_zero_that_drifts_is_not_called_a_payload(tmp_path: Path) -> None:
    """Gravity of one sign all the time changes nearly as the zero does."""
    frame = joint(0.5 * LATER, rows=ROWS, rate=RATE)
    gravity = 4.0 * np.cos(0.5 * frame["position"].to_numpy())
    torque = frame["torque"] - frame["load_torque"] + gravity + 0.3 * frame["acceleration"]
    made = frame.with_columns(torque=torque).drop("temperature", "load_torque")
    found = trend(sb.fit("coulomb", record(tmp_path, made), starts=1))
    assert found is not None and found.cause == "zero"
    assert "the zero of the torque drifts" in trend_text(found)


def test_nothing_is_said_of_time_where_the_motion_changes_with_it(tmp_path: Path) -> None:
    """In a sweep, what grows with the frequency grows with time."""
    t = np.arange(ROWS) / RATE
    frequency = 0.02 + 0.18 * t / t[-1]
    phase = 2.0 * np.pi * np.cumsum(frequency) / RATE
    rate = 2.0 * np.pi * frequency
    v, a = 0.5 * rate * np.cos(phase), -0.5 * rate**2 * np.sin(phase)
    frame = joint(rows=ROWS, rate=RATE).drop("temperature", "load_torque")
    friction = COULOMB * (1.0 - 0.3 * frequency / 0.2) * np.sign(v) + COEFFICIENT * v
    noise = 0.01 * np.random.default_rng(1).standard_normal(ROWS)
    swept = frame.with_columns(
        position=0.5 * np.sin(phase), velocity=v, acceleration=a, torque=friction + 0.3 * a + noise
    )
    fitted = sb.fit("coulomb", record(tmp_path, swept), starts=1)
    assert fitted.rmse > 0.1
    assert trend(fitted) is None


def test_drift_without_a_thermometer_is_tied_with_temperature(tmp_path: Path) -> None:
    recording = drifting(tmp_path, -0.1 * COULOMB * np.sign(V) * LATER)
    said = sb.diagnose(sb.fit("coulomb", recording, starts=1))
    assert said.findings[0].effect == "drift"
    assert said.findings[0].confidence == pytest.approx(0.5, abs=0.01)
    assert said.findings[0].indistinguishable_from == ("temperature_dry",)
    assert "record the temperature to tell" in said.findings[0].where


def test_a_drift_of_viscous_friction_is_not_called_one_of_dry_friction(tmp_path: Path) -> None:
    recording = drifting(tmp_path, -0.15 * COEFFICIENT * V * LATER)
    said = sb.diagnose(sb.fit("coulomb", recording, starts=1))
    assert "drift" not in {row.effect for row in said.findings}
    assert said.to_dict()["trend"]["changes"][VISCOUS]["clear"]
    # The first sentence names what changes.
    summary = diagnosis_summary(said)
    assert "viscous friction falls by 16 %" in summary and "dry friction" not in summary
    (drift,) = [row for row in said.not_claimed if row.effect == "drift"]
    assert drift.reason == "over the recording viscous friction changes, not dry friction"


def test_nothing_changes_or_a_thermometer_says_why(tmp_path: Path) -> None:
    assert trend(sb.fit("coulomb", drifting(tmp_path, np.zeros(ROWS)), starts=1)) is None
    warm = joint(-0.15 * COEFFICIENT * V * LATER, rows=ROWS, rate=RATE)
    assert trend(sb.fit("coulomb", record(tmp_path, warm, "warm"), starts=1)) is None


def test_a_part_that_would_change_its_sign_says_nothing(tmp_path: Path) -> None:
    """Viscous friction from -0.3 to 2.3 times its mean: something else is wrong."""
    fitted = [
        sb.fit("coulomb", drifting(tmp_path, share * COEFFICIENT * V * (LATER - 0.5)), starts=1)
        for share in (1.6, 2.6)
    ]
    usual, impossible = map(trend, fitted)
    assert usual is not None and usual.changes[VISCOUS].share == pytest.approx(1.6, rel=0.03)
    assert impossible is None


def test_few_moves_show_no_trend(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A slow and a fast move of three seconds are no change with time."""
    rows = 300
    t, _, v, _ = motion(rows)
    frame = joint(-0.5 * COEFFICIENT * v * t / t[-1], rows=rows).drop("temperature")
    fitted = sb.fit("coulomb", record(tmp_path, frame), starts=1)
    assert trend(fitted) is None
    monkeypatch.setattr("stribeck.diagnosis.trend.FEWEST_MOVES", 0)
    assert trend(fitted) is not None


def test_moves_of_one_size_do_not_change() -> None:
    assert _rank_correlation(np.full(20, 0.3)) == 0.0
    assert _rank_correlation(np.arange(1.0, 21.0)) == pytest.approx(1.0)
    assert _rank_correlation(-np.arange(20.0) + 30.0) == pytest.approx(-1.0)
    found = _rank_correlation(np.random.default_rng(1).uniform(1.0, 2.0, 100))
    assert abs(found) < 0.3
