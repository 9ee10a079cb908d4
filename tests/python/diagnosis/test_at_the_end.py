"""What was found is judged again with the values of the last model."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from made_paths import path_through
from stribeck.diagnosis.loop.at_the_end import impossible_at_the_end
from stribeck.diagnosis.loop.path import ImprovementPath
from synthetic import joint, motion, record


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> ImprovementPath:
    v = motion(6000)[2]
    extra = 2.0 * np.exp(-np.abs(v) / 0.3) * np.sign(v)
    folder: Path = tmp_path_factory.mktemp("end")
    base = sb.fit("coulomb", record(folder, joint(extra, rows=6000)), starts=1)
    return path_through(base, ("frictional_lag",))


def with_values(fitted: sb.Fit, **values: float) -> sb.Fit:
    model = fitted.model
    known = [values.get(name, model.value(name)) for name in model.names]
    return replace(fitted, model=model.with_values(known))


def test_a_lag_that_the_recording_does_not_resolve_at_the_end(path: ImprovementPath) -> None:
    findings = [step.finding for step in path.steps]
    resolved = with_values(path.current, frictional_lag=0.1)
    assert impossible_at_the_end(findings, resolved) == {}
    reasons = impossible_at_the_end(findings, with_values(path.current, frictional_lag=0.001))
    assert list(reasons) == ["frictional_lag"]
    assert "less than a quarter of a sample" in reasons["frictional_lag"]


def test_a_size_that_ends_at_a_bound(path: ImprovementPath) -> None:
    fitted = with_values(path.current, frictional_lag=0.1)
    at_bound = {
        name: replace(estimate, at_bound=name == "frictional_lag")
        for name, estimate in fitted.estimates.items()
    }
    reasons = impossible_at_the_end(
        [step.finding for step in path.steps], replace(fitted, estimates=at_bound)
    )
    assert reasons["frictional_lag"].startswith("its frictional_lag would be at its bound")
