"""Progress of long work on stderr: a bar on a terminal, a line now and then in a file."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, NoReturn

from stribeck.cli.common import say

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID

#: Least time between two lines where stderr is not a terminal, s.
SECONDS_BETWEEN_LINES = 20.0


class _Shown:
    """What both kinds of progress share: one bar at a time, and the time of the last line."""

    def __init__(self) -> None:
        self._bar: tuple[Bar, TaskID] | None = None
        self._said = time.monotonic()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _update(self, label: str, unit: str, done: int, total: int) -> None:
        """Move the bar; it starts at the first number told."""
        if self._bar is None:
            self._bar = _bar(label, unit, done, total)
        bar, task = self._bar
        bar.update(task, completed=done)

    def _line_is_due(self, done: int, total: int) -> bool:
        now = time.monotonic()
        if now - self._said < SECONDS_BETWEEN_LINES or done == total:
            return False
        self._said = now
        return True

    def close(self) -> None:
        """Stop the bar and leave its line."""
        if self._bar is not None:
            self._bar[0].stop()
            self._bar = None


def _bar(label: str, unit: str, done: int, total: int) -> tuple[Bar, TaskID]:
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    bar = Progress(
        TextColumn(label),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn(unit),
        TimeRemainingColumn(),
        console=Console(stderr=True),
    )
    task = bar.add_task(label, total=total, completed=done)
    bar.start()
    return bar, task


class Progress(_Shown):
    """Progress of many pieces of work.

    Parameters
    ----------
    what : str
        The pieces of work, in the plural.
    """

    def __init__(self, what: str = "fits") -> None:
        super().__init__()
        self.what = what
        self.done = self.total = 0
        self._began: tuple[float, int] | None = None

    def __enter__(self) -> Progress:
        return self

    def show(self, done: int, total: int) -> None:
        """Called after each piece, with the pieces done and their total."""
        self.done, self.total = done, total
        if sys.stderr.isatty():
            self._update("", self.what, done, total)
            return
        if self._began is None:
            self._began = time.monotonic(), done
        if self._line_is_due(done, total):
            say(f"note: {done} of {total} {self.what}{self._time_left()}")

    def _time_left(self) -> str:
        """The time left by the pieces done in this run; pieces of an earlier run tell nothing."""
        began, before = self._began or (0.0, self.done)
        if self.done <= before:
            return ""
        seconds = (self._said - began) / (self.done - before) * (self.total - self.done)
        return f", about {_duration(seconds)} left"


class RowProgress(_Shown):
    """Progress of passes over a data set, in samples."""

    def __init__(self) -> None:
        super().__init__()
        self._pass = 0
        self._began = time.monotonic()

    def __enter__(self) -> RowProgress:
        return self

    def show_pass(self, done: int, total: int, number: int) -> None:
        """Called after each window: samples done, their total, and the number of the pass."""
        if number != self._pass:
            self.close()
            self._pass, self._began = number, time.monotonic()
        if sys.stderr.isatty():
            self._update(f"pass {number}", "samples", done, total)
            return
        if self._line_is_due(done, total):
            rate = done / max(self._said - self._began, 1e-9)
            left = _duration((total - done) / rate)
            say(
                f"note: pass {number}: {done} of {total} samples, {rate:.2g} per second, about "
                f"{left} left"
            )


def _duration(seconds: float) -> str:
    """A duration to two digits.

    Examples
    --------
    >>> _duration(50.0), _duration(600.0), _duration(9000.0)
    ('50 s', '10 min', '2.5 h')
    """
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


def stop_with(bar: Progress, work: str, folder: str) -> NoReturn:
    """Leave the command after Ctrl-C; what is finished is in `folder`."""
    bar.close()
    say(
        f"stribeck: stopped after {bar.done or 'no'} {bar.what} of {bar.total or work}; the "
        f"finished part is in {folder}, and the same command continues it"
    )
    sys.exit(130)
