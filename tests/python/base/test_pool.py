"""Worker processes: results, errors, Ctrl-C, a worker that dies, a parent that dies."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import BrokenExecutor
from functools import partial
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stribeck.base.errors import StribeckError
from stribeck.base.pool import (
    ONE_THREAD,
    ProcessPool,
    Stopped,
    run_each,
    serial_linear_algebra,
    threads,
)
from threadpoolctl import threadpool_info, threadpool_limits

pytestmark = pytest.mark.skipif(os.name == "nt", reason="signals and process ids are POSIX")


@pytest.fixture(scope="module")
def two_workers():
    with ProcessPool(2) as pool:
        yield pool


def square(number: int) -> int:
    return number * number


def kill_worker(number: int) -> int:
    if number == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def raise_value_error(number: int) -> int:
    raise ValueError(f"no root of {number}")


def environment(_: int) -> dict[str, str | None]:
    return {name: os.environ.get(name) for name in ONE_THREAD}


def write_to_stdout(number: int) -> int:
    os.write(1, b"not the answer")
    return number


@settings(max_examples=20, deadline=None)
@given(pieces=st.lists(st.integers(-1000, 1000), max_size=20))
def test_every_piece_is_processed_once(two_workers: ProcessPool, pieces: list[int]) -> None:
    in_workers: list[int] = []
    here: list[int] = []
    run_each(square, pieces, in_workers.append, two_workers)
    run_each(square, pieces, here.append, None)
    assert sorted(in_workers) == sorted(here) == sorted(map(square, pieces))


def test_a_worker_uses_one_thread(two_workers: ProcessPool) -> None:
    assert two_workers.submit(environment, 0).result() == ONE_THREAD
    assert two_workers.submit(threads).result() == 1


def test_a_worker_leaves_stdout_alone(capfd: pytest.CaptureFixture[str]) -> None:
    with ProcessPool(1) as pool:
        assert pool.submit(write_to_stdout, 7).result() == 7
    assert capfd.readouterr().out == ""


def test_an_error_of_a_piece_is_raised_here(two_workers: ProcessPool) -> None:
    with pytest.raises(ValueError, match="no root of 4"):
        run_each(raise_value_error, [4], pytest.fail, two_workers)


def test_a_worker_that_is_killed_ends_the_work_in_one_sentence() -> None:
    done: list[int] = []
    with (
        pytest.raises(StribeckError, match=r"worker process of the survey was killed.*`workers`"),
        ProcessPool(2) as pool,
    ):
        run_each(kill_worker, range(40), done.append, pool, what="the survey")
    assert set(done) < set(range(40)) - {3}
    with pytest.raises((BrokenExecutor, RuntimeError)):
        pool.submit(square, 1)


@pytest.mark.parametrize("workers", [0, 2])
def test_ctrl_c_drops_unfinished_work(workers: int) -> None:
    def interrupt(_: int) -> None:
        raise KeyboardInterrupt

    before = set(multiprocessing.active_children())
    pool = ProcessPool(workers) if workers else None
    began = time.monotonic()
    with pytest.raises(Stopped):
        run_each(nap, [0.0, 60.0, 60.0] if workers else [0.0, 60.0], interrupt, pool)
    assert time.monotonic() - began < 30.0
    assert eventually(lambda: set(multiprocessing.active_children()) <= before)


def nap(seconds: float) -> int:
    time.sleep(seconds)
    return os.getpid()


def eventually(condition, seconds: float = 10.0) -> bool:
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.05)
    return True


#: A program without `if __name__ == "__main__":`, which workers must not run again.
PROGRAM = """
import sys, time
from stribeck.base.pool import ProcessPool, run_each

def work(seconds):
    time.sleep(seconds)
    return seconds

def told(_):
    open(sys.argv[1], "a").write("x")

run_each(work, [0.0] + [60.0] * 5, told, ProcessPool(2))
"""


def processes_of(group: int) -> list[int]:
    listed = subprocess.run(
        ["ps", "-eo", "pid=,pgid=,stat="], capture_output=True, text=True, check=True
    )
    rows = [line.split() for line in listed.stdout.splitlines()]
    return [int(pid) for pid, of, state in rows if of == str(group) and not state.startswith("Z")]


@pytest.mark.parametrize("sent", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_workers_end_with_their_parent(tmp_path: Path, sent: signal.Signals) -> None:
    marker = tmp_path / "marker"
    (tmp_path / "program.py").write_text(PROGRAM)
    process = subprocess.Popen(
        [sys.executable, str(tmp_path / "program.py"), str(marker)],
        stderr=subprocess.PIPE,
        start_new_session=True,
        text=True,
    )
    try:
        assert eventually(marker.exists, 60.0)
        assert len(processes_of(process.pid)) >= 3
        process.send_signal(sent)
        assert eventually(partial(lambda group: not processes_of(group), process.pid), 5.0)
        process.wait(timeout=10.0)
    finally:
        for pid in processes_of(process.pid):
            os.kill(pid, signal.SIGKILL)
    assert process.stderr is not None
    errors = process.stderr.read()
    assert "Error" not in errors and ("Stopped" in errors) == (sent is signal.SIGINT)
    assert marker.read_text() == "x"


def threads_of_linear_algebra() -> set[int]:
    return {own["num_threads"] for own in threadpool_info() if own["user_api"] == "blas"}


def test_linear_algebra_is_serial_until_the_last_caller_leaves():
    with threadpool_limits(2, user_api="blas"):
        before = threads_of_linear_algebra()
        with serial_linear_algebra:
            with serial_linear_algebra:
                pass
            assert threads_of_linear_algebra() == {1}
        assert threads_of_linear_algebra() == before


def test_linear_algebra_is_serial_in_a_search(monkeypatch):
    import stribeck as sb
    from stribeck.fitting import fit
    from stribeck.motion.generate.hidden import generate

    recording = sb.read(generate([], seconds=20.0, rate=50.0, seed=1)[0])
    seen = []
    real = fit._least_squares

    def watched(*args, **kwargs):
        seen.append(threads_of_linear_algebra())
        return real(*args, **kwargs)

    monkeypatch.setattr(fit, "_least_squares", watched)
    with threadpool_limits(2, user_api="blas"):
        sb.fit("coulomb", recording, starts=1)
    assert seen == [{1}]
