"""Runs that repeat a motion are held out together where other joints move."""

from __future__ import annotations

import numpy as np
import polars as pl
import stribeck as sb

#: The motion of each run, by its frequency in Hz: the first and the third come back.
MOTIONS = (0.3, 0.5, 0.8, 1.1, 1.5, 0.3, 0.8, 0.3)


def log(motions: tuple[float, ...]) -> pl.DataFrame:
    """Two joints in runs of 6 s at 50 Hz; that of a repeated motion is off by 1 %."""
    t = np.arange(300) / 50.0
    rng = np.random.default_rng(3)
    runs = []
    for k, frequency in enumerate(motions):
        size, w = 1.0 + 0.01 * k, 2.0 * np.pi * frequency
        runs.append(
            pl.DataFrame(
                {
                    "run": np.full(t.size, k),
                    "time": t,
                    "q_1": size * np.sin(w * t),
                    "q_2": np.cos(w * t),
                    "tau_1": np.sign(np.cos(w * t)) + 0.05 * rng.standard_normal(t.size),
                }
            )
        )
    return pl.concat(runs)


def test_runs_of_one_motion_are_one_block(write):
    recording = sb.read(write(log(MOTIONS)), joint="1")
    assert recording.block_count == 5
    of_run = [int(recording.block[recording.run == k][0]) for k in range(len(MOTIONS))]
    assert of_run == [0, 1, 2, 3, 4, 0, 2, 0]
    (note,) = [note for note in recording.notes if "held out together" in note]
    assert note.startswith("8 runs repeat 5 motions")


def test_alone_the_joint_may_repeat_its_motion(write):
    assert sb.read(write(log(MOTIONS).drop("q_2"))).block_count == len(MOTIONS)


def test_too_few_motions_are_held_out_by_run(write):
    recording = sb.read(write(log(MOTIONS[-4:] * 2)), joint="1")
    assert recording.block_count == 8


def test_several_files_are_treated_alike():
    frame = log(MOTIONS)
    files = [frame.filter(pl.col("run") == k).drop("run") for k in range(len(MOTIONS))]
    assert sb.read(files, joint="1").block_count == 5


def test_the_tenths_of_one_run_stay(write):
    """Five motions, twice one after the other in one run: its tenths are no runs."""
    frame = log(MOTIONS[:5] * 2).with_columns(time=pl.int_range(pl.len()) / 50.0)
    assert sb.read(write(frame.drop("run")), joint="1").block_count == 10
