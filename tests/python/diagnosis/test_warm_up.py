"""An amplifier that warms up: what it hides is found beside it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnosis.trend import trend
from synthetic import Array, joint, motion, record

#: Seconds until the amplifier is warm, gain and zero (N m) in excess at the start.
SETTLES, GAIN, ZERO = 8.0, 0.06, 0.4


def through_the_amplifier(
    extra: Array | float = 0.0, *, rows: int = 6000, settles: float = SETTLES
) -> pl.DataFrame:
    """A joint with `extra` torque, measured by an amplifier that warms up."""
    frame = joint(extra, rows=rows)
    cold = np.exp(-frame["time"].to_numpy() / settles)
    torque = frame["torque"].to_numpy()
    return frame.with_columns(torque=torque * (1.0 + GAIN * cold) + ZERO * cold)


def test_gain_zero_and_time_are_identified(tmp_path: Path) -> None:
    fit = sb.fit("coulomb+warm_up", record(tmp_path, through_the_amplifier()), starts=3)
    value = {name: fit.estimates[name].value for name in fit.model.names}
    assert value["warm_up"] == pytest.approx(GAIN, rel=0.05)
    assert value["warm_up_zero"] == pytest.approx(ZERO, rel=0.05)
    settles = fit.model.constants["duration"] / value["warm_up_rate"]
    assert settles == pytest.approx(SETTLES, rel=0.05)
    assert value["coulomb_friction"] == pytest.approx(3.0, rel=0.01)


def test_it_is_named_and_said(tmp_path: Path) -> None:
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, through_the_amplifier())), brief=True)
    first = found.findings[0]
    assert first.effect == "warm_up"
    assert "too much of all torque" in first.where and "time constant of 8" in first.where


def test_it_is_named_without_a_temperature(tmp_path: Path) -> None:
    """That the gain changes over the recording, and not friction, is what it says."""
    frame = through_the_amplifier(settles=30.0).drop("temperature")
    fit = sb.fit("coulomb", record(tmp_path, frame))
    found_trend = trend(fit)
    assert found_trend is not None and found_trend.cause == "gain"
    found = sb.diagnose(fit, brief=True)
    assert found.findings[0].effect == "warm_up"
    assert found.findings[0].confidence > 0.9


@pytest.mark.slow
def test_friction_beside_it_is_found(tmp_path: Path) -> None:
    _, q, v, _ = motion(rows=6000)
    recording = record(tmp_path, through_the_amplifier(0.25 * np.cos(4.0 * q) * np.sign(v)))
    found = sb.improve("coulomb", recording)
    assert {step.finding.effect for step in found.steps} == {"warm_up", "position"}


def test_a_torque_without_its_load_is_refused(tmp_path: Path) -> None:
    frame = joint().drop("load_torque")
    with pytest.raises(sb.StribeckError, match="warm_up distorts the whole motor torque"):
        sb.fit("coulomb+warm_up", record(tmp_path, frame))
