"""What several runs have in common: samples, so that a held-out run would have been fitted to; a
position that each begins anew.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import option
from stribeck.recording.arrays import Ints
from stribeck.recording.check import Check
from stribeck.recording.recording import Recording
from stribeck.recording.rows import noise_level

__all__ = ["OF_RUNS", "between_runs"]

#: The checks of the runs against each other, which change with the runs that a recording has.
OF_RUNS = ("run", "zero")

#: Samples in a row that are equal in two runs only if they are the same samples.
LENGTH = 20
#: Share of the moving samples of a run from which on it repeats another.
MOST = 0.05
#: Noise of a measured torque is more than this share of it (RMS).
NOISELESS = 1e-5
#: Channels that are compared, where they were measured.
CHANNELS = ("position", "velocity", "acceleration", "torque", "load_torque", "temperature")
#: A joint that turns by more than this does not stay within a stroke, rad.
TURN = 2.0 * np.pi
#: Part of the range of the position below which it is zero.
ZERO = 1e-6
#: Odd factor of the hash of a stretch, whose powers are odd too.
FACTOR = 0x9E3779B97F4A7C15


def between_runs(recording: Recording) -> tuple[Check, ...]:
    """The checks of the runs of a recording against each other.

    Examples
    --------
    >>> t = np.arange(600) / 100.0
    >>> v = np.sin(3.0 * t) + 0.3 * np.sin(7.0 * t)
    >>> tau = v**3 + 0.01 * np.random.default_rng(0).normal(size=600)
    >>> rows = np.r_[0:400, 200:600]
    >>> run = np.repeat(["a", "b"], 400)
    >>> r = Recording.from_columns(time=t[rows], velocity=v[rows], torque=tau[rows], run=run)
    >>> between_runs(r)[0].said
    "48 % of the moving samples of run 'a' are those of run 'b'"
    """
    if len(recording.run_names) < 2 or recording.averaged:
        return ()
    found = (_apart(recording), _one_zero(recording))
    return tuple(check for check in found if check is not None)


def _apart(recording: Recording) -> Check | None:
    """Whether samples of one run are in another, where noise tells samples apart."""
    stretch, first = _stretches(recording)
    run, names = recording.run[first], recording.run_names
    _, same = np.unique(stretch, return_inverse=True)
    holds = np.unique(np.column_stack([same, run]), axis=0)
    shared = np.bincount(holds[:, 0])[same] > 1
    whole = np.bincount(run, minlength=len(names))
    share = np.bincount(run[shared], minlength=len(names)) / np.maximum(whole, 1)
    if share.max() < MOST or _is_noiseless(recording):
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


def _is_noiseless(recording: Recording) -> bool:
    """Whether the torque has no noise, as in a simulation: equal motions have equal samples."""
    torque = recording.torque
    noise = noise_level(recording.time, torque, recording.segment)
    return noise <= NOISELESS * float(np.sqrt(np.mean(torque**2)))


def _one_zero(recording: Recording) -> Check | None:
    """Whether a joint that turns on begins each run at zero, as a relative encoder does."""
    q = recording.position
    if q is None or recording.joint_kind != "revolute" or np.ptp(q) <= TURN:
        return None
    begins = np.flatnonzero(np.diff(recording.run, prepend=-1))
    if np.any(np.abs(q[begins]) > ZERO * np.ptp(q)):
        return None
    return Check(
        "zero",
        True,
        "cannot check whether the position has one zero in all runs: each begins at 0; where the "
        "encoder is set to zero at the start of a run, an effect of position has another phase in "
        "each: ask for it in one run",
    )


def _stretches(recording: Recording) -> tuple[NDArray[np.uint64], Ints]:
    """A hash of each stretch of `LENGTH` moving samples, and its first sample, [m] each."""
    columns = recording.columns
    # A load torque of zero beside measured friction has no column.
    read = [name for name in CHANNELS if name in columns and not columns[name].derived]
    measured = [getattr(recording, name) for name in read]
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
