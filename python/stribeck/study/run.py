"""Run a study's fits in several processes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.transients import transient_rows
from stribeck.parallel import Stopped, in_processes
from stribeck.recording import Recording, read
from stribeck.study.plan import Job, Plan
from stribeck.study.trial import Trial, run_trial


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
        in_processes(
            _fit, jobs, finished, workers,
            begin=_begin, arguments=(plan.path, plan.reading, plan.seed), what="the study",
        )  # fmt: skip


def _run_here(plan: Plan, jobs: Iterable[Job], finished: Callable[[Trial], None]) -> None:
    fit = _Fitter(plan.path, plan.reading, plan.seed)
    try:
        for job in jobs:
            finished(fit(job))
    except KeyboardInterrupt:
        raise Stopped from None


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
    _fitter = _Fitter(path, reading, seed)


def _fit(job: Job) -> Trial:
    """One fit in a process of the pool."""
    assert _fitter is not None
    return _fitter(job)
