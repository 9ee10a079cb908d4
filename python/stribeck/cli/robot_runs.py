"""Recordings of a robot for its commands: in memory, or read in passes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import click

from stribeck.base.errors import joint_called
from stribeck.cli.common import say
from stribeck.cli.options import Command, Values, gathered
from stribeck.cli.progress import RowProgress
from stribeck.cli.unread import refuse_unread
from stribeck.recording.motion.excerpt import SAMPLE_ROWS
from stribeck.recording.stated.options import ReadOptions
from stribeck.robot.arm import Robot
from stribeck.robot.motion import RobotMotion, read_motion
from stribeck.scale.robots.stream import RobotStream, stream_robot


def read_runs(
    described: Robot, runs: tuple[str, ...], reading: ReadOptions, cutoff: float | None
) -> RobotMotion:
    """Read the recordings of all joints, and refuse channels that contradict each other."""
    motion = read_motion(described, runs, reading, cutoff)
    for name, recording in zip(described.names, motion.joints, strict=True):
        recording.require_consistent()
        for check in recording.checks:
            if not check.ok:
                say(f"note: {joint_called(name)}: accepted with --trust: {check.said}")
    return motion


@dataclass(frozen=True)
class Passes:
    """Whether the recordings are read in passes, and how many samples are then in memory."""

    asked: bool
    sample_rows: int

    @contextmanager
    def open(
        self,
        described: Robot,
        runs: tuple[str, ...],
        reading: ReadOptions,
        cutoff: float | None,
        seed: int,
    ) -> Iterator[RobotMotion | RobotStream]:
        """The recordings of all joints; passes over them show their progress on stderr."""
        if not self.asked:
            yield read_runs(described, runs, reading, cutoff)
            return
        with RowProgress() as bar:
            opened = stream_robot(
                described,
                runs,
                cutoff=cutoff,
                sample_rows=self.sample_rows,
                seed=seed,
                told=bar.show_pass,
                **reading.given(),
            )
            if opened.data.motion.rows < opened.data.data.rows:
                say(
                    f"note: bounds and starts are from {opened.data.motion.rows} of "
                    f"{opened.data.data.rows} samples; parameters and errors are from all"
                )
            yield opened


def passes_options(command: Command) -> Command:
    """Add `--stream` and `--sample-rows`; the command receives them as `passes`."""
    return gathered(command, _OPTIONS, "passes", _passes)


def _passes(values: Values) -> Passes:
    if not values["stream"]:
        refuse_unread("without --stream", {"sample_rows": "with it"})
    return Passes(values.pop("stream"), values.pop("sample_rows"))


_OPTIONS = [
    click.option(
        "--stream",
        is_flag=True,
        help="Read RUNS (Parquet, CSV) in passes, window by window: they may be larger than "
        "memory.",
    ),
    click.option(
        "--sample-rows",
        type=click.IntRange(min=1000),
        default=SAMPLE_ROWS,
        show_default=True,
        help="With --stream, samples in memory, in stretches spread over longer data.",
    ),
]
