"""A thermometer that follows the temperature of the contacts late: its lag is identified."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from made_paths import path_through
from scipy.signal import lfilter
from stribeck.diagnosis.loop.exchange import Exchange
from stribeck.diagnosis.loop.path import ImprovementPath
from stribeck.diagnosis.loop.superfluous import fit_without
from stribeck.diagnosis.measurement.late_thermometer import LATE_THERMOMETER
from stribeck.diagnosis.trials.screening import screened
from stribeck.diagnosis.trials.trial import try_effect
from stribeck.recording.derive import slow_rate
from synthetic import COULOMB, Array, joint, motion, record

#: Seconds by which the thermometer is late, and the share of dry friction (3 N m) lost per kelvin.
LAG, SLOPE = 3.0, 0.02


def contacts(rows: int) -> Array:
    """Temperature of the contacts, degC: it rises in bursts and falls in between."""
    t = np.arange(rows) / 100.0
    return 30.0 + 6.0 * np.sin(2.0 * np.pi * t / 41.0) + 4.0 * np.sin(2.0 * np.pi * t / 23.0)


def seen_late(rows: int = 8000) -> pl.DataFrame:
    """A joint whose dry friction falls with the temperature of the contacts."""
    _, _, v, _ = motion(rows=rows)
    warm, share = contacts(rows), 1.0 - np.exp(-0.01 / LAG)
    shown = lfilter([share], [1.0, share - 1.0], warm - 30.0) + 30.0
    frame = joint(-3.0 * SLOPE * (warm - 30.0) * np.sign(v), rows=rows)
    return frame.with_columns(temperature=np.round(shown, 1))


def test_the_time_constant_is_identified(tmp_path: Path) -> None:
    recording = record(tmp_path, seen_late())
    late = sb.fit("coulomb+temperature_dry", recording, starts=2)
    fit = sb.fit("coulomb+temperature_dry+thermometer_lag", recording, starts=2)
    assert fit.estimates["thermometer_lag"].value == pytest.approx(LAG, rel=0.1)
    assert fit.rmse < 0.6 * late.rmse
    assert fit.rmse == pytest.approx(0.03, rel=0.1)


@pytest.mark.slow
def test_it_is_found_after_the_temperature_and_said(tmp_path: Path) -> None:
    found = sb.improve("coulomb", record(tmp_path, seen_late()))
    named = [step.finding.effect for step in found.steps]
    assert named == ["temperature_dry", "thermometer_lag"]
    where = found.steps[1].finding.where
    assert where.startswith("this is not friction: ") and "with a time constant of " in where
    # Without friction that depends on temperature the lag has no influence, and goes with it.
    without = fit_without(found.final, found.steps[0].finding, 0)
    assert without is not None and without.model.effects == ()


@pytest.fixture(scope="module")
def late(tmp_path_factory: pytest.TempPathFactory) -> ImprovementPath:
    """Temperature of dry friction, then the lag of the thermometer."""
    base = sb.fit("coulomb", record(tmp_path_factory.mktemp("late"), seen_late(4000)), starts=2)
    return path_through(base, ("temperature_dry", "thermometer_lag"))


def test_the_lag_goes_with_the_effect_of_temperature(late: ImprovementPath) -> None:
    shorter = late.without("temperature_dry", seed=0)
    assert shorter.steps == ()
    assert [gone.effect for gone in shorter.dropped] == ["temperature_dry"]


def test_the_lag_comes_after_what_it_delays(late: ImprovementPath) -> None:
    """The other effect of temperature, beside which it was found, is dropped."""
    found = path_through(late.start, ("temperature_viscous", "thermometer_lag", "temperature_dry"))
    shorter = found.without("temperature_viscous", seed=0)
    assert [s.finding.effect for s in shorter.steps] == ["temperature_dry", "thermometer_lag"]
    assert shorter.current.model.spec == "coulomb+temperature_dry+thermometer_lag"
    assert shorter.steps[1].before is shorter.steps[0].after


def test_the_lag_is_looked_for_again_after_an_exchange(late: ImprovementPath) -> None:
    found = screened(late.start, "temperature_viscous", seed=0)
    assert found is not None
    other = try_effect(late.start, found)
    assert other is not None
    finding = late.steps[0].finding
    changed = late.exchanged(Exchange(finding, late.start, other, 0.0), seed=0)
    assert [step.finding.effect for step in changed.steps] == ["temperature_viscous"]
    assert changed.current.model.spec == "coulomb+temperature_viscous"
    # Only what is dropped is not looked for again.
    assert [gone.effect for gone in changed.dropped] == ["temperature_dry"]


def test_friction_that_does_not_depend_on_temperature_is_refused(tmp_path: Path) -> None:
    with pytest.raises(sb.StribeckError, match="corrects the temperature, but friction of coulomb"):
        sb.fit("coulomb+thermometer_lag", record(tmp_path, joint()))


def test_a_rate_is_that_of_each_run_and_passes_over_gaps() -> None:
    time = np.concatenate([np.arange(0.0, 40.0, 0.1), np.arange(70.0, 100.0, 0.1)])
    shown = np.round(20.0 + 0.05 * time, 1)
    rate = slow_rate(time, shown, np.zeros(time.size, dtype=np.int64))
    assert rate == pytest.approx(np.full(time.size, 0.05), abs=0.01)
    falling = np.concatenate([shown, shown[::-1]])
    run = np.repeat([0, 1], time.size)
    both = slow_rate(np.concatenate([time, time]), falling, run)
    assert both[: time.size] == pytest.approx(rate)
    assert both[time.size :].max() < 0.0


@pytest.mark.parametrize(
    ("effect", "size"), [("temperature_dry", 0.015 * COULOMB), ("temperature_viscous", 0.02)]
)
def test_a_joint_that_only_warms_up_shows_the_effect_of_temperature(
    tmp_path: Path, effect: str, size: float
) -> None:
    """The rate of such a temperature is proportional to it: a lag explains neither of them."""
    rows = 8000
    t, _, v, _ = motion(rows)
    warm = 45.0 - 20.0 * np.exp(-t / 25.0)
    along = np.sign(v) if effect == "temperature_dry" else v
    frame = joint(-size * (warm - 35.0) * along, rows=rows).with_columns(temperature=warm)
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, frame), starts=1), brief=True)
    first = found.findings[0]
    assert first.effect == effect
    if effect == "temperature_dry":
        # Run-in would change dry friction in the same way.
        assert first.indistinguishable_from == ("drift",) and 0.45 < first.confidence <= 0.5
    else:
        assert first.confidence > 0.9


def test_the_lag_stays_a_cause_where_friction_depends_on_the_temperature(tmp_path: Path) -> None:
    recording = record(tmp_path, seen_late(4000))
    fits = {spec: sb.fit(spec, recording, starts=1) for spec in ("coulomb", "coulomb+load")}
    fits["warm"] = sb.fit("coulomb+temperature_dry", recording, starts=1)
    for name, effect, acts in (
        ("coulomb", "temperature_dry", False),
        ("coulomb+load", "temperature_viscous", False),
        ("coulomb", "drift", True),
        ("warm", "temperature_viscous", True),
    ):
        assert LATE_THERMOMETER.acts_without(effect, fits[name]) == acts
