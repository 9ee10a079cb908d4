"""Tasks on an executor that may lose workers, fail on one task, or be slow.

Any `concurrent.futures.Executor` can be used. A task that ran while a worker died is run again,
alone; if a worker dies again, the task is the cause and is given up. A task that takes much longer
than the others is run a second time, and the first result counts.
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

Task = TypeVar("Task")
Result = TypeVar("Result")

#: Number of workers that may die with a task before it is given up.
MOST_KILLS = 2
#: Number of finished tasks from which on a task can be called slow.
FEWEST_DONE = 5
#: Seconds below which no task is slow; seconds between two checks of the running tasks.
LEAST_AGE, POLL = 1.0, 0.5


@dataclass(eq=False)
class _Job(Generic[Task]):
    """A task and its state.

    Attributes
    ----------
    kills
        Number of workers that died while it ran.
    copies, submitted
        Number of copies that run now, and that were submitted in all.
    """

    task: Task
    kills: int = 0
    copies: int = 0
    submitted: int = 0
    over: bool = False


def run_tasks(
    do: Callable[[Task], Result],
    tasks: Iterable[Task],
    backend: Backend,
    finished: Callable[[Result], None],
    given_up: Callable[[Task], None],
    *,
    straggler: float | None = None,
    note: Callable[[str], None] = lambda sentence: None,
) -> None:
    """Run every task, and hand over each result when it is ready, in any order.

    Parameters
    ----------
    do
        Called with each task. Picklable, like tasks and results, if the backend has processes.
    given_up
        Called with a task that kills its workers.
    straggler
        A task that takes this many times the median is run again when no other task waits; None:
        never.
    note
        Called with a sentence about what was lost or run twice.

    Raises
    ------
    StribeckError
        The executor cannot continue, or a worker cannot run the tasks.
    """
    _Run(do, tasks, backend, finished, given_up, straggler, note).to_the_end()


def _cannot(error: Exception) -> StribeckError:
    """Return the error of a worker that could not start a task."""
    cause = error.__cause__ or error
    said = " ".join(f"{type(cause).__name__}: {cause}".split())
    return StribeckError(
        f"a worker cannot run the tasks ({said}): every worker needs the same stribeck as this "
        f"machine, and its dependencies"
    )


class _Run(Generic[Task, Result]):
    """One call of `run_tasks`."""

    def __init__(
        self,
        do: Callable[[Task], Result],
        tasks: Iterable[Task],
        backend: Backend,
        finished: Callable[[Result], None],
        given_up: Callable[[Task], None],
        straggler: float | None,
        note: Callable[[str], None],
    ) -> None:
        self._do, self._backend, self._note = do, backend, note
        self._finished, self._given_up, self._straggler = finished, given_up, straggler
        self._waiting = deque(_Job(task) for task in tasks)
        self._suspects: deque[_Job[Task]] = deque()
        self._running: dict[Future[Result], tuple[_Job[Task], float]] = {}
        self._seconds: list[float] = []
        self._refused = False

    def to_the_end(self) -> None:
        while self._waiting or self._suspects or self._running:
            self._submit_waiting()
            done, _ = wait(self._running, timeout=POLL, return_when=FIRST_COMPLETED)
            lost = [job for future in done if (job := self._take(future)) is not None]
            if lost or self._refused:
                self._recover(lost)
            self._rerun_slow()

    def _submit_waiting(self) -> None:
        """Submit tasks; suspects one by one and alone, to find out which one kills its worker."""
        if self._suspects:
            if not self._running and self._submit(self._suspects[0]):
                self._suspects.popleft()
            return
        while self._waiting and len(self._running) < self._backend.width():
            if not self._submit(self._waiting[0]):
                return
            self._waiting.popleft()

    def _submit(self, job: _Job[Task]) -> bool:
        """Submit a task and return True, or False if the executor broke since the last check."""
        try:
            future = self._backend.executor().submit(self._do, job.task)
        except BrokenExecutor:
            self._refused = True
            return False
        job.copies += 1
        job.submitted += 1
        self._running[future] = job, time.monotonic()
        return True

    def _take(self, future: Future[Result]) -> _Job[Task] | None:
        """Hand over the result of a future, or return its job if its worker died."""
        if future not in self._running:
            return None  # Another copy was faster.
        job, began = self._running.pop(future)
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

    def _close(self, job: _Job[Task]) -> None:
        """Mark a task as done; other copies of it are not waited for."""
        job.over = True
        for future in [f for f, (other, _) in self._running.items() if other is job]:
            future.cancel()
            del self._running[future]

    def _recover(self, lost: list[_Job[Task]]) -> None:
        """Replace a broken executor, and queue the tasks of dead workers again."""
        if self._backend.breaks:
            wait(self._running)
            others = [self._take(future) for future in list(self._running)]
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
                self._given_up(job.task)
            else:
                self._suspects.append(job)
                again += 1
        if again:
            self._note(f"a worker was killed: {again} task{'s' * (again > 1)} will run again")

    def _rerun_slow(self) -> None:
        """Run slow tasks again when no task waits.

        The limit doubles with each copy: a slow task may be large rather than stuck.
        """
        free = self._backend.width() - len(self._running)
        idle = not (self._waiting or self._suspects)
        if self._straggler is None or not idle or len(self._seconds) < FEWEST_DONE:
            return
        limit = max(self._straggler * statistics.median(self._seconds), LEAST_AGE)
        now = time.monotonic()
        newest = {job: began for job, began in self._running.values()}
        slow = [
            job for job, began in newest.items() if now - began > limit * 2 ** (job.submitted - 1)
        ]
        for job in slow[: max(free, 0)]:
            self._note(f"a task has taken more than {limit:.0f} s: it is run a second time")
            self._submit(job)
