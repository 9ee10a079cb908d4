"""Many independent pieces of work in several processes, which Ctrl-C ends at once."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from concurrent.futures.process import BrokenProcessPool
from types import TracebackType
from typing import Any, TypeVar

from threadpoolctl import threadpool_limits

from stribeck.base.errors import StribeckError

Work = TypeVar("Work")
Result = TypeVar("Result")

#: Pieces handed to each process ahead of its turn, so that none waits.
AHEAD = 2


class Stopped(Exception):
    """The user stopped the work; what was finished has been handed over."""


def worker_count(wanted: int | None = None) -> int:
    """How many processes to use: `wanted`, or one for each core that may be used."""
    if wanted is not None:
        return wanted
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def threads() -> int:
    """On how many threads to search: as OMP_NUM_THREADS says, else one for each core.

    A process of a pool has a core to itself.
    """
    said = os.environ.get("OMP_NUM_THREADS", "")
    if said.isdigit() and int(said) > 0:
        return int(said)
    return worker_count() if multiprocessing.parent_process() is None else 1


@contextlib.contextmanager
def on_threads() -> Iterator[ThreadPoolExecutor]:
    """A pool of `threads`, each of which keeps to itself in linear algebra too."""
    with threadpool_limits(1, user_api="blas"), ThreadPoolExecutor(threads()) as pool:
        yield pool


def in_processes(
    do: Callable[[Work], Result],
    pieces: Iterable[Work],
    finished: Callable[[Result], None],
    pool: LocalPool,
    *,
    what: str = "the work",
) -> None:
    """Do every piece, and hand each result over as it is ready, in any order.

    Parameters
    ----------
    do
        A function of a module: new processes find it by name.
    what
        Named in the error when a process dies: "the study".

    Raises
    ------
    Stopped
        On Ctrl-C. Work under way is dropped at once.
    StribeckError
        A process was ended from outside.
    """
    todo = iter(pieces)
    pending: set[Future[Result]] = set()

    def hand_out(count: int) -> None:
        for _, piece in zip(range(count), todo, strict=False):
            pending.add(pool.submit(do, piece))

    try:
        hand_out(AHEAD * pool.workers)
        while pending:
            done, rest = wait(pending, return_when=FIRST_COMPLETED)
            pending = set(rest)
            for future in done:
                finished(future.result())
            hand_out(len(done))
    except BrokenProcessPool:
        raise StribeckError(
            f"a process of {what} was ended from outside, most likely for want of memory: use "
            f"fewer --workers; the same command goes on from what is done so far"
        ) from None
    except KeyboardInterrupt:
        pool.end()
        raise Stopped from None


class LocalPool(ProcessPoolExecutor):
    """Processes of this machine that do not hear Ctrl-C and can be ended at once.

    As a context, an exception ends them.

    Parameters
    ----------
    workers
        How many processes.
    begin, arguments
        Each process first calls `begin` with `arguments`: a function of a module.
    """

    def __init__(
        self,
        workers: int,
        begin: Callable[..., None] | None = None,
        arguments: tuple[Any, ...] = (),
    ) -> None:
        self.workers = workers
        self._others = set(multiprocessing.active_children())
        # Not forked: polars has threads, and a fork copies their locks without the threads.
        super().__init__(
            workers,
            mp_context=multiprocessing.get_context("spawn"),
            initializer=_begin,
            initargs=(begin, arguments),
        )

    def submit(self, do: Callable[..., Result], /, *args: Any, **kwargs: Any) -> Future[Result]:
        """Do something in one of the processes, which are started as they are needed."""
        with _deaf_to_interrupts():
            return super().submit(do, *args, **kwargs)

    def end(self) -> None:
        """End the processes at once, whatever they are doing."""
        self.shutdown(wait=False, cancel_futures=True)
        for process in set(multiprocessing.active_children()) - self._others:
            process.terminate()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if error is None:
            self.shutdown()
        else:
            self.end()


def _begin(begin: Callable[..., None] | None, arguments: tuple[Any, ...]) -> None:
    """Ready a process of the pool."""
    # Libraries such as LAPACK complain on stdout, where the command's one answer goes.
    os.dup2(2, 1)
    # A process of a pool has a core to itself; threads that wait for work spin.
    threadpool_limits(1, user_api="blas")
    if begin is not None:
        begin(*arguments)


@contextlib.contextmanager
def _deaf_to_interrupts() -> Iterator[None]:
    """Start processes that do not hear Ctrl-C: the one that started them ends them.

    A process inherits the signals that are blocked where it is started. Here they are only put
    off: an interrupt that comes meanwhile is delivered afterwards.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
