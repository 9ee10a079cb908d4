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

pytest.importorskip("distributed")
pytestmark = pytest.mark.slow

LAW = "bittencourt_a"


class Cluster:
    """`dask scheduler` and two `dask worker`, one thread each."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._processes: list[subprocess.Popen[bytes]] = []
        self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        self.address = self._wait_for(r"Scheduler at:\s*(tcp://\S+)")
        # Without the nanny that would start it again: what is killed stays away.
        self.workers = [
            self._start("worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard")
            for _ in range(2)
        ]

    def _start(self, *words: str) -> subprocess.Popen[bytes]:
        with (self._folder / f"{len(self._processes)}.log").open("wb") as log:
            process = subprocess.Popen(
                [sys.executable, "-m", "dask", *words], stdout=log, stderr=log, cwd=self._folder
            )
        self._processes.append(process)
        return process

    def _wait_for(self, pattern: str) -> str:
        deadline = time.monotonic() + 60.0
        while time.monotonic() < deadline:
            found = re.search(pattern, (self._folder / "0.log").read_text())
            if found is not None:
                return found.group(1)
            time.sleep(0.1)
        raise AssertionError((self._folder / "0.log").read_text())

    def close(self) -> None:
        for process in reversed(self._processes):
            process.terminate()
        for process in self._processes:
            process.wait(timeout=30)


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    folder = tmp_path / "cluster"
    folder.mkdir()
    made = Cluster(folder)
    yield made
    made.close()


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
