"""Options for data larger than memory."""

from __future__ import annotations

from dataclasses import dataclass

import click

from stribeck.base.errors import SpecError
from stribeck.cli.common import echo_result, say
from stribeck.cli.options import Command, Values, gathered
from stribeck.recording.excerpt import SAMPLE_ROWS
from stribeck.recording.options import ReadOptions
from stribeck.scale.streaming.dataset import is_data_set
from stribeck.scale.streaming.diagnosis import StreamedDiagnosis
from stribeck.scale.streaming.improvement import StreamedImprovement
from stribeck.scale.streaming.result import StreamedFit
from stribeck.scale.streaming.stream import Stream, stream


@dataclass(frozen=True)
class Streaming:
    """Whether the data is read in passes, and how many samples are kept in memory."""

    asked: bool
    sample_rows: int

    def wanted(self, data: str) -> bool:
        """Whether `data` is read in passes: on request, or if it is several files."""
        return self.asked or is_data_set(data)

    def refuse(self, **given: bool) -> None:
        """Refuse options that need all samples in memory."""
        for flag, is_given in given.items():
            if is_given:
                raise SpecError(
                    f"--{flag} needs all samples in memory: omit it, or give one file without "
                    "--stream"
                )

    def open(self, data: str, reading: ReadOptions, seed: int) -> Stream:
        """Open `data`, and print its notes on stderr."""
        opened = stream(data, sample_rows=self.sample_rows, seed=seed, **reading.given())
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
        help="Read DATA (Parquet) in passes, window by window; folders and patterns always are.",
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
