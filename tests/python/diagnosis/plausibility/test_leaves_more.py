"""A delay that leaves most of the error where it acts is another cause."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.benchmark.cases import Case
from stribeck.diagnosis.plausibility import leaves_more as rule
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.leaves_more import leaves_more
from synthetic import Array, joint, motion, record


def claim_of_delay(folder: Path, extra: Array, name: str, late: int = 0) -> Claim:
    """The claim of a delay where the torque holds `extra` and is late by some samples."""
    frame = joint(extra, rows=6000)
    frame = frame.with_columns(torque=np.roll(frame["torque"].to_numpy(), late))
    before = sb.fit("coulomb", record(folder, frame[late:], name), starts=1)
    return Claim("delay", before, sb.add(before, "delay", starts=2), 0.01)


def test_a_true_delay_explains_what_it_acts_on(tmp_path: Path) -> None:
    assert leaves_more(claim_of_delay(tmp_path, np.zeros(6000), "late", late=3)) is None


def test_shocks_after_reversals_are_no_delay(tmp_path: Path) -> None:
    """A torque of 20 N m in the third to fifth sample after each reversal."""
    v = motion(6000)[2]
    since = np.arange(6000) - np.maximum.accumulate(
        np.where(np.diff(np.sign(v), prepend=0.0) != 0.0, np.arange(6000), 0)
    )
    shock = np.where((since >= 3) & (since <= 5), -20.0 * np.sign(v), 0.0)
    reason = leaves_more(claim_of_delay(tmp_path, shock, "shocks"))
    assert reason is not None and reason.startswith("where it acts, the error remains")


def test_a_spring_may_have_another_form(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A hose that stiffens is no polynomial: what the spring leaves is of its free form."""
    case = Case("one", "closed_loop", ("spring",), 465119000, 5.0)
    case.make().frame.write_parquet(tmp_path / "recording.parquet")
    recording = sb.read(tmp_path / "recording.parquet", joint_kind="prismatic")
    before = sb.fit("coulomb", recording, starts=1)
    claim = Claim("spring", before, sb.add(before, "spring", starts=2), 0.01)
    assert leaves_more(claim) is None
    monkeypatch.setattr(rule, "columns_of", lambda effect, fit: [])
    assert leaves_more(claim) is not None
