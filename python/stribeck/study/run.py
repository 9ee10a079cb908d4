"""Run a study's fits in several processes."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stribeck.errors import StribeckError
from stribeck.identify.transients import transient_rows
from stribeck.recording import Recording, read
from stribeck.study.plan import Job, Plan
from stribeck.study.trial import Trial, run_trial

#: Fits handed to each process ahead of its turn, so that none waits.
AHEAD = 2


class Stopped(Exception):
    """The user stopped the study; the fits finished so far have been handed over."""


def worker_count(wanted: int | None = None) -> int:
    """How many processes to use: `wanted`, or one for each core that may be used."""
    if wanted is not None:
        return wanted
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def run(
    plan: Plan, jobs: Iterable[Job], finished: Callable[[Trial], None], workers: int = 1
) -> None:
    """Make the fits of `jobs`, and hand each over as it ends.

    A fit depends on its job, the recording and the seed alone, so the results are the same on any
    number of processes; only their order differs.

    Raises
    ------
    Stopped
        On Ctrl-C. Fits under way are dropped at once.
    """
    if workers <= 1:
        _run_here(plan, jobs, finished)
    else:
        _run_in_processes(plan, jobs, finished, workers)


def _run_here(plan: Plan, jobs: Iterable[Job], finished: Callable[[Trial], None]) -> None:
    fit = _Fitter(plan.path, plan.reading, plan.seed)
    try:
        for job in jobs:
            finished(fit(job))
    except KeyboardInterrupt:
        raise Stopped from None


def _run_in_processes(
    plan: Plan, jobs: Iterable[Job], finished: Callable[[Trial], None], workers: int
) -> None:
    todo = iter(jobs)
    others = set(multiprocessing.active_children())
    # Not forked: polars has threads, and a fork copies their locks without the threads.
    pool = ProcessPoolExecutor(
        workers,
        mp_context=multiprocessing.get_context("spawn"),
        initializer=_begin,
        initargs=(plan.path, plan.reading, plan.seed),
    )
    pending: set[Future[Trial]] = set()

    def hand_out(count: int) -> None:
        for _, job in zip(range(count), todo, strict=False):
            with _deaf_to_interrupts():
                pending.add(pool.submit(_fit, job))

    try:
        hand_out(AHEAD * workers)
        while pending:
            done, rest = wait(pending, return_when=FIRST_COMPLETED)
            pending = set(rest)
            for future in done:
                finished(future.result())
            hand_out(len(done))
        pool.shutdown()
    except BrokenProcessPool:
        raise StribeckError(
            "a process of the study was ended from outside, most likely for want of memory: use "
            "fewer --workers; the same command goes on from the fits made so far"
        ) from None
    except KeyboardInterrupt:
        pool.shutdown(wait=False, cancel_futures=True)
        for process in set(multiprocessing.active_children()) - others:
            process.terminate()
        raise Stopped from None


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


class _Fitter:
    """Makes the fits of a study in one process; keeps the joint it read last, as jobs come so."""

    def __init__(self, path: str, reading: Mapping[str, Any], seed: int) -> None:
        self._path, self._reading, self._seed = path, reading, seed
        self._joint: str | None = None
        self._read: tuple[Recording, NDArray[np.bool_]] | None = None

    def __call__(self, job: Job) -> Trial:
        if self._read is None or self._joint != job.joint:
            self._read = None
            recording = read(self._path, **{**self._reading, "joint": job.joint})
            self._joint, self._read = job.joint, (recording, transient_rows(recording))
        recording, transient = self._read
        return run_trial(job, recording, transient, self._seed)


_fitter: _Fitter | None = None


def _begin(path: str, reading: Mapping[str, Any], seed: int) -> None:
    """Ready a process of the pool for its study."""
    global _fitter
    # Libraries such as LAPACK complain on stdout, where the study's one answer goes.
    os.dup2(2, 1)
    _fitter = _Fitter(path, reading, seed)


def _fit(job: Job) -> Trial:
    """One fit in a process of the pool."""
    assert _fitter is not None
    return _fitter(job)
