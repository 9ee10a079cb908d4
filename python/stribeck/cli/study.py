"""`stribeck study`: many laws on every joint of a recording, from many starts."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from types import TracebackType
from typing import Any

import click

from stribeck.cli.common import (
    echo_json,
    json_option,
    recording_options,
    say,
    seed_option,
    starts_option,
)
from stribeck.study import REVIEW, Stopped
from stribeck.study import study as make_study

#: Where nobody watches, progress is a line at most every so many seconds.
SECONDS_BETWEEN_LINES = 20.0


@click.command()
@click.argument("data")
@click.option(
    "--law", "laws", multiple=True, metavar="SPEC",
    help="A law to fit; may be given several times. [default: the 25 of the review]",
)  # fmt: skip
@click.option(
    "-o", "--output", type=click.Path(file_okay=False), default=None,
    help="Folder of the study. [default: DATA's name with .study]",
)  # fmt: skip
@starts_option
@click.option(
    "--low-speed", type=float, default=None,
    help="What the tables call low speed. [default: 0.1 rad/s, or 0.01 m/s]",
)  # fmt: skip
@click.option(
    "--workers", type=click.IntRange(min=1), default=None,
    help="Processes. [default: one for each core]",
)  # fmt: skip
@recording_options
@seed_option
@json_option
def study(
    data: str, laws: tuple[str, ...], output: str | None, starts: int, low_speed: float | None,
    workers: int | None, reading: dict[str, Any], seed: int, as_json: bool,
) -> None:  # fmt: skip
    """Fit many laws to every joint of DATA and compare them, as the UR5e review does.

    Every fit is saved as it ends. Ctrl-C stops; the same command goes on from there.
    """
    folder = output if output is not None else f"{Path(data).stem}.study"
    with _Bar() as bar:
        try:
            result = make_study(
                data, folder, laws or REVIEW, starts=starts, seed=seed, low_speed=low_speed,
                workers=workers, progress=bar.show, **reading,
            )  # fmt: skip
        except (Stopped, KeyboardInterrupt):
            bar.close()
            say(
                f"stribeck: stopped after {bar.done or 'no'} fits of {bar.total or 'the study'}; "
                f"what is done is in {folder}, and the same command goes on from there"
            )
            sys.exit(130)
    if as_json:
        echo_json(result.to_dict())
    else:
        click.echo(repr(result))


class _Bar:
    """A progress bar with the time left on stderr, or a line now and then where it is a file."""

    def __init__(self) -> None:
        self.done = self.total = 0
        self._bar: Any = None
        self._said = time.monotonic()
        self._began: tuple[float, int] | None = None

    def __enter__(self) -> _Bar:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def show(self, done: int, total: int) -> None:
        """Told after each fit."""
        self.done, self.total = done, total
        if not sys.stderr.isatty():
            self._say_now_and_then()
            return
        if self._bar is None:
            # Of the fits that are left: those of an earlier run say nothing about the time.
            self._bar = click.progressbar(
                length=total - done + 1, label=f"fits ({total})", file=sys.stderr, show_pos=True
            )
            self._bar.__enter__()
        self._bar.update(1)

    def _say_now_and_then(self) -> None:
        now = time.monotonic()
        if self._began is None:
            self._began = now, self.done
        if now - self._said < SECONDS_BETWEEN_LINES or self.done == self.total:
            return
        self._said = now
        began, before = self._began
        made = self.done - before
        left = f", about {_clock((now - began) / made * (self.total - self.done))} left"
        say(f"note: {self.done} of {self.total} fits{left if made else ''}")

    def close(self) -> None:
        """Leave the line."""
        if self._bar is not None:
            self._bar.__exit__(None, None, None)
            self._bar = None


def _clock(seconds: float) -> str:
    """A duration as people say it.

    Examples
    --------
    >>> _clock(50.0), _clock(600.0), _clock(9000.0)
    ('50 s', '10 min', '2.5 h')
    """
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"
