"""What a recording cannot tell from an effect, whatever their errors."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.effect.describe import where
from stribeck.effect.registry import of_catalog
from synthetic import joint, motion, record


@pytest.mark.parametrize("cools", [False, True])
def test_temperature_and_drift_while_a_joint_only_warms_up(tmp_path: Path, cools: bool) -> None:
    """What changes dry friction while it warms up may be run-in."""
    frame = joint()
    t = frame["time"].to_numpy()
    warming = 30.0 - 12.0 * np.exp(-3.0 * t / t[-1])
    if not cools:
        frame = frame.with_columns(temperature=warming)
    before = sb.fit("coulomb", record(tmp_path, frame), starts=1)
    after = sb.fit("coulomb+temperature_dry", record(tmp_path, frame), starts=1)
    ties = of_catalog("temperature_dry").alike(before, after)
    assert ties == (() if cools else ("drift",))
    assert ("let it cool down" in where("temperature_dry", before, after)) is not cools


def test_run_in_of_a_joint_that_warms_up_is_not_certainly_temperature(tmp_path: Path) -> None:
    t, _, v, _ = motion()
    worn = np.exp(-3.0 * t / t[-1])
    frame = joint(0.8 * worn * np.sign(v)).with_columns(temperature=30.0 - 12.0 * worn)
    (step,) = sb.improve("coulomb", record(tmp_path, frame), starts=2).steps
    assert {step.finding.effect, *step.finding.indistinguishable_from} >= {
        "temperature_dry",
        "drift",
    }
    assert step.finding.confidence <= 0.5


@pytest.mark.parametrize(("coulomb", "height"), [(0.0, 2.0), (1.0, 2.0), (0.0, 0.0)])
def test_a_curve_without_coulomb_friction_below_it_may_be_viscous(
    tmp_path: Path, coulomb: float, height: float
) -> None:
    """A curve without height is none."""
    fitted = sb.fit("coulomb+stribeck", record(tmp_path, joint()), starts=1)
    values = {"coulomb_friction": coulomb, "stribeck_height": height}
    known = dict(zip(fitted.model.names, fitted.model.values, strict=True)) | values
    model = fitted.model.with_values([float(known[name]) for name in fitted.model.names])
    ties = of_catalog("stribeck").alike(fitted, replace(fitted, model=model))
    assert ties == (("nonlinear_viscous",) if coulomb < height / 100 else ())
