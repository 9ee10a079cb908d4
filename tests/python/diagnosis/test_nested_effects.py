"""An effect that contains a simpler one is named only where nothing simpler does the same."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.diagnose import SHAPE
from stribeck.diagnosis.loop.exchange import exchanges, ties_of
from stribeck.diagnosis.result import Finding
from synthetic import joint, motion, record


def names(recording: sb.Recording) -> list[str]:
    return [step.finding.effect for step in sb.improve("coulomb", recording).steps]


@pytest.mark.slow
def test_load_and_a_wrong_torque_constant_are_no_quadrants(tmp_path: Path) -> None:
    """Both together differ between motoring and generating, and have fewer parameters."""
    frame = joint()
    v, tl = motion()[2], frame["load_torque"].to_numpy()
    friction = 0.15 * np.abs(tl) * np.sign(v)
    torque = (frame["torque"].to_numpy() + friction) * 1.06
    recording = record(tmp_path, frame.with_columns(torque=torque))
    assert sorted(names(recording)) == ["gain", "load"]


@pytest.mark.slow
def test_quadrants_that_neither_makes_are_named(tmp_path: Path) -> None:
    """A load dependence that grows with speed while the joint drives the load."""
    frame = joint()
    v, tl = motion()[2], frame["load_torque"].to_numpy()
    extra = 0.1 * np.abs(tl) * np.sign(v) * (1.0 + np.where(v * tl > 0, 1.5 * np.abs(v), 0.0))
    recording = record(tmp_path, joint(extra))
    assert "quadrant" in names(recording)


def test_friction_that_a_load_takes_away_is_no_difference_of_the_quadrants(tmp_path: Path) -> None:
    """A load that adds to friction while the joint drives it, and takes as much away else.

    That is the load torque on another scale, which depends on the speed.
    """
    v, tl = motion()[2], joint()["load_torque"].to_numpy()
    recording = record(tmp_path, joint(0.08 * tl * np.abs(v)))
    found = sb.diagnose(sb.fit("coulomb", recording, starts=2), brief=True)
    reasons = {row.effect: row.reason for row in found.not_claimed}
    assert "would drive the joint in one quadrant" in reasons["quadrant"]
    assert all(f.confidence <= 0.9 for f in found.findings)


def test_what_a_springs_rest_position_does_is_no_offset(tmp_path: Path) -> None:
    """Nobody knows where a spring is at rest: its mean along the motion is its own."""
    q = motion()[1]
    pull = 0.4 * np.exp(1.2 * q)
    recording = record(tmp_path, joint(pull - pull.mean() + 0.03))
    assert names(recording) == ["spring"]
    left = sb.diagnose(sb.fit("coulomb+spring", recording, starts=1), brief=True)
    reasons = {row.effect: row.reason for row in left.explained}
    assert reasons["offset"] == SHAPE
    assert f"offset: {SHAPE}." in " ".join(str(left).split())


def test_a_wider_effect_gives_way_to_what_remains_of_it(tmp_path: Path) -> None:
    """Before the offset is in the model, the quadrants imitate a part of it."""
    frame = joint()
    v, tl = motion()[2], frame["load_torque"].to_numpy()
    friction = 0.15 * np.abs(tl) * np.sign(v)
    recording = record(tmp_path, joint(friction + 0.2))
    before = sb.fit("coulomb", recording)
    wider = sb.fit("coulomb+load+quadrant", recording, starts=2)
    finding = Finding("quadrant", 1.0, 1.0, 2.0, 1.0, None, "", (), wider, before)
    whole = sb.fit("coulomb+load+quadrant+offset", recording, starts=2)
    best = exchanges([finding], [()], (), whole, (), 0.01, 0).best
    assert best is not None and best.by.effect == "load"
    # It contains the other, and is no alternative to it.
    assert ties_of(best) == {}
