"""Repeated time stamps: a row that a logger wrote twice."""

from __future__ import annotations

import numpy as np

from stribeck.recording.arrays import Ints
from stribeck.recording.joint.channels import Channels

__all__ = ["drop_repeated_stamps"]

#: From this share of repeated stamps on, the clock is too coarse and the file is refused.
_FEW = 0.01


def drop_repeated_stamps(data: Channels, run: Ints) -> Ints:
    """Leave out the later of two rows with one time stamp; returns the runs of the rows left.

    The row is not a gap: the clock goes on without it. A clock that often repeats itself, or runs
    backwards, is left to be refused.
    """
    if "time" not in data.values or data.prepared.settings.average:
        return run
    repeated = (np.diff(data.values["time"]) == 0.0) & (run[1:] == run[:-1])
    count = int(repeated.sum())
    if not count or count > max(1, int(_FEW * len(run))):
        return run
    at = int(np.flatnonzero(repeated)[0]) + 1
    rows = "1 row has" if count == 1 else f"{count} rows have"
    data.notes.append(
        f"{rows} the time stamp of the row before and {'is' if count == 1 else 'are'} left out "
        f"(first {data.place(at)})"
    )
    keep = np.concatenate([[True], ~repeated])
    data.join(keep)
    return run[keep]
