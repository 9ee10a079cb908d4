"""The same work on many robots, joints and days: which joints changed, which stand out.

Each joint of each file is a task of its own, on the processes of this machine, a Dask cluster or
any other executor. The results land in one Parquet data set, which the next run adds to.
"""

from __future__ import annotations

import glob
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import polars as pl

from stribeck.base.errors import RecordingError, SpecError, StribeckError
from stribeck.base.pool import Stopped
from stribeck.base.version import __version__
from stribeck.models.formula_law import is_formula
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.models.reader import read_model_file
from stribeck.models.spec import parse_spec
from stribeck.recording.options import ReadArguments, ReadOptions
from stribeck.recording.sidecar import read_sidecar
from stribeck.scale.fleet.backend import Backend, DaskCluster, GivenExecutor, Processes
from stribeck.scale.fleet.changes import Changes, Question, find_changes
from stribeck.scale.fleet.effects import Effects, find_effects
from stribeck.scale.fleet.identified import IMPROVE
from stribeck.scale.fleet.naming import Naming
from stribeck.scale.fleet.result import Fleet
from stribeck.scale.fleet.schedule import run
from stribeck.scale.fleet.store import FAILED, Store, row_of, row_of_file, row_of_loss
from stribeck.scale.fleet.task import File, Look, Task, Work, answer, look

if TYPE_CHECKING:
    from typing_extensions import Unpack

#: A task under way for so many times the median is handed out a second time.
STRAGGLER = 5.0
#: Why a task is given up.
POISONED = "ended its worker twice: given up"
#: Told after each task: tasks done now, and all there are to do.
Progress = Callable[[int, int], None]


def fleet(
    files: Iterable[str | Path],
    output: str | Path,
    model: str | Model = IMPROVE,
    *,
    base: str | Model = "coulomb",
    name: str | None = None,
    day: str | None = None,
    starts: int = 20,
    seed: int = 0,
    question: Question | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    straggler: float | None = STRAGGLER,
    retry_failed: bool = False,
    progress: Progress | None = None,
    note: Callable[[str], None] = lambda sentence: None,
    **reading: Unpack[ReadArguments],
) -> Fleet:
    """Identify every joint of many files, and say which joints changed and which stand out.

    Parameters
    ----------
    files
        Paths, or patterns such as ``"logs/*/2026-03-*.parquet"``.
    output
        Folder of the data set. Rows that it holds of unchanged files are not made again, and the
        answers are about all its rows.
    model, base
        What is fitted to every joint: a spec or a model, whose values are then the first start. Or
        ``"improve"``: diagnose and add effects from `base`.
    name
        How the paths name robot, day and joint: ``"{robot}/{day}.parquet"`` (`Naming`). Default:
        the robot is the folder, the day the last date in the path.
    day
        Column of the files that holds the date, where the path does not.
    question
        Which days are new, and what counts as a change.
    executor
        Any `concurrent.futures.Executor` (MPI, Ray, Dask's own ...), which stays the caller's.
        Workers need this package and the same paths.
    workers
        Without an executor: processes of this machine; None: one for each core. They need the
        script's main module to be importable (``if __name__ == "__main__":``). With one: how many
        tasks to have under way. The results do not depend on it.
    scheduler
        Address of a Dask scheduler.
    straggler
        A task under way for so many times the median is handed out again; None: never.
    retry_failed
        Do again what failed before.
    progress, note
        Told after each task how many are done; told in one sentence what goes wrong on the way.
    **reading
        Options of `stribeck.read`.

    Raises
    ------
    StribeckError
        No file could be used, or an argument or the folder cannot be.
    Stopped
        On Ctrl-C; what is done is saved.

    Examples
    --------
    >>> fleet(["logs/*/*.parquet"], "fleet", "coulomb", scheduler="tcp://10.0.0.7:8786")
    ... # doctest: +SKIP
    """
    if starts < 1 or seed < 0:
        raise SpecError(f"{starts} starts, seed {seed}: give at least 1 start and a seed from 0 on")
    options = ReadOptions(**reading)
    if options.sidecar is not None:
        read_sidecar(options.sidecar)
        options = replace(options, sidecar=str(Path(options.sidecar).absolute()))
    work = Work(
        model=_model_text(model), base=_model_text(base), starts=starts, seed=seed,
        reading=options, name=name, day_column=day, version=__version__,
    )  # fmt: skip
    naming, paths = Naming(name), _expand(files)
    store = Store(Path(output), work, retry_failed=retry_failed)
    incidents: list[str] = []
    made = 0

    def keep(row: dict[str, Any]) -> None:
        nonlocal made
        made += 1
        store.add(row)

    def remark(sentence: str) -> None:
        incidents.append(sentence)
        note(sentence)

    try:
        named = _named(paths, naming, keep)
        known = store.known(named)
        todo = [file for file in named if file.path not in known]
        if todo:
            backend = _backend(executor, workers, scheduler, remark)
            _work(todo, work, store, keep, backend, straggler, progress, remark)
    finally:
        store.close()
    _refuse_without_answers(store.frame)
    question = question or Question()
    return Fleet(
        store.folder, work, store.frame, made, find_changes(store.frame, question),
        find_effects(store.frame) if work.model == IMPROVE else Effects.not_asked(), incidents,
    )  # fmt: skip


