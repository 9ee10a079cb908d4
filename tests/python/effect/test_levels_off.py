"""Effects whose size has a bound of its own: where a curve levels off, and where grease is cold."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.diagnose import diagnose
from stribeck.identify.scaling import model_for
from stribeck.identify.stated.choices import Choices, parameters_of_effects
from synthetic import VISCOUS, joint, motion, record


@pytest.mark.slow
def test_friction_that_levels_off_far_below_the_top_speed(tmp_path: Path) -> None:
    v = motion()[2]
    extra = 6.0 * np.abs(v) ** 1.8 / (0.05 + np.abs(v)) ** 1.8 * np.sign(v)
    found = sb.improve("coulomb", record(tmp_path, joint(extra)), starts=1)
    assert [step.finding.effect for step in found.steps] == ["nonlinear_viscous"]
    assert found.final.rmse_held_out == pytest.approx(0.03, rel=0.1)
    # The coefficient is the torque per speed at the reference speed.
    model = found.final.model
    speed = model.constants["reference_velocity"]
    own = 6.0 * speed**1.8 / (0.05 + speed) ** 1.8
    expected = own + VISCOUS * speed - model.value("viscous_friction") * speed
    there = model.value("nonlinear_viscous_coefficient") * speed
    assert there == pytest.approx(expected, rel=0.1)


@pytest.mark.slow
def test_viscous_friction_that_falls_by_a_seventh_each_kelvin(tmp_path: Path) -> None:
    """Below the freezing point greases thin as fast."""
    frame = joint()
    v, warm = frame["velocity"].to_numpy(), frame["temperature"].to_numpy() - 30.0
    extra = VISCOUS * (np.exp(-0.14 * warm) - 1.0) * v
    found = sb.improve("coulomb", record(tmp_path, joint(extra)), starts=1)
    assert [step.finding.effect for step in found.steps] == ["temperature_viscous"]
    assert found.final.rmse_held_out == pytest.approx(0.03, rel=0.15)


def test_an_effect_whose_size_is_at_its_bound_is_listed(tmp_path: Path) -> None:
    """A user's bound is narrower than what the recording shows."""
    recording = record(tmp_path, joint(0.5))
    narrow = Choices.of({"bounds": {"offset": (-0.2, 0.2)}})
    start = narrow.applied(model_for("coulomb", recording), parameters_of_effects())
    said = diagnose(sb.fit(start, recording, starts=1))
    reasons = {row.effect: row.reason for row in said.unclaimed}
    assert reasons["offset"].startswith("its offset would be at its bound 0.2 N m")
    assert "widen it with" in reasons["offset"]
    assert "offset" not in [finding.effect for finding in said.findings]
