"""A spring is what it adds beyond an offset: where it rests is unknown."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.trials import candidates
from synthetic import joint, motion, record


@pytest.mark.slow
def test_a_spring_that_rests_beside_the_middle_of_the_stroke(tmp_path: Path) -> None:
    """A hose pulls by up to 3.6 N m, and nowhere pushes."""
    q = motion()[1]
    pull = 0.9 * (np.exp(0.9 * (q - q.min())) - 1.0)
    found = sb.improve("coulomb", record(tmp_path, joint(pull)), starts=1)
    assert [step.finding.effect for step in found.steps] == ["spring"]
    assert found.steps[0].finding.confidence > 0.9
    assert found.final.rmse_held_out == pytest.approx(0.03, rel=0.1)
    assert found.final.model.value("offset") == pytest.approx(float(np.mean(pull)), rel=0.3)


@pytest.mark.slow
def test_an_offset_is_not_taken_for_a_spring(tmp_path: Path) -> None:
    found = sb.improve("coulomb", record(tmp_path, joint(0.5)), starts=1)
    assert [step.finding.effect for step in found.steps] == ["offset"]
    assert "spring" not in found.steps[0].finding.indistinguishable_from


def test_a_weight_and_an_offset_do_not_replace_a_spring(tmp_path: Path) -> None:
    """Its torque over the stroke is like a weight's, but not the same."""
    q = motion()[1]
    u = q / np.abs(q).max()
    spring = 0.02 * u + 0.005 * u**3
    fitted = sb.fit("coulomb", record(tmp_path, joint(spring)), starts=1)
    tested = candidates.tested(fitted, ["offset", "gravity", "spring"], 0.01, 0)
    assert {trial.effect for trial in tested.passing} == {"gravity", "spring"}
