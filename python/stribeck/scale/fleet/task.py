"""The tasks of a fleet: find the joints of a file, and identify one of them.

Both run in any process or on any machine of the executor. Arguments and results are plain data, and
an error of a file is part of the result.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from datetime import date, datetime
from pathlib import Path

from threadpoolctl import threadpool_limits

from stribeck.base.errors import RecordingError, StribeckError, nearest, option
from stribeck.base.version import __version__
from stribeck.identify.stated.choices import Choices
from stribeck.recording.load import read_with
from stribeck.recording.stated.options import ReadOptions
from stribeck.recording.stated.sidecar import sidecar_hash
from stribeck.recording.tables.readers import read_table
from stribeck.recording.whole_file.scan import scan_with
from stribeck.scale.fleet.identified import IMPROVE, Identified, identify, start_model
from stribeck.scale.fleet.naming import as_date


@dataclass(frozen=True)
class Work:
    """What is done with every joint of a fleet.

    Attributes
    ----------
    model
        A spec, the text of a model file, or ``"improve"``: diagnose and add effects from `base`.
    base
        Spec, or the text of a model file.
    starts, seed
        Number of starts and seed of every fit.
    reading
        How the files are read.
    name
        How paths name robots and days (`Naming`).
    day_column
        Column of the files that holds the date; None: the path has it.
    version
        Version of the package that submits the work; workers with another version refuse it.
    choices
        What is stated about parameters.
    """

    model: str
    base: str
    starts: int
    seed: int
    reading: ReadOptions
    name: str | None
    day_column: str | None
    version: str
    choices: Choices = field(default_factory=Choices)

    @property
    def label(self) -> str:
        """Return a short name of the work."""
        if self.model == IMPROVE:
            return f"{IMPROVE} from {_spec(self.base)}"
        return _spec(self.model)


def _spec(text: str) -> str:
    model = start_model(text)
    return model if isinstance(model, str) else model.spec


@dataclass(frozen=True)
class File:
    """A file of a fleet, and the robot, day and joint from its path."""

    path: str
    robot: str | None
    day: date | None
    joint: str | None = None


@dataclass(frozen=True)
class Task:
    """One joint of a file, and the state of the file when its joints were listed.

    Attributes
    ----------
    joint
        Its name; None where neither file nor path names it.
    select
        The value of the file's joint column; None: the file holds this joint alone.
    size, modified
        Bytes, and ns since 1970: a file with the same values is taken as unchanged.
    sha256, sidecar_sha256
        Hash of the file, and of its sidecar if there is one.
    joints_in_file
        Number of tasks of the file.
    """

    file: str
    joint: str | None
    robot: str | None
    day: date | None
    select: str | None
    size: int
    modified: int
    sha256: str
    sidecar_sha256: str | None
    joints_in_file: int


@dataclass(frozen=True)
class FileJoints:
    """The joints of a file as tasks, or why there are none."""

    file: File
    tasks: tuple[Task, ...]
    failure: str | None


@dataclass(frozen=True)
class TaskResult:
    """Result of a task: the identified model, or why there is none."""

    task: Task
    identified: Identified | None
    failure: str | None
    seconds: float = field(compare=False)


def find_joints(file: File, work: Work) -> FileJoints:
    """Find the joints of a file."""
    _check_version(work)
    try:
        return FileJoints(file, _tasks(file, work), None)
    except Exception as error:
        return FileJoints(file, (), _sentence(error))


def identify_joint(task: Task, work: Work) -> TaskResult:
    """Identify one joint of one file.

    The result is the same on every machine: one thread, and the seed of `work`.
    """
    _check_version(work)
    began = time.perf_counter()
    identified: Identified | None = None
    failure: str | None = None
    try:
        with threadpool_limits(1):
            recording = read_with(task.file, replace(work.reading, joint=task.select))
            if recording.sha256 != task.sha256:
                raise RecordingError(f"{task.file} was changed meanwhile: run the command again")
            identified = identify(
                recording, work.model, work.base, work.starts, work.seed, work.choices
            )
    except Exception as error:
        failure = _sentence(error)
    return TaskResult(task, identified, failure, time.perf_counter() - began)


def _tasks(file: File, work: Work) -> tuple[Task, ...]:
    stat = Path(file.path).stat()
    table = scan_with(file.path, work.reading)
    if table.problem is not None:
        raise RecordingError(table.problem)
    wanted = _wanted(table.joints, work.reading.joint or file.joint, file)
    day = file.day if work.day_column is None else _day(file.path, work.day_column)
    sidecar = sidecar_hash(file.path, work.reading.sidecar)
    return tuple(
        Task(
            file.path,
            name,
            file.robot,
            day,
            select,
            stat.st_size,
            stat.st_mtime_ns,
            table.sha256,
            sidecar,
            len(wanted),
        )
        for name, select in wanted
    )


def _wanted(
    joints: Sequence[str], asked: str | None, file: File
) -> list[tuple[str | None, str | None]]:
    """Return the name of each joint to identify, and the value that selects it in the file."""
    if not joints:
        return [(asked, None)]
    if asked is None:
        return [(name, name) for name in joints]
    if asked in joints:
        return [(asked, asked)]
    raise RecordingError(
        f"{file.path} has no joint {asked!r}{nearest(asked, joints)}; it has {', '.join(joints)}"
    )


def _day(path: str, column: str) -> date:
    """The day of the first row: a log that continues past midnight belongs to the day it began."""
    table = read_table(path).table
    if column not in table.columns:
        raise RecordingError(
            f"{path} has no column {column!r}{nearest(column, table.columns)}, which "
            f"{option('day')} names"
        )
    first = table[column].drop_nulls().first()
    found = as_date(first) if isinstance(first, str) else first
    if isinstance(found, datetime):
        return found.date()
    if isinstance(found, date):
        return found
    raise RecordingError(
        f"{path}: column {column!r} holds {first!r}, but {option('day')} needs dates"
    )


def _check_version(work: Work) -> None:
    if work.version != __version__:
        raise StribeckError(
            f"a worker has stribeck {__version__}, this is {work.version}: install the "
            f"same version on all of them"
        )


def _sentence(error: Exception) -> str:
    """Return why a file or joint has no result; one defect must not stop the other tasks."""
    if isinstance(error, StribeckError):
        text = str(error)
    elif isinstance(error, OSError):
        text = f"{error.filename}: {error.strerror or error}"
    else:
        text = f"unexpected {type(error).__name__}: {error}; please report it"
    return text.replace("\n", " ")