def _work(
    files: Sequence[File],
    work: Work,
    store: Store,
    keep: Callable[[dict[str, Any]], None],
    backend: Backend,
    straggler: float | None,
    progress: Progress | None,
    note: Callable[[str], None],
) -> None:
    """Look into every file, then identify every joint that has no row yet."""
    tasks: list[Task] = []
    done = 0

    def looked(found: Look) -> None:
        if found.failure is not None:
            keep(row_of_file(found.file, found.failure))
        tasks.extend(task for task in found.tasks if not store.has(task))

    def answered(row: dict[str, Any]) -> None:
        nonlocal done
        done += 1
        keep(row)
        if progress is not None:
            progress(done, len(tasks))

    options: dict[str, Any] = {"straggler": straggler, "note": note}
    try:
        run(
            partial(look, work=work), files, backend, looked,
            lambda file: keep(row_of_file(file, POISONED)), **options,
        )  # fmt: skip
        tasks.sort(key=lambda task: (task.file, task.joint or ""))
        run(
            partial(answer, work=work), list(tasks), backend, lambda made: answered(row_of(made)),
            lambda task: answered(row_of_loss(task, POISONED)), **options,
        )  # fmt: skip
    except KeyboardInterrupt:
        raise Stopped from None
    finally:
        backend.close()


def _backend(
    executor: Executor | None,
    workers: int | None,
    scheduler: str | None,
    note: Callable[[str], None],
) -> Backend:
    if executor is not None and scheduler is not None:
        raise SpecError("an executor and a scheduler are given: leave one out")
    if scheduler is not None:
        return DaskCluster(scheduler, note)
    return Processes(workers) if executor is None else GivenExecutor(executor, workers)


def _expand(files: Iterable[str | Path]) -> list[str]:
    """Absolute paths in order, each once; sidecars are no recordings."""
    found: set[str] = set()
    for said in map(str, files):
        matches = [said]
        if glob.has_magic(said) and not Path(said).exists():
            matches = glob.glob(said, recursive=True)
            if not matches:
                raise RecordingError(f"no file is like {said}: check the pattern")
        found |= {str(Path(path).absolute()) for path in matches}
    paths = sorted(path for path in found if not path.endswith(".sidecar.toml"))
    if not paths:
        raise RecordingError("no file is given: name recordings, or a pattern for them")
    return paths


def _named(
    paths: Sequence[str], naming: Naming, keep: Callable[[dict[str, Any]], None]
) -> list[File]:
    """What each path says; one that says nothing is kept as a failure."""
    named = []
    for path in paths:
        try:
            said = naming.name(path)
        except RecordingError as error:
            keep(row_of_file(File(path, None, None), str(error)))
            continue
        named.append(File(path, said.robot, said.day, said.joint))
    return named


def _model_text(model: str | Model) -> str:
    """A spec that is one, or the text of a model file."""
    if isinstance(model, Model):
        return ModelFile(model).to_toml()
    if model.endswith(".toml"):
        return read_model_file(model).to_toml()
    if model != IMPROVE and not is_formula(model):
        parse_spec(model)
    return model


def _refuse_without_answers(rows: pl.DataFrame) -> None:
    """An answer about nothing is none."""
    if (rows["status"] == FAILED).all():
        raise StribeckError(
            f"nothing could be identified in any of the {rows['file'].n_unique()} files, the first "
            f"says: {rows['reason'][0]}"
        )


__all__ = [
    "STRAGGLER", "Changes", "Effects", "Fleet", "Naming", "Question", "Stopped", "fleet",
]  # fmt: skip
