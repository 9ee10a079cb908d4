"""Held-out blocks of a recording that passes its highest speeds in one of them.

A friction map passes one speed after another. A model that is fitted without the tenth of the
fastest passes is extrapolated to them, so that no part of it which depends on the speed would be
determined. Such a recording is cut into shorter stretches, which are dealt to the blocks in turn.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stribeck.recording.arrays import Bools, Floats, Ints, ints
from stribeck.recording.recording import Recording
from stribeck.recording.rows import BLOCKS, MANY_RUNS, equal_stretches

__all__ = ["held_out_in_turn", "passes_speeds_once"]

#: Stretches of a recording, the first number that suffices, and the fewest samples of one.
_STRETCHES, _LEAST = (100, 300, 1000), 20
#: Blocks that must share the highest speeds.
_SHARED = 5
#: Quantile of the speed that stands for the highest of a block.
_HIGHEST = 0.999


def held_out_in_turn(recording: Recording) -> Recording:
    """A checked recording in which no held-out block has the highest speeds for itself.

    As it is where none has, where the blocks are whole runs, or where no dealing of stretches
    changes that.
    """
    r = recording
    if len(r.run_names) >= MANY_RUNS or not passes_speeds_once(r):
        return recording
    speed, period = np.abs(r.velocity), r.scales()["sample_period"]

    def dealt(count: int) -> Ints:
        return equal_stretches(r.dt, period, count) % BLOCKS

    possible = [count for count in _STRETCHES if r.time.size >= count * _LEAST]
    if not possible:
        return recording
    enough = (n for n in possible if _fast_blocks(speed, r.moving, dealt(n)) >= _SHARED)
    count = next(enough, possible[-1])
    block = dealt(count)
    if _has_speeds_of_its_own(speed, r.moving, block):
        return recording
    note = (
        f"one tenth of the recording has its highest speeds for itself: {count} stretches are held "
        f"out in turn, in ten groups that share these speeds"
    )
    return replace(r, block=ints(block), block_count=BLOCKS, notes=(*r.notes, note))


def passes_speeds_once(recording: Recording) -> bool:
    """Whether one tenth of a recording is usually faster than the others ever are."""
    r = recording
    if r.averaged:
        return False
    tenth = np.arange(r.time.size) * BLOCKS // r.time.size
    return _has_speeds_of_its_own(np.abs(r.velocity), r.moving, tenth)


def _has_speeds_of_its_own(speed: Floats, moving: Bools, block: Ints) -> bool:
    """Whether a block is usually faster than the others ever are."""
    for b in np.unique(block[moving]):
        own, others = speed[moving & (block == b)], speed[moving & (block != b)]
        if others.size and np.median(own) > np.quantile(others, _HIGHEST):
            return True
    return False


def _fast_blocks(speed: Floats, moving: Bools, block: Ints) -> int:
    """The number of blocks that hold samples faster than half of the highest speed."""
    fast = moving & (speed > 0.5 * np.quantile(speed[moving], _HIGHEST))
    return int(np.unique(block[fast]).size)
