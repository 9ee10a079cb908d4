"""Backlash of a simulated drive train, whose shocks last a few samples."""

from __future__ import annotations

from pathlib import Path

import pytest
import stribeck as sb
from stribeck.benchmark.cases import Case


@pytest.mark.slow
@pytest.mark.parametrize("seed", [433117000, 434117000, 435117000])
def test_backlash_in_a_closed_loop_is_named(seed: int, tmp_path: Path) -> None:
    """Motor and link are two bodies; the load torque is that of the link."""
    made = Case("one", "closed_loop", ("backlash",), seed, size=5.0).make()
    path = tmp_path / "recording.parquet"
    made.frame.write_parquet(path)
    found = sb.improve("coulomb", sb.read(path))
    assert [step.finding.effect for step in found.steps] == ["backlash"]
    assert found.steps[0].finding.confidence > 0.9
