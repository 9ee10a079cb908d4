"""Who does the work: processes of this machine, a Dask cluster, or any other executor."""

from __future__ import annotations

import contextlib
import logging
import os
import socket
import time
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future
from concurrent.futures.process import BrokenProcessPool
from typing import Any, Protocol

from stribeck.base.errors import StribeckError
from stribeck.base.pool import LocalPool, worker_count

#: What keeps the libraries of a worker to one thread each: there is a worker for every core.
ONE_THREAD = {
    name: "1"
    for name in (
        "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "POLARS_MAX_THREADS",
    )
}  # fmt: skip
#: Seconds between questions to a scheduler how many workers there are.
BETWEEN_COUNTS = 2.0
GOES_ON = "what is done is kept, and the same command goes on from there"


class Crew(Protocol):
    """An executor, and what to do when it loses workers.

    Attributes
    ----------
    breaks
        Whether the loss of one worker ends the executor with all that is under way.
    kills_per_loss
        How many workers have died with a piece when the executor says that it is lost.
    """

    breaks: bool
    kills_per_loss: int

    def executor(self) -> Executor:
        """The executor to submit to."""

    def width(self) -> int:
        """How many pieces to have under way."""

    def is_loss(self, error: BaseException) -> bool:
        """Whether an error means that a worker died, and not that the work cannot be done."""

    def renew(self) -> None:
        """Replace a broken executor; raises StribeckError where that is not ours to do."""

    def lost(self) -> StribeckError:
        """The error of an executor that dropped what it was given."""

    def close(self) -> None:
        """No more work; what is still under way is dropped."""


class Processes:
    """Processes of this machine. One that is ended from outside is replaced.

    Raises
    ------
    StribeckError
        Processes cannot be started.
    """

    breaks = True
    kills_per_loss = 1

    def __init__(self, workers: int | None = None) -> None:
        self._workers = worker_count(workers)
        self._pool = self._start()
        try:
            self._pool.submit(os.getpid).result()
        except BrokenProcessPool:
            raise StribeckError(
                "processes cannot be started: in a script, put the call under "
                '`if __name__ == "__main__":`, or give an executor of threads'
            ) from None

    def _start(self) -> LocalPool:
        return _SingleThreaded(self._workers)

    def executor(self) -> Executor:
        return self._pool

    def width(self) -> int:
        return self._workers

    def is_loss(self, error: BaseException) -> bool:
        return isinstance(error, BrokenExecutor)

    def renew(self) -> None:
        self._pool.end()
        self._pool = self._start()

    def lost(self) -> StribeckError:
        return StribeckError(f"the processes were stopped; {GOES_ON}")

    def close(self) -> None:
        # Not waited for: a copy of a slow task may be under way still.
        self._pool.end()


class _SingleThreaded(LocalPool):
    """Processes whose libraries use one thread each."""

    def submit(self, do: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        # A process is started when there is work for it, and its libraries look once.
        with _environment(ONE_THREAD):
            return super().submit(do, *args, **kwargs)


@contextlib.contextmanager
def _environment(values: dict[str, str]) -> Iterator[None]:
    """Set variables for the processes that are started meanwhile."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


class Given:
    """An executor that the caller made, and that stays the caller's.

    Parameters
    ----------
    width
        Pieces under way; None: as many as the executor says it has workers.
    """

    breaks = True
    kills_per_loss = 1

    def __init__(self, executor: Executor, width: int | None = None) -> None:
        self._executor = executor
        known = getattr(executor, "_max_workers", None)
        self._width = width or (known if isinstance(known, int) else worker_count())

    def executor(self) -> Executor:
        return self._executor

    def width(self) -> int:
        return self._width

    def is_loss(self, error: BaseException) -> bool:
        return isinstance(error, BrokenExecutor)

    def renew(self) -> None:
        raise StribeckError(
            f"the executor is broken, most likely a worker of it was ended; {GOES_ON}"
        )

    def lost(self) -> StribeckError:
        return StribeckError(f"the executor dropped what it was given; {GOES_ON}")

    def close(self) -> None:
        pass


class Dask:
    """A Dask cluster, by the address of its scheduler (``tcp://10.0.0.7:8786``).

    Dask moves what a lost worker did to another one, and says of a piece that has ended several
    workers that it is killing them. Its log of this process is silenced, and that of what it stands
    on: what goes wrong is said in a sentence, not by tracebacks.

    Raises
    ------
    StribeckError
        The extra is not installed, or nothing answers at the address.
    """

    breaks = False
    #: Dask has tried on several workers before it says so.
    kills_per_loss = 2

    def __init__(self, address: str, note: Callable[[str], None], *, seconds: float = 10.0) -> None:
        try:
            import distributed
        except ImportError:
            raise StribeckError(
                "--scheduler needs Dask, which is not installed: pip install stribeck[fleet]"
            ) from None
        _silence("distributed", "tornado", "asyncio")
        self._loss = distributed.KilledWorker
        self._address = address
        try:
            _knock(address, seconds)
            self._client = distributed.Client(address, timeout=seconds, set_as_default=False)
        except (OSError, ValueError) as error:
            raise StribeckError(
                f"no Dask scheduler answers at {address} ({_first_line(error)}): start one with "
                f"`dask scheduler`, which says its address"
            ) from None
        self._executor: Executor = self._client.get_executor(pure=False)
        self._note, self._threads, self._counted = note, 1, -float("inf")

    def executor(self) -> Executor:
        return self._executor

    def width(self) -> int:
        """A piece for each thread of the cluster, which may grow and shrink meanwhile."""
        now = time.monotonic()
        if now - self._counted > BETWEEN_COUNTS:
            before, self._threads = self._threads, sum(self._client.nthreads().values())
            self._counted = now
            if before and not self._threads:
                self._note(
                    f"{self._address} has no worker: the run waits for one; start it with "
                    f"`dask worker {self._address}`"
                )
        return max(self._threads, 1)

    def is_loss(self, error: BaseException) -> bool:
        return isinstance(error, self._loss)

    def renew(self) -> None:
        pass

    def lost(self) -> StribeckError:
        return StribeckError(f"the connection to {self._address} was lost; {GOES_ON}")

    def close(self) -> None:
        self._executor.shutdown(wait=False)
        self._client.close(timeout=2)


def _knock(address: str, seconds: float) -> None:
    """Whether somebody listens: a client that could not connect would linger until the end.

    Raises
    ------
    OSError, ValueError
        Nobody does, or the address is none.
    """
    protocol, _, place = address.rpartition("://")
    if protocol in ("", "tcp", "tls"):
        host, _, port = place.rpartition(":")
        if not (host and port.isdecimal()):
            raise ValueError("an address is like tcp://10.0.0.7:8786")
        socket.create_connection((host.strip("[]"), int(port)), seconds).close()


def _silence(*packages: str) -> None:
    """Let packages log nothing but what ends them; some of their loggers have their own levels."""
    for name in [*packages, *logging.root.manager.loggerDict]:
        if name.partition(".")[0] in packages:
            logging.getLogger(name).setLevel(logging.CRITICAL)


def _first_line(error: BaseException) -> str:
    return (str(error) or type(error).__name__).splitlines()[0]
