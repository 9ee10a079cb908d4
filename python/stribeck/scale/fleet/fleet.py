"""The same identification for many robots, joints and days: which joints changed or stand out.

Each joint of each file is one task. Tasks run on processes of this machine, on a Dask cluster or
on any other executor. The results are kept in one Parquet data set, which the next run extends.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import polars as pl

from stribeck.base.arguments import door
from stribeck.base.errors import RecordingError, SpecError, StribeckError
from stribeck.base.version import __version__
from stribeck.identify.stated.choices import Choices, parameters_of_effects
from stribeck.models.build import law
from stribeck.models.build import model as named
from stribeck.models.formula_law import is_formula
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.models.published.sets import PREFIX
from stribeck.models.reader import read_model_file
from stribeck.models.spec import parse_spec
from stribeck.recording.stated.sidecar import read_sidecar
from stribeck.scale.arguments import ScaleArguments, split_arguments
from stribeck.scale.fleet.backend import backend_of
from stribeck.scale.fleet.changes import Question, find_changes
from stribeck.scale.fleet.effects import Effects, find_effects
from stribeck.scale.fleet.files import expand
from stribeck.scale.fleet.identified import IMPROVE, start_model
from stribeck.scale.fleet.naming import Naming
from stribeck.scale.fleet.result import Fleet
from stribeck.scale.fleet.run import STRAGGLER, FleetRun, Progress
from stribeck.scale.fleet.store import FAILED, FleetStore
from stribeck.scale.fleet.task import Work

if TYPE_CHECKING:
    from typing_extensions import Unpack


@door(RecordingError)
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
    **options: Unpack[ScaleArguments],
) -> Fleet:
    """Identify every joint of many files; find joints that changed or stand out.

    Parameters
    ----------
    files
        Paths, or patterns such as ``"logs/*/2026-03-*.parquet"``.
    output
        Folder of the data set. Files that it covers already are not identified again.
    model, base
        The model fitted to every joint, or ``"improve"``: find the effects that `base` lacks.
    name, day
        Pattern of the paths, ``"{robot}/{day}.parquet"`` (see `Naming`); column of the date.
    executor, scheduler, workers
        An executor, which stays open; or the address of a Dask scheduler; or a number of processes
        (default: one for each core). The result does not depend on them.
    straggler, retry_failed
        Run a task again that takes this many times the median, or that failed before.
    progress, note
        Called with the numbers of tasks done and in all; called with a sentence on each incident.
    **options
        Options of `stribeck.read`, and what is stated about parameters (`ChoiceArguments`).

    Raises
    ------
    StribeckError
        No file, an argument or the folder cannot be used.
    Stopped
        On Ctrl-C; finished tasks are saved.

    Examples
    --------
    >>> import numpy as np, polars as pl, stribeck as sb, tempfile
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> v = np.sin(np.arange(900) / 50.0)
    >>> run = pl.DataFrame({"t": np.arange(900) / 100.0, "qd": v, "tau": v + np.sign(v)})
    >>> with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(1) as executor:
    ...     for robot in ("left", "right"):
    ...         run.write_csv(f"{folder}/{robot}.csv")
    ...     given = {"name": "{robot}.csv", "executor": executor, "starts": 1}
    ...     found = sb.fleet([f"{folder}/*.csv"], f"{folder}/results", "coulomb", **given)
    >>> found.rows["robot"].to_list(), found.new
    (['left', 'right'], 2)
    """
    work = _work(model, base, name, day, starts, seed, options)
    naming, paths = Naming(name), expand(files)
    store = FleetStore(Path(output), work, retry_failed=retry_failed)
    run = FleetRun(store, work, straggler, progress, note)
    try:
        todo = run.files_to_do(paths, naming)
        if todo:
            run.identify(todo, backend_of(executor, workers, scheduler, run.remark))
    finally:
        store.close()
    return _result(run, question or Question())


def _work(
    model: str | Model,
    base: str | Model,
    name: str | None,
    day: str | None,
    starts: int,
    seed: int,
    given: ScaleArguments,
) -> Work:
    """Check the arguments and return the work to do on every joint."""
    if starts < 1 or seed < 0:
        raise SpecError(f"{starts} starts, seed {seed}: give at least 1 start and a seed from 0 on")
    options, choices = split_arguments(given)
    if options.sidecar is not None:
        read_sidecar(options.sidecar)
        options = replace(options, sidecar=str(Path(options.sidecar).absolute()))
    model, base = _model_text(model), _model_text(base)
    _check_names(choices, base if model == IMPROVE else model)
    return Work(
        model=model,
        base=base,
        starts=starts,
        seed=seed,
        reading=options,
        name=name,
        day_column=day,
        version=__version__,
        choices=choices,
    )


def _check_names(choices: Choices, text: str) -> None:
    """Refuse what is stated about a parameter that neither the model nor any effect has."""
    if not choices.is_empty:
        known = start_model(text)
        if isinstance(known, str):
            known = law(known) if is_formula(known) else named(known)
        choices.applied(known, parameters_of_effects())


def _result(run: FleetRun, question: Question) -> Fleet:
    """Return the answers about all rows of the data set."""
    rows, work = run.store.frame, run.work
    _refuse_without_answers(rows)
    return Fleet(
        run.store.folder,
        work,
        rows,
        run.made,
        find_changes(rows, question),
        find_effects(rows) if work.model == IMPROVE else Effects.not_asked(),
        run.incidents,
    )


def _model_text(model: str | Model) -> str:
    """Return a valid spec, or the text of a model file."""
    if isinstance(model, Model):
        return ModelFile(model).to_toml()
    if model.endswith(".toml") or model.startswith(PREFIX):
        return read_model_file(model).to_toml()
    if model != IMPROVE and not is_formula(model):
        parse_spec(model)
    return model


def _refuse_without_answers(rows: pl.DataFrame) -> None:
    """Raise if nothing could be identified."""
    if (rows["status"] == FAILED).all():
        raise StribeckError(
            f"nothing could be identified in any of the {rows['file'].n_unique()} files; the first "
            f"reason: {rows['reason'][0]}"
        )


__all__ = ["STRAGGLER", "Fleet", "Naming", "Question", "fleet"]
