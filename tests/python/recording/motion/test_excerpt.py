"""Stretches of a long recording."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.recording.motion.excerpt import excerpt
from synthetic import joint, motion, record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint whose friction grows with the load, and falls with speed."""
    v = motion()[2]
    extra = 1.5 * np.sign(v) * np.exp(-((np.abs(v) / 0.1) ** 2))
    return record(tmp_path_factory.mktemp("excerpt"), joint(extra))


def test_stretches_begin_segments_and_keep_their_blocks(recording: sb.Recording) -> None:
    few = excerpt(recording, 1200, seed=1)
    assert few.rows == 1200
    at = np.searchsorted(recording.time, few.time)
    np.testing.assert_array_equal(few.torque, recording.torque[at])
    np.testing.assert_array_equal(few.block, recording.block[at])
    begins = np.flatnonzero(np.diff(at, prepend=-2) != 1)
    assert begins.size > 20
    np.testing.assert_array_equal(np.flatnonzero(few.dt == 0.0), begins)
    np.testing.assert_array_equal(np.flatnonzero(np.diff(few.segment, prepend=-1)), begins)
    assert set(few.block) == set(recording.block)
    assert excerpt(recording, recording.rows) is recording


@pytest.mark.slow
def test_causes_found_on_stretches_are_counted_on_all_rows(recording: sb.Recording) -> None:
    whole = sb.improve("coulomb", recording)
    found = sb.improve("coulomb", recording, sample_rows=2000)
    assert [s.finding.effect for s in found.steps] == [s.finding.effect for s in whole.steps]
    assert found.steps
    assert found.final.recording is recording and found.base.recording is recording
    assert found.final.rmse == pytest.approx(whole.final.rmse, rel=1e-6)
    assert found.final.rmse_held_out == pytest.approx(whole.final.rmse_held_out, rel=1e-3)
    assert "effects were searched on 2000 of 3000 samples" in found.final.notes[-1]
    diagnosis = sb.diagnose(whole.base, sample_rows=2000)
    first = diagnosis.findings[0]
    assert first.effect == whole.steps[0].finding.effect
    assert diagnosis.fit.rmse == whole.base.rmse
    assert first.rmse_held_out_before == whole.base.rmse_held_out
    assert first.fit.recording is recording


def test_the_command_takes_the_number_of_rows(tmp_path: Path) -> None:
    from click.testing import CliRunner
    from stribeck.cli.main import cli

    v = motion()[2]
    path = tmp_path / "made.parquet"
    joint(1.5 * np.sign(v) * np.exp(-((np.abs(v) / 0.1) ** 2))).write_parquet(path)
    words = ["improve", str(path), "--sample-rows", "2000"]
    done = CliRunner().invoke(cli, words, catch_exceptions=False)
    assert done.exit_code == 0
    assert "effects were searched on 2000 of 3000 samples" in done.output
