"""Progress of many like pieces of work, on stderr, with the time left."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import Any

import click

from stribeck.cli.common import say

#: Where nobody watches, progress is a line at most every so many seconds.
SECONDS_BETWEEN_LINES = 20.0


class Progress:
    """A progress bar with the time left on stderr, or a line now and then where it is a file.

    Parameters
    ----------
    what : str
        The pieces of work, in the plural.
    """

    def __init__(self, what: str = "fits") -> None:
        self.what = what
        self.done = self.total = 0
        self._bar: Any = None
        self._said = time.monotonic()
        self._began: tuple[float, int] | None = None

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def show(self, done: int, total: int) -> None:
        """Told after each piece."""
        self.done, self.total = done, total
        if not sys.stderr.isatty():
            self._say_now_and_then()
            return
        if self._bar is None:
            # Of the pieces that are left: those of an earlier run say nothing about the time.
            self._bar = click.progressbar(
                length=total - done + 1, label=f"{self.what} ({total})", file=sys.stderr,
                show_pos=True,
            )  # fmt: skip
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
        left = ""
        if self.done > before:
            seconds = (now - began) / (self.done - before) * (self.total - self.done)
            left = f", about {_clock(seconds)} left"
        say(f"note: {self.done} of {self.total} {self.what}{left}")

    def close(self) -> None:
        """Leave the line."""
        if self._bar is not None:
            self._bar.__exit__(None, None, None)
            self._bar = None


class RowProgress:
    """Rows done of a pass over a data set, how many a second, and the time left, on stderr."""

    def __init__(self) -> None:
        self._pass = self._done = 0
        self._bar: Any = None
        self._began = self._said = time.monotonic()

    def __enter__(self) -> RowProgress:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._close()

    def show_pass(self, done: int, total: int, number: int) -> None:
        """Told after each window: rows done and in all, of which pass."""
        if number != self._pass:
            self._close()
            self._pass, self._done, self._began = number, 0, time.monotonic()
        step, self._done = done - self._done, done
        if not sys.stderr.isatty():
            self._say_now_and_then(done, total)
            return
        if self._bar is None:
            self._bar = click.progressbar(
                length=total, label=f"pass {number}", file=sys.stderr, show_pos=True,
                item_show_func=lambda item: None if item is None else f"{self._rate():.2g} rows/s",
            )  # fmt: skip
            self._bar.__enter__()
        self._bar.update(step, done)

    def _rate(self) -> float:
        return self._done / max(time.monotonic() - self._began, 1e-9)

    def _say_now_and_then(self, done: int, total: int) -> None:
        now = time.monotonic()
        if now - self._said < SECONDS_BETWEEN_LINES or done == total:
            return
        self._said = now
        rate = self._rate()
        left = _clock((total - done) / rate)
        say(f"note: pass {self._pass}: {done} of {total} rows, {rate:.2g} a second, {left} left")

    def _close(self) -> None:
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
