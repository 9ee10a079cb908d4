"""Friction is not claimed where a cause in the measurement explains as much."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnosis.measurement.other_acceleration import OTHER_ACCELERATION
from stribeck.diagnosis.measurement.table import CAUSES, measurement_columns
from stribeck.effect.describe import is_friction
from synthetic import COULOMB, joint, motion, record

ROWS = 8000


def warmed_up(frame: pl.DataFrame) -> pl.DataFrame:
    """The same behind an amplifier whose gain and zero settle."""
    share = np.linspace(0.0, 1.0, frame.height)
    left = np.exp(-4.0 * share)
    return frame.with_columns(torque=pl.col("torque") * (1 - 0.06 * left) + 0.1 * left)


@pytest.mark.parametrize("seed", [1, 2])
def test_an_amplifier_that_warms_up_is_no_friction(tmp_path: Path, seed: int) -> None:
    recording = record(tmp_path, warmed_up(joint(rows=ROWS, seed=seed)))
    found = sb.diagnose(sb.fit("coulomb+gain", recording))
    assert found.findings[0].effect == "warm_up"
    assert not [f.effect for f in found.findings if is_friction(f.effect)]
    told = [row.reason for row in found.not_claimed] + [str(f.demoted) for f in found.demoted]
    assert any("an amplifier whose gain and zero settle" in reason for reason in told)


def test_drift_of_friction_is_still_found(tmp_path: Path) -> None:
    """Under a load that varies, friction that changes is not a gain that changes."""
    _, _, v, _ = motion(ROWS)
    share = np.linspace(0.0, 1.0, ROWS)
    extra = 0.15 * COULOMB * np.exp(-4.0 * share) * np.sign(v)
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, joint(extra, rows=ROWS))))
    assert found.findings[0].effect == "drift"
    assert found.findings[0].demoted is None


def test_causes_are_columns_on_the_samples_fitted_to(plain: sb.Recording) -> None:
    fit = sb.fit("coulomb+load", plain, starts=1)
    columns = measurement_columns(fit)
    # Most of this load torque is gravity: it shows no acceleration that may be another one.
    present = [cause.what for cause in CAUSES if cause is not OTHER_ACCELERATION]
    assert list(columns) == present
    assert all(made.shape[0] == fit.rows.size for made in columns.values())
    assert all(np.all(np.isfinite(made)) for made in columns.values())


def test_steady_speeds_have_no_time(tmp_path: Path) -> None:
    frame = joint().with_columns(run=pl.Series(np.repeat(np.arange(30), 100)))
    points = record(tmp_path, frame, average="run")
    found = measurement_columns(sb.fit("coulomb", points))
    assert list(found) == ["a torque on a wrong scale", "a torque channel with a step at zero"]
