"""Where the tasks of a fleet run: processes of this machine, a Dask cluster, or any executor."""

from __future__ import annotations

import logging
import socket
import time
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor
from typing import Protocol

from stribeck.base.errors import SpecError, StribeckError, option
from stribeck.base.pool import ProcessPool, worker_count
from stribeck.scale.fleet.cluster import ClusterExecutor

#: Seconds between two questions to a scheduler about its number of workers.
BETWEEN_COUNTS = 2.0
CONTINUES = "finished tasks are kept, and the same command continues from there"


class Backend(Protocol):
    """An executor, and its behaviour when workers are lost.

    Attributes
    ----------
    breaks
        Whether the loss of one worker breaks the executor and loses all unfinished tasks.
    kills_per_loss
        How many workers have died with a task when the executor reports it as lost.
    """

    breaks: bool
    kills_per_loss: int

    def executor(self) -> Executor:
        """Return the executor to submit to."""

    def width(self) -> int:
        """Return how many tasks to keep submitted."""

    def is_loss(self, error: BaseException) -> bool:
        """Return whether an error means that a worker died, and not that the task failed."""

    def renew(self) -> None:
        """Replace a broken executor; raises StribeckError if the caller owns it."""

    def lost(self) -> StribeckError:
        """Return the error of an executor that dropped its tasks."""

    def close(self) -> None:
        """Stop; unfinished tasks are dropped."""


class Processes:
    """Worker processes of this machine; killed ones are replaced."""

    breaks = True
    kills_per_loss = 1

    def __init__(self, workers: int | None = None) -> None:
        self._workers = worker_count(workers)
        self._pool = ProcessPool(self._workers)

    def executor(self) -> Executor:
        return self._pool

    def width(self) -> int:
        return self._workers

    def is_loss(self, error: BaseException) -> bool:
        return isinstance(error, BrokenExecutor)

    def renew(self) -> None:
        self._pool.end()
        self._pool = ProcessPool(self._workers)

    def lost(self) -> StribeckError:
        return StribeckError(f"the worker processes were stopped; {CONTINUES}")

    def close(self) -> None:
        # Not waited for: a second copy of a slow task may still run.
        self._pool.end()


class GivenExecutor:
    """An executor that the caller made and will shut down.

    Parameters
    ----------
    width
        How many tasks to keep submitted; None: one for each worker of the executor.
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
            f"the executor is broken, most likely because a worker was killed; {CONTINUES}"
        )

    def lost(self) -> StribeckError:
        return StribeckError(f"the executor dropped its tasks; {CONTINUES}")

    def close(self) -> None:
        pass


class DaskCluster:
    """A Dask cluster, given by the address of its scheduler (``tcp://10.0.0.7:8786``).

    Dask moves the tasks of a lost worker to another worker, and reports a task during which several
    workers died. The logs of Dask and of the packages below it are silenced in this process: errors
    are reported in one sentence, without tracebacks.

    Raises
    ------
    StribeckError
        Dask is not installed, or nothing answers at the address.
    """

    breaks = False
    #: Dask reports a task as lost after several workers have died with it.
    kills_per_loss = 2

    def __init__(self, address: str, note: Callable[[str], None], *, seconds: float = 10.0) -> None:
        try:
            import distributed
        except ImportError:
            raise StribeckError(
                f"{option('scheduler')} needs Dask, which is not installed: pip install "
                f"stribeck[fleet]"
            ) from None
        _silence("distributed", "tornado", "asyncio")
        self._loss = distributed.KilledWorker
        self._address = address
        try:
            _check_address(address, seconds)
            self._client = distributed.Client(address, timeout=seconds, set_as_default=False)
        except (OSError, ValueError) as error:
            raise StribeckError(
                f"no Dask scheduler answers at {address} ({_first_line(error)}): start one with "
                f"`dask scheduler`, which prints its address"
            ) from None
        self._executor = ClusterExecutor(self._client)
        self._note, self._threads, self._counted = note, 1, -float("inf")

    def executor(self) -> Executor:
        # A call that is made while the client looks for its scheduler would never end.
        if self._client.status != "running":
            raise self.lost()
        return self._executor

    def width(self) -> int:
        """Return the number of threads of the cluster, which may grow and shrink during a run."""
        now = time.monotonic()
        if now - self._counted > BETWEEN_COUNTS:
            before, self._threads = self._threads, sum(self._client.nthreads().values())
            self._counted = now
            if before and not self._threads:
                self._note(
                    f"{self._address} has no worker, and the run waits for one: start it with "
                    f"`dask worker {self._address}`"
                )
        return max(self._threads, 1)

    def is_loss(self, error: BaseException) -> bool:
        return isinstance(error, self._loss)

    def renew(self) -> None:
        pass

    def lost(self) -> StribeckError:
        return StribeckError(f"the connection to {self._address} was lost; {CONTINUES}")

    def close(self) -> None:
        self._client.close(timeout=2)


def backend_of(
    executor: Executor | None,
    workers: int | None,
    scheduler: str | None,
    note: Callable[[str], None],
) -> Backend:
    """Return the backend that the arguments of `fleet` select.

    Raises
    ------
    StribeckError
        Both an executor and a scheduler are given, or the backend cannot be started.
    """
    if executor is not None and scheduler is not None:
        raise SpecError("an executor and a scheduler are given: leave one out")
    if scheduler is not None:
        return DaskCluster(scheduler, note)
    return Processes(workers) if executor is None else GivenExecutor(executor, workers)


def _check_address(address: str, seconds: float) -> None:
    """Check the connection first, because a Dask client would try forever to connect.

    Raises
    ------
    OSError, ValueError
        Nothing listens, or the address is malformed.
    """
    from distributed.comm.registry import get_backend

    protocol, _, place = address.rpartition("://")
    if protocol:
        # A client of an unknown protocol waits for 20 s when it is thrown away.
        get_backend(protocol)
    if protocol in ("", "tcp", "tls"):
        host, _, port = place.rpartition(":")
        if not (host and port.isdecimal()):
            raise ValueError("an address looks like tcp://10.0.0.7:8786")
        socket.create_connection((host.strip("[]"), int(port)), seconds).close()


def _silence(*packages: str) -> None:
    """Let packages log critical errors only; some of their loggers have levels of their own."""
    for name in [*packages, *logging.root.manager.loggerDict]:
        if name.partition(".")[0] in packages:
            logging.getLogger(name).setLevel(logging.CRITICAL)


def _first_line(error: BaseException) -> str:
    return (str(error) or type(error).__name__).splitlines()[0]
