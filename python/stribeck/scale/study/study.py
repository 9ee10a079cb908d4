"""Fits of many laws to every joint of a recording, from many starts, as in the UR5e review.

The review of 25 friction models (2024/25, sections 3 to 5) fits each law to each joint from twenty
random starts, keeps the best, and compares the errors of friction torque, over all speeds and
within 0.1 rad/s, and of the motors' electrical energy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.base.arguments import door
from stribeck.base.errors import FitError, RecordingError, SpecError, option
from stribeck.base.files import save_figure, write_whole
from stribeck.base.pool import Stopped, worker_count
from stribeck.base.shown import draw
from stribeck.identify.search.algorithms import GLOBAL
from stribeck.identify.stated.choices import Choices
from stribeck.recording.stated.options import ReadOptions
from stribeck.scale.arguments import ScaleArguments, split_arguments
from stribeck.scale.study.assess import Assessed, JointTrials, assess_joint
from stribeck.scale.study.desk import Desk, StudyWorkers, study_workers
from stribeck.scale.study.plan import REVIEW, STARTS, Job, StudyPlan, make_plan
from stribeck.scale.study.result import Study, Table, make_tables
from stribeck.scale.study.store import StudyStore
from stribeck.scale.study.trial import Trial, fit_trials

if TYPE_CHECKING:
    from typing_extensions import Unpack


#: Called after each fit with the numbers of fits done and in all.
Progress = Callable[[int, int], None]


@door(RecordingError)
def study(
    path: str | Path,
    output: str | Path,
    laws: Sequence[str] = REVIEW,
    *,
    starts: int = STARTS,
    seed: int = 0,
    low_speed: float | None = None,
    workers: int | None = 1,
    progress: Progress | None = None,
    note: Callable[[str], None] | None = None,
    **options: Unpack[ScaleArguments],
) -> Study:
    """Fit `laws` to every joint of a recording from many starts, and compare them.

    Parameters
    ----------
    path
        The recording. ``joint`` selects one joint.
    output
        Folder of the study. Every fit is written at its end; the same arguments continue a study.
    laws
        Specs; default: the 25 of the review.
    starts
        Number of starts of each law on each joint: the default one and random ones (review: 20).
    low_speed
        Largest low speed of the tables, rad/s or m/s; default 0.1 rad/s or 0.01 m/s.
    workers
        Number of processes; None: one for each core. The results do not depend on it.
    progress, note
        Called after each fit with the numbers of fits done and in all; called before the first fit
        with notes on how the recording was read.

    Raises
    ------
    StribeckError
        The recording, a law, a parameter or the folder cannot be used.
    Stopped
        On Ctrl-C; finished fits are saved.

    Examples
    --------
    >>> study("ur5e.parquet", "ur5e.study", ["coulomb", "lugre"], starts=5)  # doctest: +SKIP
    """
    if low_speed is not None and not low_speed > 0.0:
        raise SpecError(f"low speed {low_speed:g} must be above zero")
    reading, choices = _split(options)
    plan = make_plan(str(path), reading, laws, starts=starts, seed=seed, choices=choices)
    if note is not None:
        for sentence in plan.notes:
            note(sentence)
    with (
        StudyStore(Path(output), plan) as store,
        study_workers(plan, worker_count(workers)) as processes,
    ):
        _fit(plan, store, processes, progress)
        result = _result(plan, store, low_speed, processes)
        _write(result, processes)
    return result


def _split(options: ScaleArguments) -> tuple[ReadOptions, Choices]:
    """How the recording is read, and what is stated; refuses algorithms without starts."""
    reading, choices = split_arguments(options)
    if choices.algorithm in GLOBAL:
        raise SpecError(
            f"a study searches from each start, {choices.algorithm} does not: give another "
            f"{option('algorithm')}"
        )
    return reading, choices


def _fit(
    plan: StudyPlan, store: StudyStore, processes: StudyWorkers, progress: Progress | None
) -> None:
    """Make the fits that are not in the store.

    All starts of a law on a joint are fitted together, even if only one is missing. So the results
    do not depend on the number of processes or on interruptions.
    """
    missing = {job for job in plan.jobs if job not in store.trials}

    def made(trials: list[Trial]) -> None:
        for trial in trials:
            if trial.job in missing:
                store.add(trial)
                if progress is not None:
                    progress(len(store.trials), len(plan.jobs))

    try:
        processes.each(fit_trials, plan.pieces(missing), made)
    finally:
        store.close()


def _result(
    plan: StudyPlan, store: StudyStore, low_speed: float | None, processes: StudyWorkers
) -> Study:
    """Compute the tables from the best starts, joint by joint."""
    trials = store.ordered()
    of_joint: dict[str | None, dict[str, list[Trial]]] = {joint: {} for joint in plan.joints}
    for trial in trials:
        of_joint[trial.job.joint].setdefault(trial.job.law, []).append(trial)
    pieces = [JointTrials(joint, laws, low_speed) for joint, laws in of_joint.items()]
    found: dict[str | None, Assessed] = {}
    processes.each(assess_joint, pieces, lambda assessed: found.update({assessed.joint: assessed}))
    assessed = {joint: found[joint] for joint in plan.joints}
    failed = tuple(trial for trial in trials if trial.failure)
    tables = make_tables(
        {law: group for joint in assessed.values() for law, group in joint.groups.items()},
        {
            law: {name: of.entries[law] for name, of in assessed.items() if law in of.entries}
            for law in plan.laws
        },
    )
    if not tables:
        raise FitError(f"{plan.path}: no fit could be made; the first error: {failed[0].failure}")
    joints = {name: of.data for name, of in assessed.items()}
    return Study(plan, store.folder, joints, tables, failed, store.frame())


def _write(result: Study, processes: StudyWorkers) -> None:
    """Write tables and figures to the folder of the study."""
    folder = result.folder
    write_whole(folder / "tables.csv", result.to_frame().write_csv())
    write_whole(folder / "tables.txt", repr(result) + "\n")
    drawn = [
        (result, joint)
        for joint in result.joints
        if any(joint in row.entries for table in result.tables for row in table.rows)
    ]
    processes.each(_draw, drawn, lambda _: None)


def _draw(_: Desk, of: tuple[Study, str | None]) -> None:
    """Draw the figures of one joint."""
    result, joint = of
    name = "" if joint is None else f"_{_plain_name(joint)}"
    save_figure(draw(result, joint=joint), str(result.folder / f"errors{name}.png"))
    save_figure(
        draw(result, "friction_figure", joint=joint), str(result.folder / f"friction{name}.png")
    )


def _plain_name(joint: str) -> str:
    """Return the name of a joint as part of a file name."""
    return "".join(c if c.isalnum() or c in "-_" else "_" for c in joint)


__all__ = ["REVIEW", "Job", "Stopped", "Study", "StudyPlan", "Table", "Trial", "study"]
