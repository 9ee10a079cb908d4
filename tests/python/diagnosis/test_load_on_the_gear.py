"""Friction that follows the weight is not named friction of the position."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from synthetic import motion, record

#: Gravity torque at a right angle, N m, and inertia of the rotor, kg m2.
GRAVITY, ROTOR = 4.0, 0.2


def friction_along_the_stroke(shift: float) -> pl.DataFrame:
    """0.25 N m of dry friction for each N m of the gravity `shift` rad further on.

    The inertia of the rotor is not on the gear.
    """
    t, q, v, a = motion(6000)
    gravity = GRAVITY * np.sin(q)
    dry = 1.2 + 0.25 * GRAVITY * np.abs(np.sin(q + shift))
    noise = 0.03 * np.random.default_rng(4).standard_normal(t.size)
    torque = ROTOR * a + gravity + dry * np.sign(v) + 0.6 * v + noise
    return pl.DataFrame(
        {"time": t, "position": q, "velocity": v, "acceleration": a, "torque": torque}
    )


@pytest.mark.parametrize("given", [False, True])
def test_friction_of_the_weight_may_be_due_to_the_load(tmp_path: Path, given: bool) -> None:
    made = friction_along_the_stroke(0.0)
    if given:
        load = GRAVITY * np.sin(made["position"].to_numpy()) + ROTOR * made["acceleration"]
        made = made.with_columns(load_torque=load)
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, made))).findings[0]
    assert found.effect == "position"
    assert found.indistinguishable_from == ("load",)
    assert 0.4 < found.confidence <= 0.5
    assert "0.25 N m for each N m of it: record the motion with another payload" in found.where


def test_friction_elsewhere_along_the_stroke_is_that_of_the_position(tmp_path: Path) -> None:
    made = friction_along_the_stroke(0.6)
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, made))).findings[0]
    assert found.effect == "position"
    assert found.indistinguishable_from == ()
    assert found.confidence > 0.99
    assert "payload" not in found.where
