"""Time over the number of samples, of parameters, and of threads and processes."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from time import perf_counter

import motions
import stribeck as sb
from stribeck.models.catalog import law_ids

#: A time is the median of as many calls as fit into this, s, and at least of one.
PATIENCE = 0.5
MOST_CALLS = 101
SAMPLES = (1_000, 10_000, 100_000, 1_000_000)
#: Random starts of a fit whose time grows with the samples.
STARTS = 4
#: Samples at which laws are compared, and of the fits that run side by side; of the laws' fits.
MIDDLE = 30_000
FEW = 10_000
THREADS = ("OMP_NUM_THREADS", "RAYON_NUM_THREADS")
JOINTS = 8


@dataclass(frozen=True)
class Curve:
    """Times over a number of something.

    Attributes
    ----------
    name
        What is timed.
    at
        Samples, parameters, threads or processes.
    time
        ns a sample, or s.
    """

    name: str
    at: tuple[int, ...]
    time: tuple[float, ...]


def seconds(work: Callable[[], object]) -> float:
    """Median wall-clock seconds of a call; the first is not counted if there are more."""
    taken: list[float] = []
    began = perf_counter()
    while not taken or (perf_counter() - began < PATIENCE and len(taken) < MOST_CALLS):
        start = perf_counter()
        work()
        taken.append(perf_counter() - start)
    return median(taken[1:] or taken)


def over_samples() -> list[Curve]:
    """ns a sample of torque, gradient and fit."""
    calls = (
        ("torque, bittencourt_a", _torque("bittencourt_a")),
        ("torque, lugre", _torque("lugre")),
        ("gradient, lugre", _gradient("lugre")),
        ("fit, coulomb", _fit("coulomb")),
        (f"fit, lugre, {STARTS} starts", _fit("lugre")),
    )
    return [
        Curve(name, SAMPLES, tuple(1e9 * seconds(prepare(n)) / n for n in SAMPLES))
        for name, prepare in calls
    ]


def _torque(law: str) -> Callable[[int], Callable[[], object]]:
    def prepare(samples: int) -> Callable[[], object]:
        model, columns = motions.valued(law), motions.channels(samples)
        return lambda: model.torque(**columns, dt=motions.DT)

    return prepare


def _gradient(law: str) -> Callable[[int], Callable[[], object]]:
    def prepare(samples: int) -> Callable[[], object]:
        model, columns = motions.valued(law), motions.channels(samples)
        return lambda: model.gradient(**columns, dt=motions.DT)

    return prepare


def _fit(law: str) -> Callable[[int], Callable[[], object]]:
    def prepare(samples: int) -> Callable[[], object]:
        recording = motions.recording(law, samples)
        return lambda: sb.fit(law, recording, starts=STARTS)

    return prepare


def over_parameters() -> list[Curve]:
    """ns a sample of torque, gradient and fit of each law that does not read the motor torque."""
    models = [
        motions.valued(law) for law in law_ids() if "motor_torque" not in sb.model(law).core.needs
    ]
    models.sort(key=lambda model: len(model.names))
    kinds = (
        ("without memory", [m for m in models if not m.has_state]),
        ("with a memory", [m for m in models if m.has_state]),
    )
    calls = (
        ("torque", _torque, MIDDLE),
        ("gradient", _gradient, MIDDLE),
        (f"fit, {STARTS} starts", _fit, FEW),
    )
    return [
        Curve(
            f"{call}, {kind}",
            tuple(len(model.names) for model in some),
            tuple(1e9 * seconds(of(model.spec)(samples)) / samples for model in some),
        )
        for call, of, samples in calls
        for kind, some in kinds
    ]


def over_threads() -> list[Curve]:
    """s of one fit in threads, of a fit for each of some joints in processes, and of counting."""
    cores = len(os.sched_getaffinity(0))
    counts = tuple(
        sorted({1, 2, *(2**k for k in range(cores.bit_length()) if 2**k <= cores), cores})
    )
    tasks = {
        "threads": "one fit of lugre, 20 starts, threads",
        "processes": f"fits of {JOINTS} joints, processes",
        "counting": f"counting, {JOINTS} times, processes",
    }
    return [
        Curve(name, counts, tuple(_elsewhere(task, count) for count in counts))
        for task, name in tasks.items()
    ]


def _elsewhere(task: str, count: int) -> float:
    """Seconds of `side_by_side.py` in a process of its own: threads are set at its start."""
    script = Path(__file__).with_name("side_by_side.py")
    threads = str(count if task == "threads" else 1)
    environment = {**os.environ, **dict.fromkeys(THREADS, threads)}
    said = subprocess.check_output([sys.executable, script, task, str(count)], env=environment)
    return float(said)
