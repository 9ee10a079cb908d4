"""Two effects that predict only together."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.benchmark.cases import Case, cases
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.rules import impossible
from stribeck.diagnosis.trials.pairs import best_pair
from stribeck.diagnosis.trials.screening import Screened, screened
from stribeck.diagnosis.trials.trial import try_effect
from stribeck.effect.describe import is_friction
from synthetic import joint, motion, record

ROWS = 6000
T, Q, V, _ = motion(ROWS)
EFFECTS = ("temperature_dry", "drift", "position", "offset", "stribeck")


def warming(extra: np.ndarray) -> pl.DataFrame:
    """A joint that warms up by 20 K, with `extra` torque."""
    kelvin = 20.0 + 20.0 * (1.0 - np.exp(-T / 15.0))
    return joint(extra, rows=ROWS).with_columns(temperature=pl.Series(kelvin))


def hiding() -> pl.DataFrame:
    """Wear raises dry friction while the warmth lowers it."""
    warmth = 1.0 - np.exp(-T / 15.0)
    return warming(1.2 * (T / T[-1] - warmth) * np.sign(V))


def screenings(before: sb.Fit, effects: Sequence[str]) -> dict[str, Screened]:
    made = {effect: screened(before, effect) for effect in effects}
    return {effect: found for effect, found in made.items() if found is not None}


def test_two_effects_that_hide_each_other_are_a_pair(tmp_path: Path) -> None:
    before = sb.fit("coulomb", record(tmp_path, hiding()), starts=1)
    pair = best_pair(before, screenings(before, EFFECTS), {})
    assert pair is not None and {pair.first, pair.second} == {"temperature_dry", "drift"}
    assert 0.2 < pair.fall < 1.0


@pytest.mark.parametrize("size", [0.0, 0.8])
def test_noise_is_no_pair_nor_is_an_effect_that_predicts_alone(tmp_path: Path, size: float) -> None:
    extra = size * np.sin(2.0 * Q) * np.sign(V)
    before = sb.fit("coulomb", record(tmp_path, warming(extra)), starts=1)
    assert best_pair(before, screenings(before, EFFECTS), {}) is None


def test_effects_with_a_memory_of_their_own_are_left_out(tmp_path: Path) -> None:
    before = sb.fit("coulomb", record(tmp_path, hiding()), starts=1)
    assert best_pair(before, screenings(before, ("presliding", "delay", "drift")), {}) is None
    assert best_pair(before, {}, {}) is None


@pytest.mark.slow
def test_the_loop_finds_both(tmp_path: Path) -> None:
    """A recording of the benchmark, read through a thermometer that lags."""
    hidden = ("drift", "temperature_dry")
    case = Case("two", "open_loop", hidden, 365166000, 2.0, nuisances=("lagging_thermometer",))
    case.make().frame.write_parquet(tmp_path / "recording.parquet")
    recording = sb.read(tmp_path / "recording.parquet")
    found = sb.diagnose(sb.fit("coulomb", recording), brief=True)
    assert found.findings == () and found.pair is not None
    assert (found.pair.first.effect, found.pair.second) == ("temperature_dry", "drift")
    assert "Together, temperature_dry and drift lower the held-out error by 4" in str(found)
    improved = sb.improve("coulomb", recording)
    assert {step.finding.effect for step in improved.steps} == set(hidden)
    assert improved.last.verdict == "none"


@pytest.mark.slow
def test_an_offset_and_a_gain_that_hide_each_other(tmp_path: Path) -> None:
    """An amplifier that warms up explains much of both, and is not claimed: it is steady."""
    behind = ("load_scale", "sensor_lag")
    case = Case("one", "closed_loop", ("offset",), 451111000, 5.0, nuisances=behind)
    case.make().frame.write_parquet(tmp_path / "recording.parquet")
    improved = sb.improve("coulomb", sb.read(tmp_path / "recording.parquet"))
    assert {"offset", "gain"} <= {step.finding.effect for step in improved.steps}


@pytest.mark.slow
def test_the_lag_of_a_thermometer_is_a_pair_with_what_it_delays(tmp_path: Path) -> None:
    """With the temperature shown, viscous friction predicts the cold start worse than without."""
    late = ("lagging_thermometer",)
    case = Case("one", "open_loop", ("temperature_viscous",), 422122000, 1.0, nuisances=late)
    case.make().frame.write_parquet(tmp_path / "recording.parquet")
    before = sb.fit("coulomb", sb.read(tmp_path / "recording.parquet"))
    pair = best_pair(before, screenings(before, ("temperature_viscous", "temperature_dry")), {})
    assert pair is not None
    assert (pair.first, pair.second) == ("temperature_viscous", "thermometer_lag")
    improved = sb.improve("coulomb", before.recording)
    named = [step.finding.effect for step in improved.steps]
    assert named == ["temperature_viscous", "thermometer_lag"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("hidden", "seed"),
    [
        # The shape of the temperature ends at a bound while the lag is not known.
        (("ripple", "load", "temperature_viscous"), 472172000),
        # The lag is found beside the other effect of temperature, which is superfluous later.
        (("position", "temperature_dry"), 472157000),
        # The cold start is most of the error, so that one block decides its standard error.
        (("saturation", "temperature_viscous"), 472167000),
    ],
)
def test_several_effects_behind_a_late_thermometer(
    tmp_path: Path, hidden: tuple[str, ...], seed: int
) -> None:
    case = next(
        c
        for c in cases(1, seed=472, realism=3, generators=("open_loop",))
        if (c.effects, c.seed) == (hidden, seed)
    )
    case.make().frame.write_parquet(tmp_path / "recording.parquet")
    recording = sb.read(tmp_path / "recording.parquet", joint_kind="revolute")
    improved = sb.improve("coulomb", recording)
    named = {step.finding.effect for step in improved.steps}
    assert {*hidden, "thermometer_lag"} <= named
    friction = {effect for effect in named if is_friction(effect)}
    assert friction == {effect for effect in hidden if is_friction(effect)}


@pytest.mark.slow
def test_the_first_of_a_pair_may_be_impossible_alone(tmp_path: Path) -> None:
    """It stands in for both: a cold start is predicted far worse, and few samples decide."""
    behind = ("sensor_lag", "lagging_thermometer")
    case = Case("one", "open_loop", ("temperature_viscous",), 452122000, 1.0, nuisances=behind)
    case.make().frame.write_parquet(tmp_path / "recording.parquet")
    recording = sb.read(tmp_path / "recording.parquet")
    before = sb.fit("coulomb", recording)
    first = try_effect(before, screenings(before, ["temperature_viscous"])["temperature_viscous"])
    assert first is not None and impossible(Claim(first.effect, before, first.fit)) is not None
    named = [step.finding.effect for step in sb.improve("coulomb", recording).steps]
    assert "temperature_viscous" in named


@pytest.mark.slow
def test_a_pair_beside_an_effect_on_trial(tmp_path: Path) -> None:
    """Drift alone gains little, and the temperature only beside it and with its lag."""
    hidden = ("drift", "temperature_dry")
    case = Case("two", "closed_loop", hidden, 462175000, 2.0, nuisances=("lagging_thermometer",))
    case.make().frame.write_parquet(tmp_path / "recording.parquet")
    improved = sb.improve("coulomb", sb.read(tmp_path / "recording.parquet"))
    named = {step.finding.effect for step in improved.steps}
    assert named == {*hidden, "thermometer_lag"}
    assert improved.last.verdict == "none"
