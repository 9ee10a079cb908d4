"""What a wider model gains on held-out samples, and how certain a difference is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnosis.trials.evidence import (
    Difference,
    difference,
    evidence,
    held_out_square,
)
from stribeck.diagnosis.trials.trial import Trial, tie_statistic
from synthetic import joint, motion, record


def test_a_difference_without_error_is_certain() -> None:
    assert Difference(1.0, 0.0).statistic == np.inf
    assert Difference(0.0, 1.0).statistic == Difference(-1.0, 1.0).statistic == 0.0
    assert Difference(3.0, 2.0).statistic == 1.5


def test_evidence_of_a_real_effect_and_of_none(tmp_path: Path, plain: sb.Recording) -> None:
    offset = record(tmp_path, joint(0.1), "offset")
    before, after = sb.fit("coulomb", offset), sb.fit("coulomb+offset", offset)
    found = evidence(before, after)
    rows = before.rows
    fall = 1.0 - np.sqrt(
        np.sum(after.held_out_residual[rows] ** 2) / np.sum(before.held_out_residual[rows] ** 2)
    )
    assert found.fall == pytest.approx(fall, rel=1e-9) and found.fall > 0.5
    assert found.everywhere and found.fall_in_band > 0.5 and found.p_value < 1e-9
    nothing = evidence(sb.fit("coulomb", plain), sb.fit("coulomb+offset", plain))
    assert nothing.fall < 0.01 and nothing.p_value > 1e-3


def test_one_event_is_not_everywhere(tmp_path: Path) -> None:
    """What a single block gains is no effect."""
    t = motion()[0]
    once = record(tmp_path, joint(np.where((t > 9.0) & (t < 11.5), 0.3, 0.0)))
    found = evidence(sb.fit("coulomb", once), sb.fit("coulomb+offset", once))
    assert found.fall < 0.01


def test_an_effect_below_the_noise_is_large_in_the_band_of_the_motion(tmp_path: Path) -> None:
    """White noise of 0.12 N m hides an offset of 0.016 N m on all samples, not in the band."""
    frame = joint(0.016, rows=16000, rate=400.0, noise=0.12, seed=2)
    small = record(tmp_path, frame, "small")
    before = sb.fit("coulomb", small, starts=1)
    found = evidence(before, sb.fit("coulomb+offset", small, starts=1))
    assert found.fall < 0.01 < found.fall_in_band
    assert found.is_large(0.01, 20)
    assert not found.is_large(found.fall_in_band / 5.0 + 1e-6, 20)
    assert not replace(found, p_value=1e-6).is_large(0.01, 20)
    assert not replace(found, fall=0.004).is_large(0.01, 20)
    assert replace(found, fall=0.02, fall_in_band=0.0, p_value=0.5).is_large(0.01, 20)
    assert [f.effect for f in sb.diagnose(before, brief=True).findings][:1] == ["offset"]


def test_difference_is_a_mean_and_its_error(tmp_path: Path) -> None:
    offset = record(tmp_path, joint(0.1), "offset")
    worse, better = sb.fit("coulomb", offset), sb.fit("coulomb+offset", offset)
    found = difference(worse, better)
    rows = worse.rows
    total = np.sum(worse.held_out_residual[rows] ** 2 - better.held_out_residual[rows] ** 2)
    assert found.total == pytest.approx(total) and found.statistic > 5.0
    assert found.statistic == pytest.approx(found.total / found.error)
    for fit in (worse, better):
        square = np.sum(fit.held_out_residual[rows] ** 2)
        assert held_out_square(fit, worse) == pytest.approx(square)
    assert difference(better, worse).statistic == 0.0


def test_causes_outside_friction_are_compared_at_reversals_too(tmp_path: Path) -> None:
    """A delay shows most where dry friction changes its sign, which need not be fitted to."""
    frame = joint()
    late = np.interp(frame["time"] - 0.02, frame["time"], frame["torque"])
    delayed = record(tmp_path, frame.with_columns(torque=pl.Series(late)), "late")
    reversal = np.diff(np.sign(delayed.velocity), prepend=0.0) != 0.0
    near = np.convolve(reversal, np.ones(9), "same") > 0.0
    before = sb.fit("coulomb", delayed, transient=near)
    delay, inertia, curve = (
        Trial(effect, after, evidence(before, after))
        for effect in ("delay", "inertia", "nonlinear_viscous")
        for after in [sb.fit(f"coulomb+{effect}", delayed, transient=near)]
    )
    scored = difference(inertia.fit, delay.fit)
    everywhere = difference(inertia.fit, delay.fit, everywhere=True)
    assert everywhere.total > scored.total > 0.0
    assert tie_statistic(delay, inertia) == everywhere.statistic
    assert tie_statistic(delay, curve) == difference(curve.fit, delay.fit).statistic
