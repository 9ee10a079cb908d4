"""A real Dask cluster on this machine: a scheduler and two workers, one of them killed."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
import stribeck as sb
from fleet_logs import answers, command
from fleet_pieces import square_unless_three, status_of_nanny
from stribeck.base.errors import StribeckError
from stribeck.scale.fleet.backend import DaskCluster
from stribeck.scale.fleet.schedule import run_tasks

distributed = pytest.importorskip("distributed")
pytestmark = pytest.mark.slow

LAW = "bittencourt_a"
#: Workers find the pieces of `fleet_pieces`, and two lost workers are enough to blame a piece.
ENVIRONMENT = {
    **os.environ,
    "PYTHONPATH": os.pathsep.join(map(str, (Path(__file__).parent, Path(sb.__file__).parents[1]))),
    "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1",
}


#: Seconds within which a cluster starts, on a busy machine too.
STARTS_WITHIN = 180.0


class Cluster:
    """`dask scheduler` and two `dask worker`, one thread each, that have started.

    With `nanny` a worker that ends is started again; without it stays away. A worker that ends
    while its nanny still starts is not started again, and one that ends while it registers may be
    taken for a living one for minutes. So work is given only after that.
    """

    def __init__(self, folder: Path, *, nanny: bool = False) -> None:
        folder.mkdir()
        self._folder = folder
        self._processes: list[subprocess.Popen[bytes]] = []
        self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        self.scheduler = self._processes[0]
        self.address = self._wait_for(r"Scheduler at:\s*(tcp://\S+)")
        self.workers = [self.hire(nanny=nanny) for _ in range(2)]
        with distributed.Client(
            self.address, set_as_default=False, timeout=STARTS_WITHIN
        ) as client:
            client.wait_for_workers(2, timeout=STARTS_WITHIN)
            deadline = time.monotonic() + STARTS_WITHIN
            while nanny and set(client.run(status_of_nanny, nanny=True).values()) != {"running"}:
                assert time.monotonic() < deadline
                time.sleep(0.1)

    def hire(self, *, nanny: bool = False) -> subprocess.Popen[bytes]:
        """One worker more."""
        watched = "--nanny" if nanny else "--no-nanny"
        return self._start("worker", self.address, "--nthreads", "1", "--no-dashboard", watched)

    def _start(self, *words: str) -> subprocess.Popen[bytes]:
        with (self._folder / f"{len(self._processes)}.log").open("wb") as log:
            process = subprocess.Popen(
                [sys.executable, "-m", "dask", *words],
                stdout=log,
                stderr=log,
                cwd=self._folder,
                env=ENVIRONMENT,
                start_new_session=True,
            )
        self._processes.append(process)
        return process

    def _wait_for(self, pattern: str) -> str:
        deadline = time.monotonic() + STARTS_WITHIN
        while time.monotonic() < deadline:
            found = re.search(pattern, (self._folder / "0.log").read_text())
            if found is not None:
                return found.group(1)
            time.sleep(0.1)
        raise AssertionError((self._folder / "0.log").read_text())

    def close(self) -> None:
        """End them all; a nanny's worker is in its group. A failed test shows what they said."""
        for process in reversed(self._processes):
            process.terminate()
            try:
                process.wait(timeout=10)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait(timeout=10)
        for log in sorted(self._folder.glob("*.log")):
            print(f"{log.name}:\n{log.read_text()}")


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    made = Cluster(tmp_path / "cluster")
    yield made
    made.close()


def test_a_piece_that_ends_its_workers_is_given_up_alone(tmp_path: Path) -> None:
    cluster = Cluster(tmp_path / "cluster", nanny=True)
    done: list[int] = []
    given_up: list[int] = []
    crew = DaskCluster(cluster.address, note=lambda sentence: None)
    try:
        run_tasks(square_unless_three, range(8), crew, done.append, given_up.append)
    finally:
        crew.close()
        cluster.close()
    assert sorted(done) == [n * n for n in range(8) if n != 3]
    assert given_up == [3]


def test_a_cluster_that_has_lost_all_workers_is_waited_for(cluster: Cluster) -> None:
    done: list[int] = []
    said: list[str] = []

    def note(sentence: str) -> None:
        said.append(sentence)
        cluster.hire()

    for worker in cluster.workers:
        worker.kill()
        worker.wait(timeout=10)
    crew = DaskCluster(cluster.address, note)
    try:
        run_tasks(square_unless_three, range(3), crew, done.append, lambda piece: None)
    finally:
        crew.close()
    assert sorted(done) == [0, 1, 4]
    assert len(said) == 1 and f"{cluster.address} has no worker" in said[0]


def test_a_killed_worker_costs_no_answer(
    cluster: Cluster, logs: list[Path], tmp_path: Path
) -> None:
    killed = False

    def kill(done: int, total: int) -> None:
        nonlocal killed
        if done >= 10 and not killed:
            os.kill(cluster.workers[0].pid, signal.SIGKILL)
            killed = True

    found = sb.fleet(
        logs, tmp_path / "dask", LAW, scheduler=cluster.address, starts=5, progress=kill
    )
    assert killed and cluster.workers[0].wait(timeout=10) == -signal.SIGKILL
    assert (found.new, found.failures) == (48, ())
    with ThreadPoolExecutor(1) as executor:
        sb.fleet(logs, tmp_path / "here", LAW, executor=executor, starts=5)
    assert answers(tmp_path / "dask").equals(answers(tmp_path / "here"))


def test_the_command_works_on_the_cluster(
    cluster: Cluster, logs: list[Path], tmp_path: Path
) -> None:
    done = command(
        *logs[:2], "--model", "coulomb", "--scheduler", cluster.address, "-o", tmp_path / "fleet"
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    assert answers(tmp_path / "fleet").height == 4


def test_no_call_is_made_while_the_scheduler_is_lost(cluster: Cluster) -> None:
    backend = DaskCluster(cluster.address, print)
    assert backend.executor().submit(abs, -1).result(timeout=60) == 1
    cluster.scheduler.kill()
    deadline = time.monotonic() + 60
    with pytest.raises(StribeckError, match="was lost"):
        while time.monotonic() < deadline:
            backend.executor()
    backend.close()


def test_a_scheduler_that_is_lost_ends_the_run_in_one_line(
    cluster: Cluster, logs: list[Path], tmp_path: Path
) -> None:
    # Far more work than fits between the first result on the disk and the loss.
    words = [*map(str, logs), "--model", LAW, "--starts", "200", "--scheduler", cluster.address]
    process = subprocess.Popen(
        [sys.executable, "-m", "stribeck", "fleet", *words, "-o", str(tmp_path / "fleet")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    deadline = time.monotonic() + STARTS_WITHIN
    while not any((tmp_path / "fleet").glob("results/*.parquet")):
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.1)
    cluster.scheduler.kill()
    out, error = process.communicate(timeout=120)
    assert process.returncode == 2 and out == "" and "Traceback" not in error
    assert f"the connection to {cluster.address} was lost" in error.splitlines()[-1]
    assert answers(tmp_path / "fleet").height > 0
