"""Published friction as the hidden effect: the loop starts from the paper's simpler model."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "hidden"))

import papers
import stribeck as sb


def improve(path: Path, base: str) -> dict[str, Any]:
    command = [sys.executable, "-m", "stribeck", "improve", str(path), "--base", base, "--json"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=1800)
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


def test_m0_errs_on_m_star_as_published() -> None:
    frame = papers.static_friction_curves(4)
    v = frame["velocity"].to_numpy()
    truth = papers.m_star(v, frame["load_torque"].to_numpy(), frame["temperature"].to_numpy())
    m0 = sb.model("m0", Fc=3.24e-2, Fs=3.84e-2, Fv=4.04e-4, vs=13.80, alpha=1.91)
    error = np.abs(m0.torque(v) - truth)
    assert np.mean(error) == pytest.approx(2.2e-2, rel=0.10)
    np.testing.assert_allclose(m0.torque(v), papers.m0(v), rtol=1e-12)


@pytest.mark.slow
def test_m_star_is_found_from_m0(tmp_path: Path) -> None:
    """Load and temperature are named, and the error ends at that of M* itself."""
    frame = papers.static_friction_curves(4)
    path = tmp_path / "curves.csv"
    frame.write_csv(path)
    answer = improve(path, "m0")
    names = [step["effect"] for step in answer["steps"]]
    assert names[0] == "load"
    assert {"temperature_dry", "temperature_viscous"} & set(names)
    assert set(names) <= {"load", "temperature_dry", "temperature_viscous"}
    v = frame["velocity"].to_numpy()
    truth = papers.m_star(v, frame["load_torque"].to_numpy(), frame["temperature"].to_numpy())
    measured = frame["friction_torque"].to_numpy()
    by_m_star = float(np.sqrt(np.mean((measured - truth) ** 2)))
    assert answer["final"]["rmse_held_out"] <= 1.03 * by_m_star
    by_printed_m0 = float(np.mean(np.abs(measured - papers.m0(v))))
    mean_error = answer["final"]["rmse_held_out"] * np.sqrt(2.0 / np.pi)
    assert by_printed_m0 / mean_error >= 6.0


@pytest.mark.slow
def test_comprehensive_friction_is_found_from_lugre(tmp_path: Path) -> None:
    """Quadrant (or load) and temperature are named; the error falls as in the paper's table 1."""
    frame = papers.comprehensive(1)
    path = tmp_path / "joint.parquet"
    frame.write_parquet(path)
    answer = improve(path, "lugre")
    names = {step["effect"] for step in answer["steps"]}
    assert names & {"quadrant", "load"}
    assert names & {"temperature_viscous", "temperature_dry"}
    before = answer["steps"][0]["rmse_held_out_before"]
    # Table 1 of Tadese et al. 2021: 1.1276 without and 0.3507 with load and temperature.
    assert answer["final"]["rmse_held_out"] <= before * 0.3507 / 1.1276
