"""Long work in a process of its own, which is stopped at once by killing it."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable
from multiprocessing.connection import Connection, wait
from typing import TYPE_CHECKING, Literal, Protocol, cast

from stribeck.base.errors import StribeckError, one_line
from stribeck.base.foreign import sentence_of
from stribeck.base.pool import worker_count
from stribeck.report.workbench.exchange import Exchange

if TYPE_CHECKING:
    from multiprocessing.context import ForkServerContext, SpawnContext

#: What a process tells: a sentence, a result so far, the last result, or why there is none.
Kind = Literal["said", "known", "done", "failed"]
#: Imported once, before the first work: what is done, and what a recording is read with.
PRELOADED = (
    "stribeck.report.workbench.actions",
    "stribeck.recording.formats.columnar",
    "scipy.ndimage",
)
ENDED = (
    "the working process has ended without an answer, most likely because memory ran out: close "
    "other programs, or give less data"
)


class Telling(Protocol):
    """What long work calls to tell how far it is."""

    def __call__(self, kind: Literal["said", "known"], what: object) -> None:
        """Tell a sentence, or a result so far."""
        ...


def prepare() -> None:
    """Start what makes the first work start without delay."""
    context = _context()
    if context.get_start_method() == "forkserver":
        process = context.Process(target=int)
        process.start()
        process.join()


class Work:
    """One call of a function in a process of its own.

    Parameters
    ----------
    do : callable
        A function of a module, called with a `Telling` and `arguments`.
    title
        What it does, for people.
    told : callable
        Called in a thread with each kind of message and its content; at last once with "done" or
        "failed", unless the work is stopped.
    """

    def __init__(
        self,
        do: Callable[..., object],
        arguments: tuple[object, ...],
        title: str,
        told: Callable[[Work, Kind, object], None],
    ) -> None:
        self.title = title
        self.began = time.monotonic()
        self.said = ""
        self._stopped = False
        self._told = told
        context = _context()
        here, there = context.Pipe()
        self._exchange = Exchange(here, "a")
        self._process = context.Process(target=_run, args=(there,), daemon=True)
        threading.Thread(
            target=self._listen, args=(there, (do, arguments)), daemon=True, name=title
        ).start()

    @property
    def seconds(self) -> float:
        """Time since it began, s."""
        return time.monotonic() - self.began

    def stop(self) -> None:
        """Kill the process; nothing more is told."""
        self._stopped = True
        if self._process.pid is not None:
            self._process.kill()

    def _listen(self, there: Connection, call: object) -> None:
        try:
            self._process.start()
            there.close()
            if self._stopped:
                self._process.kill()
            self._exchange.send(call)
            kind: Kind = "said"
            while kind in ("said", "known"):
                kind, content = cast("tuple[Kind, object]", self._exchange.receive())
                self._tell(kind, content)
        except (EOFError, OSError):
            self._tell("failed", ENDED)
        # It has no id where the command ended before the process began.
        if self._process.pid is not None:
            self._process.join()

    def _tell(self, kind: Kind, content: object) -> None:
        if self._stopped:
            return
        if kind == "said":
            self.said = str(content)
        self._told(self, kind, content)


def _context() -> ForkServerContext | SpawnContext:
    """Processes that start from a clean one, in which the package is imported already."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(PRELOADED))
    return context


def _run(connection: Connection) -> None:
    """Do the one call that is sent, in the new process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Libraries such as LAPACK print to stdout, where the command prints the address alone.
    os.dup2(2, 1)
    os.environ.setdefault("OMP_NUM_THREADS", str(worker_count()))
    threading.Thread(target=_end_with_parent, daemon=True).start()
    exchange = Exchange(connection, "b")
    do, arguments = cast("tuple[Callable[..., object], tuple[object, ...]]", exchange.receive())

    def tell(kind: Literal["said", "known"], what: object) -> None:
        exchange.send((kind, what))

    try:
        exchange.send(("done", do(tell, *arguments)))
    except StribeckError as error:
        exchange.send(("failed", str(error)))
    except Exception as error:
        if os.environ.get("STRIBECK_DEBUG"):
            raise
        said = one_line(f"{type(error).__name__}: {error}", 300)
        sentence = sentence_of(error) or (
            f"unexpected {said}; this is a defect, please report it (STRIBECK_DEBUG=1 shows where)"
        )
        exchange.send(("failed", sentence))


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)
