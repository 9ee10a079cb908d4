"""Coast-down: a joint without torque is stopped by its friction.

The torque is zero while the speed falls, so that the friction is minus the load torque, with the
inertia times the deceleration in it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError, option
from stribeck.fitting.methods.segments import check_bins
from stribeck.fitting.methods.steady import SteadyPoint, SteadyPoints, checked_points, mean_of
from stribeck.fitting.protocols.rests import still_speed, torque_noise
from stribeck.recording.recording import Recording
from stribeck.recording.rows import segment_slices
from stribeck.recording.weights import refuse_weights

Array = NDArray[np.float64]

#: The torque is zero within this many standard deviations of its noise, or this share of its
#: largest value.
_NOISE, _SHARE = 4.0, 0.005
#: Fewest samples of a coast-down.
_FEWEST = 20
#: The speed falls by at least this factor, and the joint moves clearly at its start.
_FALLS, _FAST = 2.0, 10.0
#: Share of the steps between tenths of a coast-down in which the speed falls.
_STEADILY = 0.999
#: Share of the motion that is left out at both ends, where a filter still sees the torque.
_TRIM = 0.08
#: Time in which a released torque ends, s.
_RELEASE = 5e-3
#: A mean torque is known to be zero to this share of the largest torque, or not at all.
_KNOWN = 0.02


@dataclass(frozen=True)
class CoastDown:
    """One coast-down: samples `start` to `stop` (exclusive).

    Attributes
    ----------
    time, duration
        Its start and length, s.
    fastest, slowest
        Velocity at its start and end, rad/s or m/s.
    """

    start: int
    stop: int
    time: float
    duration: float
    fastest: float
    slowest: float


def coast_downs(recording: Recording) -> tuple[CoastDown, ...]:
    """The coast-downs of a recording, in order of time; empty where there is none.

    Examples
    --------
    >>> [c.duration for c in coast_downs(sb.read("released.csv"))]  # doctest: +SKIP
    [2.31, 2.28]
    """
    if recording.averaged or "friction_torque" in recording.columns:
        return ()
    moving = np.abs(recording.velocity_smooth) > still_speed(recording)
    least = _zero_torque(recording)
    free = _without_torque(recording, least) & moving
    found = []
    for part in segment_slices(recording.segment):
        edges = np.flatnonzero(np.diff(free[part])) + 1 + part.start
        for start, stop in zip([part.start, *edges], [*edges, part.stop], strict=True):
            released = free[start] and _is_released(recording, least, part.start, int(start))
            one = _coast_down(recording, int(start), int(stop)) if released else None
            if one is not None:
                found.append(one)
    return tuple(found)


def _without_torque(recording: Recording, least: float) -> NDArray[np.bool_]:
    """Where the drive gives no torque, [n]: switched off, or zero but for noise."""
    if recording.enabled is not None:
        return ~recording.enabled
    torque = recording.torque
    # A torque that is everywhere this small is no drive that was released.
    if float(np.quantile(np.abs(torque), 0.99)) < 3.0 * least:
        return np.zeros(torque.size, dtype=bool)
    return np.abs(torque) <= least


def _zero_torque(recording: Recording) -> float:
    """The largest torque that counts as none."""
    largest = float(np.quantile(np.abs(recording.torque), 0.99))
    return max(_NOISE * torque_noise(recording), _SHARE * largest)


def _is_released(recording: Recording, least: float, first: int, start: int) -> bool:
    """Whether a torque ends at once at `start`; a controller's passes through zero gradually.

    A recording, or a segment from sample `first` on, may begin without torque.
    """
    if recording.enabled is not None or start == first:
        return True
    before = max(start - max(3, int(_RELEASE * recording.rate_hz)), first)
    strongest = float(np.abs(recording.torque[before:start]).max())
    return strongest > 3.0 * least


def _coast_down(recording: Recording, start: int, stop: int) -> CoastDown | None:
    """The coast-down of samples without torque; None where the speed does not fall all the way."""
    cut = int(_TRIM * (stop - start))
    if recording.cutoff_hz is not None:
        cut = max(cut, int(recording.rate_hz / recording.cutoff_hz))
    start, stop = start + cut, stop - cut
    if stop - start < _FEWEST:
        return None
    speed = np.abs(recording.velocity_smooth[start:stop])
    parts = np.array([part.mean() for part in np.array_split(speed, 10)])
    falls = float(np.mean(np.diff(parts) < 0.0)) > _STEADILY
    if not falls or speed[0] < max(_FAST * still_speed(recording), _FALLS * speed[-1]):
        return None
    if recording.enabled is None and not _stays_zero(recording, start, stop):
        return None
    time = recording.time
    return CoastDown(
        start,
        stop,
        float(time[start]),
        float(time[stop - 1] - time[start]),
        float(recording.velocity_smooth[start]),
        float(recording.velocity_smooth[stop - 1]),
    )


def _stays_zero(recording: Recording, start: int, stop: int) -> bool:
    """Whether the torque is zero all the way; one that passes through zero is a controller's."""
    largest = float(np.quantile(np.abs(recording.torque), 0.99))
    for part in np.array_split(recording.torque[start:stop], 5):
        noise = 3.0 * torque_noise(recording) / np.sqrt(part.size)
        if noise > _KNOWN * largest or abs(float(part.mean())) > max(noise, _SHARE * largest):
            return False
    return True


