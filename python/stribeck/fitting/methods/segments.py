"""Static friction map from a displacement log: one mean force a constant-speed stretch.

Gantry robot with ball screw (Valdiero group), section 3: each displacement is plotted, a line is
set where the speed is constant, and its slope goes with the force into the static map.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stribeck.base.errors import FitError
from stribeck.fitting.methods.steady import SteadyPoint, SteadyPoints, checked_points, mean_of
from stribeck.fitting.methods.stretches import Line, Search, constant_speed
from stribeck.recording.recording import Recording


def segment_points(
    recording: Recording, *, bins: int = 1, search: Search | None = None
) -> SteadyPoints:
    """Turn a displacement log into steady-state friction points.

    The friction of a point is the mean torque over the stretch, less the mean load torque where
    the recording gives one: at constant speed inertia takes none.

    Parameters
    ----------
    recording : Recording
        With a measured position; its velocity is not used.
    bins : int
        Points a stretch, each over an equal share of its rows: where the load changes along it.
    search : Search, optional
        What counts as constant speed.

    Returns
    -------
    SteadyPoints
        In the order of time.

    Raises
    ------
    FitError
        No position; no stretch of constant speed.

    Examples
    --------
    >>> points = segment_points(sb.read("log.csv", joint_kind="prismatic"))  # doctest: +SKIP
    >>> points.write("points.csv")  # doctest: +SKIP

    Then: ``stribeck fit points.csv --model gantry_map``.
    """
    check_bins(bins)
    lines = constant_stretches(recording, search or Search())
    notes: tuple[str, ...] = ()
    if recording.load_torque is None:
        notes = (
            "all of the mean torque is taken as friction: the recording gives no load torque; "
            "with gravity use the averaging of forward and backward passes",
        )
    points = [point for line in lines for point in _points(recording, line, bins)]
    return checked_points(points, recording, "segments", notes)


def check_bins(bins: int) -> None:
    """Refuse a number of points that a pass cannot give.

    Raises
    ------
    FitError
    """
    if bins < 1:
        raise FitError(f"--bins {bins} is out of range: give 1 or more points a pass")


def constant_stretches(recording: Recording, search: Search) -> list[Line]:
    """The constant-speed stretches of a recording, at least one.

    Raises
    ------
    FitError
        No measured position; a bad option; no stretch found.
    """
    search.check()
    if recording.position is None or recording.columns["position"].derived:
        raise FitError(
            f"{recording.path} has no position column, in which constant-speed stretches are "
            f"looked for: map one with --map position=COLUMN"
        )
    lines = constant_speed(recording.time, recording.position, recording.segment, search)
    if not lines:
        raise FitError(
            f"{recording.path} has no stretch of constant speed to {100 * search.tolerance:g} % "
            f"over {search.shortest:g} s or more: record passes at constant speed, or allow more "
            f"with --tolerance and --shortest"
        )
    return lines


def _points(recording: Recording, line: Line, bins: int) -> Iterator[SteadyPoint]:
    """Points of a stretch, one a share of its rows."""
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
