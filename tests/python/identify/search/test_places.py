"""Which searches ended at the same place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import stribeck as sb
from synthetic import joint, motion, record


def test_searches_without_bounds_end_together(tmp_path: Path) -> None:
    """A formula's parameters have no range of random starts: their values are compared."""
    v = motion()[2]
    recording = record(tmp_path, joint(1.2 * np.exp(-np.abs(v / 0.12)) * np.sign(v)))
    model = sb.model("coulomb").with_effect("seal = c*sgn(v)*exp(-abs(v)/w)", {})
    report = sb.fit(model, recording, starts=8).search
    assert report is not None
    assert report.at_minimum >= 4 and report.new_place is not None and report.new_place < 0.5
