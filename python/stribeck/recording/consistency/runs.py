"""Whether two runs hold the same samples, so that a held-out run would have been fitted to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import option
from stribeck.recording.arrays import Ints
from stribeck.recording.check import Check
from stribeck.recording.consistency.view import View
from stribeck.recording.recording import Recording

__all__ = ["check_runs", "runs_apart"]

#: Samples in a row that are equal in two runs only if they are the same samples.
LENGTH = 20
#: Share of the moving samples of a run from which on it repeats another.
MOST = 0.05
#: Channels that are compared, where they were measured.
CHANNELS = ("position", "velocity", "torque")
#: Odd factor of the hash of a stretch, whose powers are odd too.
FACTOR = 0x9E3779B97F4A7C15


def check_runs(view: View) -> Check | None:
    """Look for samples of one run in another; None where a file has one run."""
    return runs_apart(view.recording)


def runs_apart(recording: Recording) -> Check | None:
    """Look for samples of one run in another; None where there is one run.

    Examples
    --------
    >>> t = np.arange(600) / 100.0
    >>> v = np.sin(3.0 * t) + 0.3 * np.sin(7.0 * t)
    >>> rows = np.r_[0:400, 200:600]
    >>> run = np.repeat(["a", "b"], 400)
    >>> r = Recording.from_columns(time=t[rows], velocity=v[rows], torque=v[rows] ** 3, run=run)
    >>> runs_apart(r).said
    "48 % of the moving samples of run 'a' are those of run 'b'"
    """
    if len(recording.run_names) < 2 or recording.averaged:
        return None
    stretch, first = _stretches(recording)
    run, names = recording.run[first], recording.run_names
    _, same = np.unique(stretch, return_inverse=True)
    holds = np.unique(np.column_stack([same, run]), axis=0)
    shared = np.bincount(holds[:, 0])[same] > 1
    whole = np.bincount(run, minlength=len(names))
    share = np.bincount(run[shared], minlength=len(names)) / np.maximum(whole, 1)
    if share.max() < MOST:
        return None
    # Of two equal runs, the later one repeats the other.
    repeats = int(np.flatnonzero(share == share.max())[-1])
    here = np.isin(holds[:, 0], same[shared & (run == repeats)]) & (holds[:, 1] != repeats)
    other = int(np.argmax(np.bincount(holds[here, 1])))
    return Check(
        "run",
        False,
        f"{100.0 * share[repeats]:.0f} % of the moving samples of run '{names[repeats]}' are those "
        f"of run '{names[other]}'",
        f"a model would be fitted to samples that are held out: leave out one of the two files, "
        f"or rows with {option('where')}",
    )


def _stretches(recording: Recording) -> tuple[NDArray[np.uint64], Ints]:
    """A hash of each stretch of `LENGTH` moving samples, and its first sample, [m] each."""
    measured = [
        values
        for name in CHANNELS
        if (values := getattr(recording, name)) is not None and not recording.columns[name].derived
    ]
    whole = np.zeros(recording.time.size, dtype=np.uint64)
    for values in measured:
        whole = (whole ^ np.ascontiguousarray(values).view(np.uint64)) * np.uint64(FACTOR)
        whole ^= whole >> np.uint64(29)
    last = whole.size - LENGTH
    if last < 0:
        return whole[:0], np.zeros(0, dtype=np.intp)
    sums = np.zeros(last + 1, dtype=np.uint64)
    for ahead in range(LENGTH):
        sums = sums * np.uint64(FACTOR) + whole[ahead : last + 1 + ahead]
    together = recording.segment[: last + 1] == recording.segment[LENGTH - 1 :]
    first = np.flatnonzero(together & recording.moving[: last + 1])
    return sums[first], first
