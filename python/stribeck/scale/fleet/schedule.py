"""Pieces of work on an executor that may lose workers, stumble over a piece, or dawdle.

Any `concurrent.futures.Executor` serves. A piece that was under way when a worker died is done
again, alone; if that ends a worker too, the piece is to blame and is given up. A piece that takes
many times as long as the others is handed out a second time, and the first answer counts.
"""

from __future__ import annotations

import statistics
import time
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from dataclasses import dataclass
from typing import Generic, TypeVar

from stribeck.base.errors import StribeckError
from stribeck.scale.fleet.backend import Backend

Piece = TypeVar("Piece")
Result = TypeVar("Result")

#: Workers that a piece may end before it is given up.
MOST_KILLS = 2
#: Pieces that must have ended before one can be called slow.
FEWEST_DONE = 5
#: Seconds below which no piece is slow, and between looks at those under way.
LEAST_AGE, POLL = 1.0, 0.5


@dataclass(eq=False)
class _Job(Generic[Piece]):
    """A piece on its way.

    Attributes
    ----------
    kills
        How many workers ended while it was under way.
    copies, submitted
        How often it is under way now, and how often it has been handed out.
    """

    piece: Piece
    kills: int = 0
    copies: int = 0
    submitted: int = 0
    over: bool = False


def run(
    do: Callable[[Piece], Result],
    pieces: Iterable[Piece],
    backend: Backend,
    finished: Callable[[Result], None],
    given_up: Callable[[Piece], None],
    *,
    straggler: float | None = None,
    note: Callable[[str], None] = lambda sentence: None,
) -> None:
    """Do every piece, and hand each result over as it is ready, in any order.

    Parameters
    ----------
    do
        Must be picklable, like the pieces and the results, where the backend is of processes.
    given_up
        Told of a piece that ends its workers.
    straggler
        A piece that has been under way for so many times the median is handed out again once
        nothing else is waiting; None: never.
    note
        Told in one sentence what was lost or done twice.

    Raises
    ------
    StribeckError
        The executor is of no more use; or a worker cannot do the work at all.
    """
    _Run(do, pieces, backend, finished, given_up, straggler, note).to_the_end()


def _cannot(error: Exception) -> StribeckError:
    """What a worker says that got as far as the work, and not into it."""
    cause = error.__cause__ or error
    said = " ".join(f"{type(cause).__name__}: {cause}".split())
    return StribeckError(
        f"a worker cannot do the work ({said}): every worker needs the same stribeck as this "
        f"machine, and what it depends on"
    )


class _Run(Generic[Piece, Result]):
    """One call of `run`."""

    def __init__(
        self,
        do: Callable[[Piece], Result],
        pieces: Iterable[Piece],
        backend: Backend,
        finished: Callable[[Result], None],
        given_up: Callable[[Piece], None],
        straggler: float | None,
        note: Callable[[str], None],
    ) -> None:
        self._do, self._backend, self._note = do, backend, note
        self._finished, self._given_up, self._straggler = finished, given_up, straggler
        self._waiting = deque(_Job(piece) for piece in pieces)
        self._suspects: deque[_Job[Piece]] = deque()
        self._under_way: dict[Future[Result], tuple[_Job[Piece], float]] = {}
        self._seconds: list[float] = []
        self._refused = False

    def to_the_end(self) -> None:
        while self._waiting or self._suspects or self._under_way:
            self._hand_out()
            done, _ = wait(self._under_way, timeout=POLL, return_when=FIRST_COMPLETED)
            lost = [job for future in done if (job := self._take(future)) is not None]
            if lost or self._refused:
                self._recover(lost)
            self._hurry()

    def _hand_out(self) -> None:
        """Suspects one at a time and alone, so that it is known which of them ends its worker."""
        if self._suspects:
            if not self._under_way and self._submit(self._suspects[0]):
                self._suspects.popleft()
            return
        while self._waiting and len(self._under_way) < self._backend.width():
            if not self._submit(self._waiting[0]):
                return
            self._waiting.popleft()

    def _submit(self, job: _Job[Piece]) -> bool:
        """Whether the executor took a job; it refuses when it broke since the last look."""
        try:
            future = self._backend.executor().submit(self._do, job.piece)
        except BrokenExecutor:
            self._refused = True
            return False
        job.copies += 1
        job.submitted += 1
        self._under_way[future] = job, time.monotonic()
        return True

    def _take(self, future: Future[Result]) -> _Job[Piece] | None:
        """Hand over what a future gives; returns its job where its worker was lost."""
        if future not in self._under_way:
            return None  # Answered meanwhile by another copy.
        job, began = self._under_way.pop(future)
        job.copies -= 1
        try:
            result = future.result()
        except CancelledError:
            raise self._backend.lost() from None
        except StribeckError:
            raise
        except Exception as error:
            if not self._backend.is_loss(error):
                raise _cannot(error) from error
            return job
        self._seconds.append(time.monotonic() - began)
        self._close(job)
        self._finished(result)
        return None

    def _close(self, job: _Job[Piece]) -> None:
        """The first answer counts; whoever works on the same is not waited for."""
        job.over = True
        for future in [f for f, (other, _) in self._under_way.items() if other is job]:
            future.cancel()
            del self._under_way[future]

    def _recover(self, lost: list[_Job[Piece]]) -> None:
        """Begin again after workers died: what they were doing is done once more."""
        if self._backend.breaks:
            wait(self._under_way)
            others = [self._take(future) for future in list(self._under_way)]
            lost += [job for job in others if job is not None]
            self._backend.renew()
            self._refused = False
        again = 0
        for job in dict.fromkeys(lost):
            job.kills += self._backend.kills_per_loss
            if job.over or job.copies:
                continue
            if job.kills >= MOST_KILLS:
                self._close(job)
                self._given_up(job.piece)
            else:
                self._suspects.append(job)
                again += 1
        if again:
            self._note(f"a worker was ended: {again} task{'s' * (again > 1)} under way done again")

    def _hurry(self) -> None:
        """Once nothing waits, hand out again what takes many times as long as the others.

        Each time after twice as long: it may be large, and not stuck.
        """
        free = self._backend.width() - len(self._under_way)
        idle = not (self._waiting or self._suspects)
        if self._straggler is None or not idle or len(self._seconds) < FEWEST_DONE:
            return
        limit = max(self._straggler * statistics.median(self._seconds), LEAST_AGE)
        now = time.monotonic()
        newest = {job: began for job, began in self._under_way.values()}
        slow = [
            job for job, began in newest.items() if now - began > limit * 2 ** (job.submitted - 1)
        ]  # fmt: skip
        for job in slow[: max(free, 0)]:
            self._note(f"a task has taken more than {limit:.0f} s: it is handed out once more")
            self._submit(job)
