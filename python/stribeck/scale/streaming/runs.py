"""First samples of the runs and of the held-out blocks of a data set."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError
from stribeck.recording.rows import BLOCKS, MANY_RUNS
from stribeck.scale.streaming.dataset import DataSet

__all__ = ["block_edges", "numbered", "run_starts"]

Ints = NDArray[np.int64]

#: Number of samples of a column that are read together.
LOOKED_AT = 4_000_000


def run_starts(data: DataSet, run: str | None, time: str) -> Ints:
    """Return the indices of the first samples of the runs, in order.

    Without a column `run`, a run begins at each file whose clock starts again.

    Raises
    ------
    RecordingError
        The samples of a run are not contiguous.
    """
    return _of_files(data, time) if run is None else _of_column(data, run)


def _of_files(data: DataSet, time: str) -> Ints:
    starts, last = [0], None
    for k in range(len(data.files)):
        begin, end = int(data.first[k]), int(data.first[k + 1])
        if begin == end:
            continue
        now = data.frame(begin, begin + 1, [time])[time][0]
        if last is not None and now is not None and now <= last:
            starts.append(begin)
        last = data.frame(end - 1, end, [time])[time][0]
    return np.array(starts, dtype=np.int64)


def _of_column(data: DataSet, run: str) -> Ints:
    starts: list[int] = []
    seen: set[object] = set()
    last: object = None
    for begin in range(0, data.rows, LOOKED_AT):
        names = data.frame(begin, min(begin + LOOKED_AT, data.rows), [run])[run]
        changes = names.ne_missing(names.shift(1)).arg_true()
        for row in sorted({0, *changes.to_list()}):
            name = names[row]
            if row == 0 and starts and name == last:
                continue
            if name in seen:
                raise RecordingError(
                    f"{data.path}: {data.place(begin + row)}, column '{run}': run '{name}' "
                    "continues after another run: sort the rows by run, then by time"
                )
            seen.add(name)
            starts.append(begin + row)
            last = name
    return np.array(starts, dtype=np.int64)


def block_edges(rows: int, starts: Ints) -> Ints:
    """Return the first samples of the held-out blocks, and the number of samples, [blocks + 1].

    There are ten equal blocks; with at least five runs, a run is not split between blocks.
    """
    edges = np.arange(BLOCKS + 1) * rows // BLOCKS
    if starts.size >= MANY_RUNS:
        borders = np.append(starts, rows)
        edges = borders[np.argmin(np.abs(borders[None, :] - edges[:, None]), axis=1)]
    return np.unique(edges)


def numbered(row: Ints, starts: Ints) -> Ints:
    """Return the index of the part, of those that begin at `starts`, of each row, array [n].

    Parameters
    ----------
    row : array [n]
        Indices of rows, ascending, none before the first part.

    Examples
    --------
    >>> numbered(np.array([0, 1, 5, 9]), np.array([0, 5, 8])).tolist()
    [0, 0, 1, 2]
    """
    first = np.searchsorted(row, starts)
    return np.repeat(np.arange(starts.size), np.diff(np.append(first, row.size)))
