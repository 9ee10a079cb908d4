"""Runs in which a joint repeats its motion while other joints move are held out together.

What the other joints add to the torque repeats with the motion. A model fitted to one of the runs
predicts the others, whatever it takes that for.
"""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np

from stribeck.recording.arrays import Floats, Ints, ints
from stribeck.recording.recording import Recording
from stribeck.recording.rows import MANY_RUNS

__all__ = ["held_out_together"]

#: Two runs have one motion if their positions differ by at most this share of their range (RMS).
_ALIKE = 0.15
#: Share by which their lengths may differ, and number of points at which they are compared.
_LENGTH, _POINTS = 0.1, 200


def held_out_together(recording: Recording) -> Recording:
    """A checked recording whose held-out blocks are whole motions, where other joints move.

    As it is where its blocks are not runs, or hold fewer than five motions.
    """
    others_move = any(check.check == "others" for check in recording.checks)
    if recording.averaged or not others_move or len(recording.run_names) <= MANY_RUNS:
        return recording
    position = recording.velocity if recording.position is None else recording.position
    block, count = _of_motions(recording.block, position)
    runs = recording.block_count
    if count == runs:
        return recording
    note = (
        f"{runs} runs repeat {count} motions, and other joints move: the runs of one motion are "
        "held out together"
    )
    return replace(recording, block=block, block_count=count, notes=(*recording.notes, note))


def _of_motions(block: Ints, position: Floats) -> tuple[Ints, int]:
    """Held-out blocks of whole motions, [n], from those of runs, and their number."""
    count = int(block.max()) + 1
    borders = np.flatnonzero(np.diff(block, prepend=-1, append=count))
    if borders.size != count + 1:
        return block, count
    first = _first_alike([position[a:b] for a, b in itertools.pairwise(borders)])
    motions = np.unique(first)
    if motions.size < MANY_RUNS:
        return block, count
    return ints(np.searchsorted(motions, first)[block]), motions.size


def _first_alike(runs: list[Floats]) -> Ints:
    """For each run the number of the first one with its motion."""
    at = np.linspace(0.0, 1.0, _POINTS)
    courses = [np.interp(at * (run.size - 1), np.arange(run.size), run) for run in runs]

    def is_alike(j: int, k: int) -> bool:
        sizes = runs[j].size, runs[k].size
        apart = float(np.sqrt(np.mean((courses[j] - courses[k]) ** 2)))
        is_as_long = max(sizes) - min(sizes) <= _LENGTH * max(sizes)
        return is_as_long and apart <= _ALIKE * float(np.ptp(courses[j]))

    first: list[int] = []
    for k in range(len(runs)):
        first.append(next((j for j in dict.fromkeys(first) if is_alike(j, k)), k))
    return np.array(first)
