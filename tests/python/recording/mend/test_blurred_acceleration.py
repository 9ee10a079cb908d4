"""A joint that dry friction stops and releases: its acceleration jumps, and the torque shows it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from numpy.typing import NDArray
from stribeck.recording.acceleration_filter import AccelerationFilter, Derivable
from stribeck.recording.mend.blurred_acceleration import followed_filter
from stribeck.recording.motion.any_friction import AnyFriction
from synthetic import joint, record, sticking, sticking_joint


@pytest.fixture(scope="module")
def stopping(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    return record(tmp_path_factory.mktemp("stopping"), sticking_joint())


def test_each_motion_is_filtered_by_itself(stopping: sb.Recording) -> None:
    chosen = stopping.acceleration_filter
    assert chosen is not None and chosen.at_ends is not None
    note = next(n for n in stopping.notes if "acceleration derived" in n)
    assert "over each motion by itself" in note


def test_the_acceleration_is_the_true_one(stopping: sb.Recording) -> None:
    """Also beside the instants at which friction stops and releases the joint."""
    truth, moving = sticking()[3], stopping.moving
    chosen = stopping.acceleration_filter
    assert chosen is not None
    whole = AccelerationFilter(chosen.at_ends)
    r = stopping
    usual = whole.derived(Derivable(r.time, r.segment, r.velocity, 1, r.velocity_smooth))
    wrong, usually = (
        float(np.sqrt(np.mean((a - truth)[moving] ** 2))) for a in (stopping.acceleration, usual)
    )
    assert wrong < 0.7 * usually


def test_nothing_is_missing(stopping: sb.Recording) -> None:
    """A delay, which the blurred acceleration imitates, is not named."""
    found = sb.improve("coulomb", stopping)
    assert [step.finding.effect for step in found.steps] == []


def test_few_samples_keep_the_usual_filter(stopping: sb.Recording) -> None:
    """A flexible model explains any torque of so few."""
    r, chosen = stopping, stopping.acceleration_filter
    assert chosen is not None
    known = Derivable(r.time, r.segment, r.velocity, 1, r.velocity_smooth)
    friction = AnyFriction(r.velocity, float(np.abs(r.velocity).max()), True, r.position)
    usual = AccelerationFilter(chosen.at_ends)

    def followed(moving: NDArray[np.bool_]) -> AccelerationFilter:
        return followed_filter(known, r.torque, usual, chosen.still, friction, moving)[0]

    assert followed(r.moving) == chosen
    last = np.cumsum(r.moving) > r.moving.sum() - 80
    assert followed(r.moving & last) == usual


def test_a_motion_that_never_stops_is_filtered_as_a_whole(tmp_path: Path) -> None:
    frame = joint(rows=6000, rate=200.0, velocity_noise=2e-3).drop("acceleration")
    chosen = record(tmp_path, frame).acceleration_filter
    assert chosen is not None and chosen.cutoff is not None and chosen.at_ends is None


def test_a_recorded_acceleration_is_not_derived(tmp_path: Path) -> None:
    assert record(tmp_path, joint()).acceleration_filter is None
