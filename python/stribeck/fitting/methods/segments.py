"""Static friction map from a displacement log: one mean force per constant-speed interval.

Gantry robot with ball screw (Valdiero group), section 3: a line is fitted to each displacement
where the speed is constant; its slope and the force are one point of the static map.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stribeck.base.errors import FitError, option
from stribeck.fitting.methods.steady import SteadyPoint, SteadyPoints, checked_points, mean_of
from stribeck.fitting.methods.stretches import Line, Search, constant_speed
from stribeck.recording.recording import Recording
from stribeck.recording.weights import refuse_weights


def segment_points(
    recording: Recording, *, bins: int = 1, search: Search | None = None
) -> SteadyPoints:
    """Steady-state friction points from a displacement log.

    The friction of a point is the mean torque over the interval, minus the mean load torque where
    the recording has one: at constant speed there is no inertial torque.

    Parameters
    ----------
    recording : Recording
        With a measured position; its velocity is not used.
    bins : int
        Points per interval, each over an equal share of its samples: for a load that varies.
    search : Search, optional
        Criteria of constant speed.

    Returns
    -------
    SteadyPoints
        In the order of time.

    Raises
    ------
    FitError
        No position; no interval of constant speed.

    Examples
    --------
    >>> points = segment_points(sb.read("log.csv", joint_kind="prismatic"))  # doctest: +SKIP
    >>> points.write("points.csv")  # doctest: +SKIP

    On the command line: ``stribeck fit points.csv --model gantry_map``.
    """
    refuse_weights("a reduction to points", recording)
    check_bins(bins)
    lines = constant_stretches(recording, search or Search())
    notes: tuple[str, ...] = ()
    if recording.load_torque is None:
        notes = (
            "the mean torque is taken as friction, since the recording has no load torque; "
            "with gravity average forward and backward passes",
        )
    points = [point for line in lines for point in _points(recording, line, bins)]
    return checked_points(points, recording, "segments", notes)


def check_bins(bins: int) -> None:
    """Refuse a number of points below 1.

    Raises
    ------
    FitError
    """
    if bins < 1:
        raise FitError(f"{option('bins', bins)} is out of range: give 1 or more points per pass")


def constant_stretches(recording: Recording, search: Search) -> list[Line]:
    """The constant-speed intervals of a recording, at least one.

    Raises
    ------
    FitError
        No measured position; an option out of range; no interval found.
    """
    search.check()
    if recording.position is None or recording.columns["position"].derived:
        raise FitError(
            f"{recording.path} has no position column, in which constant-speed intervals are "
            f"found: map one with {option('map', 'position=COLUMN')}"
        )
    lines = constant_speed(recording.time, recording.position, recording.segment, search)
    if not lines:
        raise FitError(
            f"{recording.path} has no interval of constant speed to {100 * search.tolerance:g} % "
            f"over {search.shortest:g} s or more: record passes at constant speed, or change "
            f"{option('tolerance')} and {option('shortest')}"
        )
    return lines


def _points(recording: Recording, line: Line, bins: int) -> Iterator[SteadyPoint]:
    """Points of an interval, one per share of its samples."""
    for rows in np.array_split(np.arange(line.start, line.stop), min(bins, line.rows)):
        load = None if recording.load_torque is None else recording.load_torque[rows]
        friction = recording.torque[rows] if load is None else recording.torque[rows] - load
        mean, stderr = mean_of(friction)
        temperature = recording.temperature
        yield SteadyPoint(
            start=float(recording.time[rows[0]]),
            stop=float(recording.time[rows[-1]]),
            rows=rows.size,
            velocity=line.velocity,
            velocity_stderr=line.stderr,
            friction_torque=mean,
            friction_stderr=stderr,
            load_torque=None if load is None else float(load.mean()),
            temperature=None if temperature is None else float(temperature[rows].mean()),
        )
