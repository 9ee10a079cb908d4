"""Run a study's fits in several processes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.transients import transient_rows
from stribeck.parallel import Stopped, in_processes
from stribeck.recording import Recording, read
from stribeck.study.plan import Job, Plan
from stribeck.study.trial import Trial, run_trials

#: All starts of a law on a joint.
Piece = tuple[Job, ...]


def run(
    plan: Plan, todo: Collection[Job], finished: Callable[[Trial], None], workers: int = 1
) -> None:
    """Make the fits `todo`, and hand each over as it ends.

    The starts of a law on a joint are fitted together, and again if one of them is missing: so the
    results are the same on any number of processes, and of a study that was stopped.

    Raises
    ------
    Stopped
        On Ctrl-C. Fits under way are dropped at once.
    """
    pieces, missing = plan.pieces(todo), set(todo)

    def made(trials: list[Trial]) -> None:
        for trial in trials:
            if trial.job in missing:
                finished(trial)

    if workers <= 1:
        _run_here(plan, pieces, made)
    else:
        in_processes(
            _fit, pieces, made, workers,
            begin=_begin, arguments=(plan.path, plan.reading, plan.seed), what="the study",
        )  # fmt: skip


def _run_here(plan: Plan, pieces: list[Piece], made: Callable[[list[Trial]], None]) -> None:
    fit = _Fitter(plan.path, plan.reading, plan.seed)
    try:
        for piece in pieces:
            made(fit(piece))
    except KeyboardInterrupt:
        raise Stopped from None


class _Fitter:
    """Makes the fits of a study in one process; keeps the joint it read last, as pieces come so."""

    def __init__(self, path: str, reading: Mapping[str, Any], seed: int) -> None:
        self._path, self._reading, self._seed = path, reading, seed
        self._joint: str | None = None
        self._read: tuple[Recording, NDArray[np.bool_]] | None = None

    def __call__(self, piece: Piece) -> list[Trial]:
        joint = piece[0].joint
        if self._read is None or self._joint != joint:
            self._read = None
            recording = read(self._path, **{**self._reading, "joint": joint})
            self._joint, self._read = joint, (recording, transient_rows(recording))
        recording, transient = self._read
        return run_trials(piece, recording, transient, self._seed)


_fitter: _Fitter | None = None


def _begin(path: str, reading: Mapping[str, Any], seed: int) -> None:
    """Ready a process of the pool for its study."""
    global _fitter
    _fitter = _Fitter(path, reading, seed)


def _fit(piece: Piece) -> list[Trial]:
    """The fits of a law on a joint in a process of the pool."""
    assert _fitter is not None
    return _fitter(piece)
