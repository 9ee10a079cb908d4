"""Options for data larger than memory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import click

from stribeck.base.errors import SpecError
from stribeck.cli.common import echo_result, say
from stribeck.cli.options import Command, Values, gathered
from stribeck.recording.motion.excerpt import SAMPLE_ROWS
from stribeck.recording.stated.options import ReadOptions
from stribeck.scale.streaming.diagnosis import StreamedDiagnosis
from stribeck.scale.streaming.improvement import StreamedImprovement
from stribeck.scale.streaming.result import StreamedFit
from stribeck.scale.streaming.stream import Stream, stream


@dataclass(frozen=True)
class Streaming:
    """Whether the data is read in passes, and how many samples are kept in memory."""

    asked: bool
    sample_rows: int

    def refuse(self, **given: bool) -> None:
        """Refuse options that need all samples in memory."""
        for flag, is_given in given.items():
            if is_given:
                raise SpecError(
                    f"--{flag.replace('_', '-')} needs all samples in memory: omit it, or leave "
                    "out --stream"
                )

    def open(self, data: Sequence[str], reading: ReadOptions, seed: int) -> Stream:
        """Open one file, folder or pattern, and print its notes on stderr."""
        if len(data) != 1:
            raise SpecError(
                f"--stream reads one file, folder or pattern, {len(data)} are given: give a pattern"
            )
        opened = stream(data[0], sample_rows=self.sample_rows, seed=seed, **reading.given())
        for note in opened.sample.recording.notes:
            say(f"note: {note}")
        return opened


def save_streamed(fitted: StreamedFit, path: str) -> None:
    """Write a model file with its standard errors and provenance."""
    fitted.model_file().write(path)
    say(f"wrote {path}")


def show(result: StreamedFit | StreamedDiagnosis | StreamedImprovement, as_json: bool) -> None:
    """Print a result."""
    echo_result(result, as_json)


def stream_options(command: Command) -> Command:
    """Add the streaming options; the command receives them as `streaming`."""
    return gathered(command, _STREAM_OPTIONS, "streaming", _streaming)


def _streaming(values: Values) -> Streaming:
    return Streaming(values.pop("stream"), values.pop("sample_rows"))


_STREAM_OPTIONS = [
    click.option(
        "--stream",
        is_flag=True,
        help="Read DATA (Parquet) in passes, window by window; the files of a folder are then "
        "parts of one recording.",
    ),
    click.option(
        "--sample-rows",
        type=click.IntRange(min=1000),
        default=SAMPLE_ROWS,
        show_default=True,
        help="Samples on which effects are searched, in stretches spread over longer data; for "
        "data read in passes, the samples in memory.",
    ),
]
