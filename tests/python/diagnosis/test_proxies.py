"""Effects whose form physics fixes are claimed for that form alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.trials.evidence import evidence
from stribeck.diagnosis.trials.proxies import without_proxies
from stribeck.diagnosis.trials.trial import Trial
from synthetic import joint, motion, record


def diagnosed(folder: Path, extra: np.ndarray, seed: int) -> sb.Diagnosis:
    return sb.diagnose(sb.fit("coulomb", record(folder, joint(extra, rows=8000, seed=seed))))


def first_named(folder: Path, extra: np.ndarray, seed: int) -> list[str]:
    return [finding.effect for finding in diagnosed(folder, extra, seed).findings]


@pytest.mark.parametrize("seed", [1, 2])
def test_friction_that_knows_the_sign_of_acceleration_is_no_inertia(
    tmp_path: Path, seed: int
) -> None:
    _, _, _, a = motion(8000)
    found = diagnosed(tmp_path, 0.4 * np.sign(a), seed)
    assert found.findings == ()
    reasons = {row.effect: row.reason for row in found.unclaimed}
    assert "in another form" in reasons["inertia"]


@pytest.mark.parametrize("seed", [1, 2])
def test_an_error_of_inertia_is_one(tmp_path: Path, seed: int) -> None:
    _, _, _, a = motion(8000)
    assert first_named(tmp_path, 0.05 * a, seed)[0] == "inertia"


def test_a_spring_that_hardens_at_one_end_is_no_gravity(tmp_path: Path) -> None:
    _, q, _, _ = motion(8000)
    named = first_named(tmp_path, 0.5 * np.maximum(q - 0.2, 0.0) ** 2, 1)
    assert named and named[0] == "spring"


@pytest.mark.slow
def test_a_wrong_gain_is_one_beside_a_wrong_zero(tmp_path: Path) -> None:
    """A gain that is 3 % off, and a zero that hides what this adds to a constant load of 10 N m."""
    frame = joint(rows=8000)
    told = 1.03 * frame["torque"] + 10.0
    recording = record(
        tmp_path, frame.with_columns(torque=told, load_torque=frame["load_torque"] + 10.0)
    )
    before = sb.fit("coulomb", recording, starts=1)
    after = sb.add(before, "gain", starts=1)
    # The zero explains more than the gain; no other dependence on the torque does.
    trial = Trial("gain", after, evidence(before, after))
    assert [kept.effect for kept in without_proxies(before, [trial])] == ["gain"]
    found = sb.improve("coulomb", recording, starts=1)
    # A saturation shows nearly as much of both at first, so that either may come first.
    assert {step.finding.effect for step in found.steps} == {"gain", "offset"}
