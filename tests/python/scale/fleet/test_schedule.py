"""Work on executors that lose workers, with pieces that end them and pieces that dawdle."""

from __future__ import annotations

import os
import signal
import threading
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from pathlib import Path

import pytest
from fleet_pieces import square_unless_three
from stribeck.base.errors import StribeckError
from stribeck.scale.fleet.backend import GivenExecutor, Processes
from stribeck.scale.fleet.schedule import run_tasks


def square(number: int) -> int:
    return number * number


def die_once(work: tuple[int, str]) -> int:
    """Ends its process the first time 3 comes; a file remembers that."""
    number, marker = work
    if number == 3 and not Path(marker).exists():
        Path(marker).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return number * number


def raise_import_error(number: int) -> int:
    raise ImportError(f"no module for {number}")


@pytest.fixture(scope="module")
def two_processes():
    crew = Processes(2)
    yield crew
    crew.close()


def test_a_piece_that_ends_its_workers_is_given_up_alone(two_processes: Processes) -> None:
    done: list[int] = []
    given_up: list[int] = []
    notes: list[str] = []
    run_tasks(
        square_unless_three,
        range(8),
        two_processes,
        done.append,
        given_up.append,
        note=notes.append,
    )
    assert sorted(done) == [n * n for n in range(8) if n != 3]
    assert given_up == [3]
    assert notes and "worker was killed" in notes[0]


def test_a_worker_that_is_lost_costs_no_answer(two_processes: Processes, tmp_path: Path) -> None:
    done: list[int] = []
    given_up: list[tuple[int, str]] = []
    pieces = [(n, str(tmp_path / "marker")) for n in range(8)]
    run_tasks(die_once, pieces, two_processes, done.append, given_up.append)
    assert sorted(done) == [n * n for n in range(8)] and given_up == []


def test_a_straggler_is_handed_out_again_and_the_first_answer_counts() -> None:
    stuck = threading.Event()
    calls: list[int] = []

    def dawdle(number: int) -> int:
        calls.append(number)
        if number == 4 and calls.count(4) == 1:
            stuck.wait(30.0)
        return number * number

    done: list[int] = []
    notes: list[str] = []
    with ThreadPoolExecutor(2) as threads:
        try:
            run_tasks(
                dawdle,
                range(10),
                GivenExecutor(threads),
                done.append,
                pytest.fail,
                straggler=3.0,
                note=notes.append,
            )
        finally:
            stuck.set()
    assert sorted(done) == [n * n for n in range(10)]
    assert calls.count(4) == 2 and len(calls) == 11
    assert len(notes) == 1 and "run a second time" in notes[0]


class Breaking(Executor):
    """An executor that breaks on the third piece, as a lost MPI rank breaks its pool."""

    _max_workers = 1

    def __init__(self) -> None:
        self.count = 0

    def submit(self, do, /, *args, **kwargs):
        self.count += 1
        future: Future = Future()
        if self.count > 2:
            future.set_exception(BrokenExecutor("lost"))
        else:
            future.set_result(do(*args, **kwargs))
        return future


def test_a_broken_executor_of_the_caller_ends_in_one_sentence_with_what_was_done() -> None:
    done: list[int] = []
    with pytest.raises(StribeckError, match=r"executor is broken.*continues from there"):
        run_tasks(square, range(6), GivenExecutor(Breaking()), done.append, pytest.fail)
    assert done == [0, 1]


def test_a_worker_that_cannot_do_the_work_is_said() -> None:
    with ThreadPoolExecutor(1) as threads, pytest.raises(StribeckError, match="no module for 0"):
        run_tasks(raise_import_error, range(3), GivenExecutor(threads), pytest.fail, pytest.fail)
