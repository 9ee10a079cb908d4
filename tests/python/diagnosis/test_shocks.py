"""Shocks after the load torque changes its sign, of which no two are the same."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from numpy.typing import NDArray
from stribeck.diagnosis.residual.shocks import FEWEST, shocks
from synthetic import joint, motion, record

Array = NDArray[np.float64]

ROWS, RATE = 20000, 200.0
#: A shock rings at 30 Hz and is over after about 60 ms.
RINGS, FALLS = 30.0, 0.02


def crossings() -> NDArray[np.intp]:
    """Samples at which the load torque of `joint` changes its sign while it moves fast."""
    load = joint(rows=ROWS, rate=RATE)["load_torque"].to_numpy()
    speed = np.abs(motion(ROWS, RATE)[2])
    changed = np.flatnonzero(np.sign(load[1:]) != np.sign(load[:-1])) + 1
    return changed[speed[changed] > 0.3]


def struck(at: NDArray[np.intp], height: float = 1.5) -> Array:
    """Torque that rings after some samples, each time with a phase and a height of its own."""
    rng = np.random.default_rng(3)
    extra = np.zeros(ROWS)
    time = np.arange(40) / RATE
    for first in at[at < ROWS - time.size]:
        phase, size = rng.uniform(0.0, 2.0 * np.pi), height * rng.uniform(0.5, 1.5)
        ringing = np.cos(2.0 * np.pi * RINGS * time + phase) * np.exp(-time / FALLS)
        extra[first : first + time.size] += size * ringing
    return extra


def fitted(folder: Path, extra: Array) -> sb.Fit:
    return sb.fit("coulomb", record(folder, joint(extra, rows=ROWS, rate=RATE)), starts=1)


def test_shocks_are_told_by_their_time(tmp_path: Path) -> None:
    found = shocks(fitted(tmp_path, struck(crossings())))
    assert found.share > 0.3 and found.ratio > 3.0 and found.seconds in (0.02, 0.04, 0.08)


@pytest.mark.parametrize("of_the_load", [False, True])
def test_other_errors_are_no_shocks(tmp_path: Path, of_the_load: bool) -> None:
    """Shocks at times of their own, and a step of friction with the sign of the load torque."""
    at = np.arange(137, ROWS, 331)
    load = joint(rows=ROWS, rate=RATE)["load_torque"].to_numpy()
    extra = 0.5 * np.sign(load) if of_the_load else struck(at)
    assert shocks(fitted(tmp_path, extra)).share == 0.0


def test_a_few_shocks_are_none(tmp_path: Path) -> None:
    assert shocks(fitted(tmp_path, struck(crossings()[: FEWEST // 2], 6.0))).share == 0.0


def test_nothing_imitates_shocks(tmp_path: Path) -> None:
    """They are no noise, and where they are names their cause."""
    found = sb.improve(
        "coulomb", record(tmp_path, joint(struck(crossings()), rows=ROWS, rate=RATE))
    )
    assert all(step.finding.confidence <= 0.5 for step in found.steps)
    left = found.last.unexplained
    assert left.is_structure and "after the load torque changes its sign" in str(left.where)
    assert "backlash" in str(left.where)
