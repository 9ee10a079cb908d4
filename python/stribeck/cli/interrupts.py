"""Ctrl-C: one line that says what was written, whenever it comes."""

from __future__ import annotations

import os
import signal
import sys
from types import FrameType
from typing import NoReturn

from stribeck.base.errors import one_line

#: Exit code of a command that was stopped, as shells have it.
STOPPED = 130


def while_starting() -> None:
    """Have Ctrl-C end the process at once: an import that it breaks off shows a traceback."""
    signal.signal(signal.SIGINT, _end_at_once)


def while_working() -> None:
    """Have Ctrl-C raise `KeyboardInterrupt`, so that half-written files are removed."""
    if signal.getsignal(signal.SIGINT) is _end_at_once:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def while_ending() -> None:
    """Ignore Ctrl-C: the result is there, and the interpreter would show a traceback."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _end_at_once(number: int, frame: FrameType | None) -> NoReturn:
    # Not through the streams: the interrupt may have come in the middle of a write to them.
    os.write(2, b"stribeck: stopped; nothing was written\n")
    os._exit(STOPPED)


def stop(written: list[str]) -> NoReturn:
    """End the process after Ctrl-C; a second one is ignored.

    Parameters
    ----------
    written
        Paths of the files that were written.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    done = ", ".join(written) if written else "nothing"
    verb = "were" if len(written) > 1 else "was"
    print(one_line(f"stribeck: stopped; {done} {verb} written"), file=sys.stderr, flush=True)
    # Without the clean-up of the interpreter, which would wait for threads that still search.
    os._exit(STOPPED)
