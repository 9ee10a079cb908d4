"""`stribeck fit` of data sets that are larger than memory."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import click

from stribeck.cli.common import echo_json, say
from stribeck.cli.progress import RowProgress
from stribeck.errors import SpecError
from stribeck.model import Model
from stribeck.streaming import is_data_set, stream
from stribeck.streaming.sample import SAMPLE_ROWS

F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True)
class Streaming:
    """Whether all of the data is read into memory, and if not, how much of it."""

    asked: bool
    sample_rows: int

    def wanted(self, data: str) -> bool:
        """Whether `data` is read in passes: as asked, and where it stands for several files."""
        return self.asked or is_data_set(data)

    def refuse(self, **given: bool) -> None:
        """Refuse options that need all rows in memory."""
        for flag, is_given in given.items():
            if is_given:
                raise SpecError(
                    f"--{flag} needs all rows in memory: leave it out, or give one file without "
                    "--stream"
                )

    def fit(
        self, data: str, model: Model, reading: dict[str, Any], output: str | None, *,
        starts: int, seed: int, as_json: bool,
    ) -> None:  # fmt: skip
        """Identify `model` on all rows, print the result and write its model file."""
        opened = stream(data, sample_rows=self.sample_rows, seed=seed, **reading)
        for note in opened.sample.recording.notes:
            say(f"note: {note}")
        with RowProgress() as bar:
            fitted = opened.fit(model, starts=starts, seed=seed, told=bar.show_pass)
        if output is not None:
            fitted.model_file().write(output)
            say(f"wrote {output}")
        if as_json:
            echo_json(fitted.to_dict())
        else:
            click.echo(repr(fitted))


def stream_options(command: F) -> F:
    """Add the options of data larger than memory; the command gets them as `streaming`."""

    @functools.wraps(command)
    def wrapper(**given: Any) -> Any:
        streaming = Streaming(given.pop("stream"), given.pop("sample_rows"))
        return command(streaming=streaming, **given)

    decorated: Any = wrapper
    for option in reversed(_STREAM_OPTIONS):
        decorated = option(decorated)
    return decorated


_STREAM_OPTIONS = [
    click.option(
        "--stream", is_flag=True,
        help="Read DATA (Parquet) in passes, a window at a time; a folder or pattern always is.",
    ),
    click.option(
        "--sample-rows", type=click.IntRange(min=1000), default=SAMPLE_ROWS, show_default=True,
        help="Rows of such data in memory, in stretches spread over it: for bounds and starts.",
    ),
]  # fmt: skip
