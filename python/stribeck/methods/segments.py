"""Static friction map from a displacement log: one mean force a constant-speed stretch.

Gantry robot with ball screw (Valdiero group), section 3: each displacement is plotted, a line is
set where the speed is constant, and its slope goes with the force into the static map.
"""

from __future__ import annotations

from stribeck.errors import FitError
from stribeck.methods.steady import SteadyPoint, SteadyPoints, checked_points, mean_of
from stribeck.methods.stretches import Line, Search, constant_speed
from stribeck.recording import Recording


def segment_points(recording: Recording, *, search: Search | None = None) -> SteadyPoints:
    """Turn a displacement log into steady-state friction points.

    The friction of a point is the mean torque over the stretch, less the mean load torque where
    the recording gives one: at constant speed inertia takes none.

    Parameters
    ----------
    recording : Recording
        With a measured position; its velocity is not used.
    search : Search, optional
        What counts as constant speed.

    Returns
    -------
    SteadyPoints
        One a stretch, in the order of time.

    Raises
    ------
    FitError
        No position; no stretch of constant speed.

    Examples
    --------
    >>> points = segment_points(sb.read("log.csv", joint_kind="prismatic"))
    >>> points.write("points.csv")  # then: stribeck fit points.csv --model gantry_map
    """
    lines = constant_stretches(recording, search or Search())
    notes: tuple[str, ...] = ()
    if recording.load_torque is None:
        notes = (
            "all of the mean torque is taken as friction: the recording gives no load torque; "
            "with gravity use the averaging of forward and backward passes",
        )
    points = [_point(recording, line) for line in lines]
    return checked_points(points, recording, "segments", notes)


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


def _point(recording: Recording, line: Line) -> SteadyPoint:
    rows = slice(line.start, line.stop)
    load = None if recording.load_torque is None else recording.load_torque[rows]
    friction = recording.torque[rows] if load is None else recording.torque[rows] - load
    mean, stderr = mean_of(friction)
    temperature = recording.temperature
    return SteadyPoint(
        start=float(recording.time[line.start]),
        stop=float(recording.time[line.stop - 1]),
        rows=line.rows,
        velocity=line.velocity,
        velocity_stderr=line.stderr,
        friction_torque=mean,
        friction_stderr=stderr,
        load_torque=None if load is None else float(load.mean()),
        temperature=None if temperature is None else float(temperature[rows].mean()),
    )
