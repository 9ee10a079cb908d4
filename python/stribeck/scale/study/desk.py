"""The fits of a study run in this process, or in worker processes that cache recordings."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from stribeck.base.pool import ProcessPool, run_each
from stribeck.identify.left_out.rows import rows_left_out
from stribeck.recording.recording import Recording
from stribeck.scale.study.plan import StudyPlan

Piece = TypeVar("Piece")
Result = TypeVar("Result")


class Desk:
    """The recording that a process read last; the work of a study is ordered by joint."""

    def __init__(self, plan: StudyPlan) -> None:
        self.plan = plan
        self._recording: tuple[str | None, Recording] | None = None
        self._transient: NDArray[np.bool_] | None = None

    def recording(self, joint: str | None) -> Recording:
        """Return the recording of a joint."""
        if self._recording is None or self._recording[0] != joint:
            self._recording = self._transient = None
            self._recording = joint, self.plan.read(joint)
        return self._recording[1]

    def transient(self, joint: str | None) -> NDArray[np.bool_]:
        """Return which samples of a joint are excluded from fits (`identify.left_out`)."""
        recording = self.recording(joint)
        if self._transient is None:
            self._transient = rows_left_out(recording)
        return self._transient


@contextlib.contextmanager
def study_workers(plan: StudyPlan, workers: int) -> Iterator[StudyWorkers]:
    """Start worker processes until the end of the context; with 1, work in this process."""
    if workers <= 1:
        yield StudyWorkers(plan, None)
        return
    with ProcessPool(workers, partial(_begin, plan)) as pool:
        yield StudyWorkers(plan, pool)


class StudyWorkers:
    """Process pieces of a study, each with the desk of its process.

    Parameters
    ----------
    pool
        Worker processes that have a desk each; None: this process.
    """

    def __init__(self, plan: StudyPlan, pool: ProcessPool | None) -> None:
        self._desk, self._pool = Desk(plan), pool

    def each(
        self,
        do: Callable[[Desk, Piece], Result],
        pieces: Iterable[Piece],
        finished: Callable[[Result], None],
    ) -> None:
        """Process every piece, and hand over each result when it is ready, in any order.

        Raises
        ------
        Stopped
            On Ctrl-C. Unfinished work is dropped at once.
        StribeckError
            A worker was killed.
        """
        work = partial(do, self._desk) if self._pool is None else partial(_at_desk, do)
        run_each(work, pieces, finished, self._pool, what="the study")


#: The desk of this worker process.
_desk: Desk | None = None


def _begin(plan: StudyPlan) -> None:
    """Prepare a worker process for its study."""
    global _desk
    _desk = Desk(plan)


def _at_desk(do: Callable[[Desk, Piece], Result], piece: Piece) -> Result:
    """Process a piece in a worker process."""
    assert _desk is not None
    return do(_desk, piece)
