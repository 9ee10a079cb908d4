"""One run of a fleet: the files to process, their tasks, and the stored results."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from stribeck.base.errors import RecordingError
from stribeck.base.pool import Stopped
from stribeck.scale.fleet.backend import Backend
from stribeck.scale.fleet.naming import Naming
from stribeck.scale.fleet.schedule import run_tasks
from stribeck.scale.fleet.store import FleetStore, row_of, row_of_file, row_of_loss
from stribeck.scale.fleet.task import (
    File,
    FileJoints,
    Task,
    TaskResult,
    Work,
    find_joints,
    identify_joint,
)

#: A task that takes this many times the median is run a second time.
STRAGGLER = 5.0
#: Why a task is given up.
POISONED = "given up: two workers died while running it"
#: Called after each task with the numbers of tasks done and in all.
Progress = Callable[[int, int], None]


class FleetRun:
    """Work on the files of a fleet.

    Parameters
    ----------
    store
        Stores a row for each joint and file.
    straggler
        A task that takes this many times the median is run again; None: never.
    progress, note
        Called after each task; called with a sentence about each incident.

    Attributes
    ----------
    made
        Number of rows that this run added.
    incidents
        What went wrong, one sentence each.
    """

    def __init__(
        self,
        store: FleetStore,
        work: Work,
        straggler: float | None,
        progress: Progress | None,
        note: Callable[[str], None],
    ) -> None:
        self.store, self.work = store, work
        self._straggler, self._progress, self._note = straggler, progress, note
        self.made = 0
        self.incidents: list[str] = []
        self._tasks: list[Task] = []
        self._done = 0

    def remark(self, sentence: str) -> None:
        """Report an incident."""
        self.incidents.append(sentence)
        self._note(sentence)

    def files_to_do(self, paths: Sequence[str], naming: Naming) -> list[File]:
        """Return the files that are new or have changed; a path without a name is a failure."""
        named = []
        for path in paths:
            try:
                name = naming.name(path)
            except RecordingError as error:
                self._keep(row_of_file(File(path, None, None), str(error)))
                continue
            named.append(File(path, name.robot, name.day, name.joint))
        known = self.store.known(named)
        return [file for file in named if file.path not in known]

    def identify(self, files: Sequence[File], backend: Backend) -> None:
        """Find the joints of every file, then identify those that have no row yet.

        Raises
        ------
        Stopped
            On Ctrl-C.
        StribeckError
            The backend cannot continue.
        """
        options: dict[str, Any] = {"straggler": self._straggler, "note": self.remark}
        find = partial(find_joints, work=self.work)
        identify = partial(identify_joint, work=self.work)
        try:
            run_tasks(find, files, backend, self._found, self._file_lost, **options)
            tasks = sorted(self._tasks, key=lambda task: (task.file, task.joint or ""))
            run_tasks(identify, tasks, backend, self._identified, self._task_lost, **options)
        except KeyboardInterrupt:
            raise Stopped from None
        finally:
            backend.close()

    def _found(self, found: FileJoints) -> None:
        if found.failure is not None:
            self._keep(row_of_file(found.file, found.failure))
        self._tasks.extend(task for task in found.tasks if not self.store.has(task))

    def _file_lost(self, file: File) -> None:
        self._keep(row_of_file(file, POISONED))

    def _identified(self, result: TaskResult) -> None:
        self._count(row_of(result))

    def _task_lost(self, task: Task) -> None:
        self._count(row_of_loss(task, POISONED))

    def _count(self, row: dict[str, object]) -> None:
        self._done += 1
        self._keep(row)
        if self._progress is not None:
            self._progress(self._done, len(self._tasks))

    def _keep(self, row: dict[str, object]) -> None:
        self.made += 1
        self.store.add(row)
