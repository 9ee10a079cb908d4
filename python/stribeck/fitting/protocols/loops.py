"""Presliding loops: small closed loops of torque over position, without sliding.

A torque below the static friction moves a joint back and forth by its elastic contacts. The slope
of torque over position in the middle of a loop is the stiffness of the bristles; the area of the
loop is the energy that it dissipates.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.protocols.rests import is_measured, torque_noise
from stribeck.recording.recording import Recording
from stribeck.recording.rows import noise_level, segment_slices

Array = NDArray[np.float64]

#: Largest half amplitude of a presliding loop: rad of a revolute joint, m of a prismatic one.
_SMALL = {"revolute": 0.02, "prismatic": 2e-4}
#: A torque turns when it comes back by this share of its range, and this many times its noise.
_TURN, _NOISE = 0.02, 8.0
#: The ends of a loop agree to this share of its span, in torque and in position.
_CLOSED = 0.2
#: Area over that of the rectangle around the loop: sliding fills it, presliding does not.
_FULL = 0.6
#: The span of the position over its noise.
_SEEN = 8.0
#: Share of the torque's span around the middle in which the slope is taken.
_MIDDLE = 0.5
_FEWEST = 20


@dataclass(frozen=True)
class Loop:
    """One presliding loop.

    Attributes
    ----------
    time, duration
        Its start and length, s.
    torque_amplitude, amplitude
        Half the spans of torque and position, N m and rad, or N and m.
    stiffness
        Slope of the torque over the position in the middle of both branches, per rad or m.
    area
        Energy dissipated per loop, J.
    """

    time: float
    duration: float
    torque_amplitude: float
    amplitude: float
    stiffness: float
    area: float


def presliding_loops(recording: Recording) -> tuple[Loop, ...]:
    """The presliding loops of a recording, in order of time; empty where there is none.

    Examples
    --------
    >>> [loop.stiffness for loop in presliding_loops(sb.read("small.csv"))]  # doctest: +SKIP
    [50120.0, 49890.0]
    """
    if recording.averaged or not is_measured(recording) or recording.position is None:
        return ()
    torque = recording.torque - recording.known_torque
    noise = torque_noise(recording)
    position_noise = noise_level(recording.time, recording.position, recording.segment)
    found = []
    for part in segment_slices(recording.segment):
        tau, q = torque[part], recording.position[part]
        for start, stop in _cycles(tau, noise):
            rows = slice(part.start + start, part.start + stop)
            loop = _loop(recording.time[rows], tau[start:stop], q[start:stop])
            small = loop is not None and loop.amplitude <= _SMALL[recording.joint_kind]
            if loop is not None and small and 2.0 * loop.amplitude > _SEEN * position_noise:
                found.append(loop)
    return tuple(found)


def _cycles(torque: Array, noise: float) -> Iterator[tuple[int, int]]:
    """Samples from one lower turning point of a torque to the next."""
    turns = _turns(torque, max(_TURN * float(np.ptp(torque)), _NOISE * noise))
    lower = [at for at, kind in turns if kind < 0]
    for start, stop in itertools.pairwise(lower):
        if stop - start >= _FEWEST:
            yield start, stop + 1


def _turns(values: Array, least: float) -> list[tuple[int, int]]:
    """Turning points: sample and kind, 1 for an upper and -1 for a lower one."""
    found: list[tuple[int, int]] = []
    direction, low, high = 0, 0, 0
    for k in range(values.size):
        if values[k] > values[high]:
            high = k
        if values[k] < values[low]:
            low = k
        if direction >= 0 and values[k] < values[high] - least:
            found.append((high, 1))
            direction, low = -1, k
        elif direction <= 0 and values[k] > values[low] + least:
            found.append((low, -1))
            direction, high = 1, k
    return found


def _loop(time: Array, torque: Array, position: Array) -> Loop | None:
    """The loop of one cycle; None if it does not close, or slides."""
    span, travel = float(np.ptp(torque)), float(np.ptp(position))
    if span <= 0.0 or travel <= 0.0:
        return None
    ends = abs(torque[-1] - torque[0]) < _CLOSED * span
    ends = ends and abs(position[-1] - position[0]) < _CLOSED * travel
    area = float(np.sum(0.5 * (torque[1:] + torque[:-1]) * np.diff(position)))
    area += 0.5 * float(torque[0] + torque[-1]) * float(position[0] - position[-1])
    full = area / (span * travel)
    if not (ends and 0.0 <= full < _FULL):
        return None
    stiffness = _slope(torque, position)
    # A softer middle than the whole loop would not be a spring that yields.
    if stiffness is None or stiffness < 0.5 * span / travel:
        return None
    return Loop(
        float(time[0]),
        float(time[-1] - time[0]),
        0.5 * span,
        0.5 * travel,
        stiffness,
        area,
    )


def _slope(torque: Array, position: Array) -> float | None:
    """Slope of torque over position around the middle torque, with both branches side by side."""
    top = int(np.argmax(torque))
    middle = 0.5 * (float(torque.max()) + float(torque.min()))
    near = np.abs(torque - middle) < 0.5 * _MIDDLE * float(np.ptp(torque))
    x, y = [], []
    for branch in (slice(0, top + 1), slice(top, torque.size)):
        kept = near[branch]
        if kept.sum() < 3:
            return None
        x.append(position[branch][kept] - position[branch][kept].mean())
        y.append(torque[branch][kept] - torque[branch][kept].mean())
    q, tau = np.concatenate(x), np.concatenate(y)
    both, power = float(q @ tau), float(tau @ tau)
    # The position on the torque, which a drive sets: noise of the position then does not tilt it.
    return power / both if both > 0.0 else None
