"""The scale of a torque may rise with it: no imitation of friction under load."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.measurement.load_scale import LOAD_SCALE
from stribeck.diagnosis.measurement.table import least_factors, measurement_columns
from stribeck.diagnosis.trials.flexible_refit import FlexibleRefit
from synthetic import joint, motion, record

ROWS = 4000


def explained(folder: Path, bend: float) -> float:
    """Share of the squared error of a scale that bends which a rising scale explains."""
    frame = joint(rows=ROWS)
    torque = frame["torque"].to_numpy()
    top = np.abs(torque).max()
    measured = torque * (1.0 + bend * (torque / top) ** 2)
    before = sb.fit("coulomb", record(folder, frame.with_columns(torque=measured)))
    columns = {LOAD_SCALE.what: measurement_columns(before)[LOAD_SCALE.what]}
    least = least_factors(columns)
    assert np.count_nonzero(least == 0.0) == LOAD_SCALE.rising
    # Without the load torque, whose free scale follows a part of any curve.
    refit = FlexibleRefit.beside(before, columns[LOAD_SCALE.what][:, 1:], least[1:])
    unexplained = np.sum(before.residual[before.rows] ** 2)
    return 1.0 - float(np.sum(refit.residual**2) / unexplained)


def test_a_scale_that_rises_is_explained(tmp_path: Path) -> None:
    assert explained(tmp_path, 0.15) > 0.9


def test_a_scale_that_falls_is_not(tmp_path: Path) -> None:
    assert explained(tmp_path, -0.15) < 0.5


@pytest.mark.parametrize("seed", [3, 4])
def test_friction_under_load_is_claimed(tmp_path: Path, seed: int) -> None:
    _, _, v, _ = motion(ROWS)
    load = joint(rows=ROWS)["load_torque"].to_numpy()
    frame = joint(0.1 * np.abs(load) * np.sign(v), rows=ROWS, seed=seed)
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, frame)))
    assert found.findings[0].effect == "load"
