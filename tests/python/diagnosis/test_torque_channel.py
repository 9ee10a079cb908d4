"""Errors of the torque channel and of the load on the teeth that friction would imitate."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnosis.measurement.rotor import ROTOR
from stribeck.diagnosis.measurement.step_at_zero import STEP_AT_ZERO
from stribeck.diagnosis.measurement.supply_sag import SUPPLY_SAG
from stribeck.diagnosis.measurement.table import least_factors
from stribeck.diagnosis.trials.flexible_refit import FlexibleRefit
from synthetic import Array, joint, motion, record

ROWS = 4000


def through(chain: str, frame: pl.DataFrame) -> pl.DataFrame:
    """The same with its torque through a measuring chain."""
    torque, v = frame["torque"].to_numpy(), frame["velocity"].to_numpy()
    if chain == "dead zone":
        torque = np.sign(torque) * np.maximum(np.abs(torque) - 0.15, 0.0)
    elif chain == "dead time":
        torque = torque + 0.15 * np.sign(torque)
    else:
        power = np.maximum(torque * v, 0.0)
        torque = torque * (1.0 - 0.05 * power / power.max())
    return frame.with_columns(torque=torque)


@pytest.mark.parametrize("chain", ["dead zone", "dead time", "sag"])
def test_the_torque_channel_is_not_taken_for_friction(chain: str, tmp_path: Path) -> None:
    frame = through(chain, joint(rows=ROWS))
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, frame)))
    claimed = {row.effect for row in found.findings if row.confidence > 0.5}
    assert not claimed & {"quadrant", "load", "direction", "position", "stribeck"}
    doubted = [*((r.effect, r.demoted) for r in found.demoted)]
    doubted += [(r.effect, r.reason) for r in found.not_claimed]
    what = SUPPLY_SAG.what if chain == "sag" else STEP_AT_ZERO.what
    causes = (what, "a load on a wrong scale")
    assert any(e == "quadrant" and any(c in str(why) for c in causes) for e, why in doubted)


def test_friction_of_the_quadrants_is_claimed(tmp_path: Path) -> None:
    """It follows the load, larger while the joint drives it, and not the power."""
    v = motion(ROWS)[2]
    load = joint(rows=ROWS)["load_torque"].to_numpy()
    driving = np.sign(v * load)
    extra = (0.1 + 0.08 * driving) * (1.0 + np.abs(v)) * np.abs(load) * np.sign(v)
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, joint(extra, rows=ROWS))))
    assert found.findings[0].effect == "quadrant"
    assert found.findings[0].confidence > 0.9


def test_a_gain_is_tied_with_the_quadrants(tmp_path: Path) -> None:
    """Friction of the quadrants is a share of the load, and the rest of a gain is in friction."""
    frame = joint(rows=ROWS)
    wrong = frame.with_columns(torque=1.05 * pl.col("torque"))
    first = sb.diagnose(sb.fit("coulomb", record(tmp_path, wrong))).findings[0]
    assert first.effect == "gain" and first.indistinguishable_from == ("quadrant",)


def rotor_joint(share: float) -> pl.DataFrame:
    """Friction grows with the load at the teeth, which `share` of the inertia does not load."""
    t, q, v, a = motion(ROWS)
    inertia = 1.5
    teeth = 6.0 * np.sin(q + 0.4) + (1.0 - share) * inertia * a
    load: Array = teeth + share * inertia * a
    friction = np.sign(v) * (2.0 + 0.15 * np.abs(teeth)) + 0.5 * v
    noise = 0.03 * np.random.default_rng(2).standard_normal(ROWS)
    return pl.DataFrame(
        {
            "time": t,
            "position": q,
            "velocity": v,
            "acceleration": a,
            "torque": load + friction + noise,
            "load_torque": load,
        }
    )


def test_a_rotor_does_not_load_the_gear(tmp_path: Path) -> None:
    """What it explains of the error, and that friction along the stroke does not take its place."""
    before = sb.fit("coulomb+load", record(tmp_path, rotor_joint(0.5)))
    columns = np.column_stack(ROTOR.columns(before))[before.rows]
    refit = FlexibleRefit.beside(before, columns, least_factors({ROTOR.what: columns}))
    whole, floor = float(np.sum(before.residual[before.rows] ** 2)), 0.03**2 * before.rows.size
    assert float(np.sum(refit.residual**2)) - floor < 0.25 * (whole - floor)
    found = sb.diagnose(before)
    assert "position" not in {row.effect for row in found.findings}
    assert not ROTOR.columns(sb.fit("coulomb", before.recording))
