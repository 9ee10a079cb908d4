"""A public ball-screw drive: friction from its steady passes against its published parameters."""

from __future__ import annotations

from pathlib import Path

import pytest
import stribeck as sb
from stribeck.fitting.methods.segments import segment_points

ROOT = Path(__file__).resolve().parents[4]
EMPS = ROOT.parent / "shared" / "data" / "emps" / "emps.parquet"

pytestmark = pytest.mark.skipif(not EMPS.is_file(), reason="the public data is not at ../shared")


def test_steady_passes_agree_with_the_published_dynamic_fit(tmp_path: Path) -> None:
    recording = sb.read(EMPS, sidecar=ROOT / "tests" / "sidecars" / "emps.sidecar.toml")
    points = segment_points(recording)
    # Three speeds each way; the moves between them are no constant speed.
    speeds = {round(abs(v), 3) for v in points.velocity}
    assert speeds == {0.042, 0.083, 0.125}
    points.write(tmp_path / "points.csv")
    fit = sb.fit("coulomb+offset", sb.read(tmp_path / "points.csv"))
    published = {"viscous_friction": 203.5, "coulomb_friction": 20.4, "offset": -3.2}
    for name, value in published.items():
        estimate = fit.estimates[name]
        assert estimate.stderr is not None
        assert estimate.value == pytest.approx(value, abs=2.0 * estimate.stderr), name