def coast_down_points(recording: Recording, *, bins: int = 10) -> SteadyPoints:
    """Friction points from coast-downs: torque minus load torque, means over shares of the time.

    Parameters
    ----------
    recording : Recording
        With a load torque, recorded or from a given inertia.
    bins : int
        Points per coast-down.

    Raises
    ------
    FitError
        No load torque; no coast-down.

    Examples
    --------
    >>> recording = sb.read("released.csv", inertia=0.12)  # doctest: +SKIP
    >>> coast_down_points(recording).write("points.csv")  # doctest: +SKIP
    """
    refuse_weights("a reduction to points", recording)
    check_bins(bins)
    found = coast_downs(recording)
    if not found:
        raise FitError(
            f"{recording.path}: has no coast-down, a motion without torque whose speed falls: "
            f"release the joint in motion"
        )
    if recording.load_torque is None:
        raise FitError(
            f"{recording.path}: has {len(found)} coast-downs but no load torque: give the inertia "
            f"with {option('inertia', 'J')}"
        )
    points = [point for one in found for point in _points(recording, one, bins)]
    note = f"{len(found)} coast-downs: friction is minus the load torque, inertia included"
    return checked_points(points, recording, "coast_down", [note])


def _points(recording: Recording, one: CoastDown, bins: int) -> list[SteadyPoint]:
    assert recording.load_torque is not None
    made = []
    for rows in np.array_split(np.arange(one.start, one.stop), min(bins, one.stop - one.start)):
        if rows.size < 2:
            continue
        own = recording.torque[rows] - recording.load_torque[rows]
        velocity, friction = float(recording.velocity_smooth[rows].mean()), float(own.mean())
        temperature = recording.temperature
        made.append(
            SteadyPoint(
                start=float(recording.time[rows[0]]),
                stop=float(recording.time[rows[-1]]),
                rows=rows.size,
                velocity=velocity,
                velocity_stderr=_error(recording, recording.velocity_smooth[rows]),
                friction_torque=friction,
                friction_stderr=_error(recording, own),
                temperature=None if temperature is None else float(temperature[rows].mean()),
            )
        )
    return made


def _error(recording: Recording, values: Array) -> float:
    """Standard error of a mean over time, without what changes in a straight line.

    A low-pass leaves two independent values per period of its cut-off.
    """
    along = np.linspace(-1.0, 1.0, values.size)
    slope = float(along @ values) / float(along @ along)
    own = values - slope * along
    error = mean_of(own)[1]
    if recording.cutoff_hz is None:
        return error
    independent = max(2.0 * recording.cutoff_hz * values.size / recording.rate_hz, 1.0)
    return max(error, float(own.std()) / np.sqrt(independent))
