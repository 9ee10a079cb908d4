"""Run all cases of the benchmark in worker processes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from stribeck.base.files import png_bytes, write_bytes_whole, write_whole
from stribeck.base.pool import ProcessPool, run_each, worker_count
from stribeck.benchmark.answer import CaseAnswer, answer
from stribeck.benchmark.cases import Case
from stribeck.benchmark.figures import calibration_figure, confusion_figure
from stribeck.benchmark.score import Score, score
from stribeck.benchmark.store import AnswerStore, frame
from stribeck.benchmark.text import score_text


def run(
    cases: Sequence[Case],
    folder: Path | None = None,
    *,
    workers: int | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> tuple[list[CaseAnswer], Score]:
    """Run all cases and score the results.

    Parameters
    ----------
    folder
        Folder of the results. Each is written when its case ends; cases with a result are not run
        again. Tables and figures are written at the end, also when stopped.
    workers
        Number of processes; default: one for each core.
    progress
        Called with the number of finished cases and of all cases.

    Raises
    ------
    Stopped
        On Ctrl-C; finished cases are in `folder`.
    StribeckError
        The folder cannot be used.
    """
    store = None if folder is None else AnswerStore(folder)
    answers = {} if store is None else dict(store.answers)
    todo = [case for case in cases if case.name not in answers]

    def finished(made: CaseAnswer) -> None:
        answers[made.case.name] = made
        if store is not None:
            store.add(made)
        progress(len(cases) - len(todo) + sum(c.name in answers for c in todo), len(cases))

    def asked() -> list[CaseAnswer]:
        return [answers[case.name] for case in cases if case.name in answers]

    try:
        _answer_all(todo, finished, min(worker_count(workers), max(len(todo), 1)))
    finally:
        if store is not None:
            store.close()
            write_results(store.folder, asked())
    made = asked()
    return made, score(made)


def _answer_all(todo: Sequence[Case], finished: Callable[[CaseAnswer], None], workers: int) -> None:
    if workers == 1:
        run_each(answer, todo, finished, None)
        return
    with ProcessPool(workers) as pool:
        run_each(answer, todo, finished, pool, what="the benchmark")


def write_results(folder: Path, answers: Sequence[CaseAnswer]) -> None:
    """``answers.parquet``, ``confusion.csv`` and ``.png``, ``calibration.png``, ``score.txt``."""
    made = score(answers)
    table = frame(answers)
    table.write_parquet(folder / "answers.parquet")
    write_whole(folder / "score.txt", score_text(made) + "\n")
    if made.confusion.rows:
        write_whole(folder / "confusion.csv", made.confusion.to_frame().write_csv())
        write_bytes_whole(folder / "confusion.png", png_bytes(confusion_figure(made.confusion)))
    if made.reliability:
        picture = png_bytes(calibration_figure(made.reliability))
        write_bytes_whole(folder / "calibration.png", picture)
