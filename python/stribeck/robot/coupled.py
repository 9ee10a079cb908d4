"""Motors that turn with several joints, such as those of wrists and differentials.

Positions and velocities of the motors are a constant matrix C times those of the joints. By their
power, torques at the joints are C' times those of the motors.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError, listed, nearest, option
from stribeck.base.toml import TomlText

Array = NDArray[np.float64]
Turns = tuple[tuple[float, ...], ...]

#: Start of the names of columns that are computed for motors.
MOTOR = "motor_"


def mixed(rows: Sequence[Sequence[float]], values: Array) -> Array:
    """Sums over the second axis of `values` [n, N, ...], one for each row of factors.

    Examples
    --------
    >>> mixed([[1.0, 0.0], [1.0, 1.0]], np.array([[2.0, 3.0]]))
    array([[2., 5.]])
    """
    made = np.zeros_like(values)
    for k, row in enumerate(rows):
        for j, factor in enumerate(row):
            if factor != 0.0:
                made[:, k] += factor * values[:, j]
    return made


def read_turns(text: TomlText, rows: Sequence[Mapping[str, object]], names: Sequence[str]) -> Turns:
    """The rows ``motor_turns`` of a robot file; empty where no motor turns with other joints.

    Parameters
    ----------
    rows
        The tables ``[[joint]]``, with ``name`` where it is not the number.
    """
    turns = np.eye(len(names))
    for number, row in enumerate(rows, start=1):
        if "motor_turns" not in row:
            continue
        given = row["motor_turns"]
        if not isinstance(given, dict) or not given:
            raise text.stop(
                "motor_turns is a table of joints, such as {5 = 1.0, 6 = 1.0}",
                "[[joint]]",
                "motor_turns",
            )
        own = list(names).index(str(row.get("name", number)))
        turns[own] = 0.0
        for name, factor in given.items():
            if name not in names:
                hint = nearest(name, names) or f"; the joints are {listed(names)}"
                raise text.stop(f"there is no joint {name!r}{hint}", "[[joint]]", "motor_turns")
            if not isinstance(factor, int | float) or not math.isfinite(factor):
                raise text.stop(
                    f"motor_turns has a number for each joint, not {factor!r}",
                    "[[joint]]",
                    "motor_turns",
                )
            turns[own, list(names).index(name)] = float(factor)
    if np.array_equal(turns, np.eye(len(names))):
        return ()
    if np.linalg.matrix_rank(turns) < len(names):
        raise text.stop(
            "joints may move while all motors rest: motor_turns of different motors depend on each "
            "other",
            "[[joint]]",
            "motor_turns",
        )
    return tuple(tuple(float(x) for x in row) for row in turns)


def coupled(turns: Turns) -> tuple[int, ...]:
    """Numbers, from 0, of the joints that do not have a motor of their own."""
    if not turns:
        return ()
    matrix = np.array(turns)
    apart = matrix != np.eye(len(matrix))
    return tuple(int(k) for k in np.flatnonzero(apart.any(axis=0) | apart.any(axis=1)))


def motor_columns(
    path: str, turns: Turns, number: int, columns: Mapping[str, Sequence[str]]
) -> tuple[dict[str, str], dict[str, str]]:
    """Names and formulas of the position and velocity of a motor from columns of joints.

    Parameters
    ----------
    number
        Of the motor, from 0.
    columns
        Column of each joint, by channel.

    Returns
    -------
    map, derive
        Name of the computed column by channel, and formula by this name.

    Raises
    ------
    RecordingError
        The channel has the same column for every joint.
    """
    row = turns[number]
    named: dict[str, str] = {}
    formulas: dict[str, str] = {}
    if [k for k, factor in enumerate(row) if factor != 0.0] == [number] and row[number] == 1.0:
        return named, formulas
    for channel in ("position", "velocity"):
        own = columns.get(channel)
        if own is None:
            continue
        if len(set(own)) < len(own):
            raise RecordingError(
                f"{path}: motors of coupled joints need a column of each joint: name them with "
                f"{option('map', channel + '=COLUMN')}, with {{joint}} or {{number}} in COLUMN"
            )
        parts = [f"{factor!r}*`{own[k]}`" for k, factor in enumerate(row) if factor != 0.0]
        named[channel] = MOTOR + own[number]
        formulas[named[channel]] = " + ".join(parts)
    return named, formulas
