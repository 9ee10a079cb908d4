"""Independent pieces of work on several processes or threads of this machine.

The processes are those of loky, which joblib includes. Three things are added here: workers ignore
Ctrl-C, because the parent process ends them; workers exit when the parent process dies; and the
libraries in each worker use one thread, because there is one worker for each core.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
import time
import warnings
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from multiprocessing import resource_tracker
from types import TracebackType
from typing import ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

from stribeck.base.errors import StribeckError, option

Arguments = ParamSpec("Arguments")
Piece = TypeVar("Piece")
Result = TypeVar("Result")

#: Pieces submitted for each worker, so that none waits for the next one.
QUEUED_PER_WORKER = 2
#: Environment of a worker: its libraries use one thread each.
ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "POLARS_MAX_THREADS"), "1"
)
#: Seconds between a worker's checks that its parent is alive.
PARENT_CHECK = 0.5
#: A warning of loky: it replaces a worker that has grown by 300 MB, which loses no work.
REPLACED = "A worker stopped while some jobs"


#: Warning filter for loky's tracker of semaphores, which is a process of its own. After a worker
#: was killed, it warns of semaphores that no longer exist.
TRACKER = "ignore:resource_tracker"


class Stopped(Exception):
    """The user stopped the work with Ctrl-C; finished results were handed over."""


def worker_count(wanted: int | None = None) -> int:
    """Return the number of processes to use: `wanted`, or one for each available core."""
    if wanted is not None:
        return wanted
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def threads() -> int:
    """Return the number of threads of a search: OMP_NUM_THREADS, or one for each core.

    It is 1 in a worker process.
    """
    said = os.environ.get("OMP_NUM_THREADS", "")
    if said.isdigit() and int(said) > 0:
        return int(said)
    return worker_count() if multiprocessing.parent_process() is None else 1


class _SerialLinearAlgebra(contextlib.ContextDecorator):
    """Products of matrices use one thread, while at least one caller needs it.

    With several threads the bits of a product depend on their number, and between the products the
    idle threads of OpenBLAS keep a core busy, which threads of our own need.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._callers = 0
        self._limit: threadpool_limits | None = None

    def __enter__(self) -> None:
        with self._lock:
            if self._callers == 0:
                self._limit = threadpool_limits(1, user_api="blas")
            self._callers += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._callers -= 1
            if self._callers == 0 and self._limit is not None:
                self._limit.restore_original_limits()


#: For `with`, and as a decorator; from any thread.
serial_linear_algebra = _SerialLinearAlgebra()


@contextlib.contextmanager
def on_threads() -> Iterator[ThreadPoolExecutor]:
    """Yield a pool of `threads` threads; linear algebra uses one thread in each."""
    with serial_linear_algebra, ThreadPoolExecutor(threads()) as pool:
        yield pool


def on_each(do: Callable[[Piece], Result], pieces: Iterable[Piece]) -> list[Result]:
    """Results of `do` for each piece, in their order, made on `threads` threads.

    Examples
    --------
    >>> on_each(abs, (-1, 2, -3))
    [1, 2, 3]
    """
    several = list(pieces)
    if len(several) < 2:
        return [do(piece) for piece in several]
    with on_threads() as pool:
        return list(pool.map(do, several))


class ProcessPool(Executor):
    """Worker processes of this machine, started with the first piece of work.

    Use it as a context manager: an exception ends the workers at once.

    Parameters
    ----------
    workers
        Number of processes.
    begin
        Called once in each worker before its first piece of work.

    Notes
    -----
    A worker that dies breaks the pool: `submit` and all unfinished futures then raise
    `concurrent.futures.BrokenExecutor`.
    """

    def __init__(self, workers: int, begin: Callable[[], None] | None = None) -> None:
        # Imported here: joblib is slow to import, and most commands start no processes.
        from joblib.externals.loky import ProcessPoolExecutor

        warnings.filterwarnings("ignore", REPLACED, UserWarning)
        _silence_tracker()
        self.workers = workers
        self._pool = ProcessPoolExecutor(
            workers, initializer=_begin, initargs=(os.getpid(), begin), env=ONE_THREAD
        )

    def submit(
        self,
        do: Callable[Arguments, Result],
        /,
        *args: Arguments.args,
        **kwargs: Arguments.kwargs,
    ) -> Future[Result]:
        """Call `do` in one of the workers."""
        with _interrupts_blocked():
            return self._pool.submit(do, *args, **kwargs)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the workers when the submitted work is done; at once with `cancel_futures`."""
        self._pool.shutdown(wait=wait, kill_workers=cancel_futures)

    def end(self) -> None:
        """Kill the workers, whatever they are doing."""
        self.shutdown(wait=False, cancel_futures=True)

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


def _silence_tracker() -> None:
    """Have the tracker, which loky starts with the first worker, print no warnings."""
    filters = [text for text in os.environ.get("PYTHONWARNINGS", "").split(",") if text]
    if TRACKER not in filters:
        os.environ["PYTHONWARNINGS"] = ",".join([*filters, TRACKER])


def run_each(
    do: Callable[[Piece], Result],
    pieces: Iterable[Piece],
    finished: Callable[[Result], None],
    pool: ProcessPool | None,
    *,
    what: str = "the work",
) -> None:
    """Process every piece, and hand over each result when it is ready, in any order.

    Parameters
    ----------
    do
        Called with each piece.
    finished
        Called in this process with each result.
    pool
        The workers; None: this process.
    what
        Named in the error when a worker dies: "the study".

    Raises
    ------
    Stopped
        On Ctrl-C. Unfinished work is dropped at once.
    StribeckError
        A worker was killed.
    """
    try:
        if pool is None:
            for piece in pieces:
                finished(do(piece))
        else:
            _run_each(do, pieces, finished, pool)
    except BrokenExecutor:
        raise StribeckError(
            f"a worker process of {what} was killed, most likely because memory ran out: give "
            f"{option('workers')} a smaller number; the same command continues from the work done"
        ) from None
    except KeyboardInterrupt:
        if pool is not None:
            pool.end()
        raise Stopped from None


def _run_each(
    do: Callable[[Piece], Result],
    pieces: Iterable[Piece],
    finished: Callable[[Result], None],
    pool: ProcessPool,
) -> None:
    """Keep a few pieces submitted for each worker until all are done."""
    waiting = iter(pieces)
    pending: set[Future[Result]] = set()

    def submit(count: int) -> None:
        for _, piece in zip(range(count), waiting, strict=False):
            pending.add(pool.submit(do, piece))

    submit(QUEUED_PER_WORKER * pool.workers)
    while pending:
        done, rest = wait(pending, return_when=FIRST_COMPLETED)
        pending = set(rest)
        for future in done:
            finished(future.result())
        submit(len(done))


def _begin(parent: int, begin: Callable[[], None] | None) -> None:
    """Prepare a worker process."""
    threading.Thread(target=_exit_without, args=(parent,), daemon=True).start()
    # Libraries such as LAPACK print errors to stdout, where the command prints its one answer.
    os.dup2(2, 1)
    threadpool_limits(1, user_api="blas")
    if begin is not None:
        begin()


def _exit_without(parent: int) -> None:
    """Exit when the parent process has died; loky's workers would wait for work forever."""
    while os.getppid() == parent:
        time.sleep(PARENT_CHECK)
    os._exit(1)


@contextlib.contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Block Ctrl-C here and in the processes started meanwhile, which inherit that.

    In this process an interrupt is only delayed until the end of the context.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # Started lazily, it would unblock the signal again.
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
