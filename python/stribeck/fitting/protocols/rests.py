"""Rests of a joint that end in motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.recording.recording import Recording
from stribeck.recording.rows import SIGMAS, noise_level, segment_slices

Array = NDArray[np.float64]

#: Fewest samples of a rest, and of the motion after it.
FEWEST = 8
#: A rest is longer than a smooth reversal would stay below the threshold by this factor.
_LONGER = 3.0
#: The motion after a rest reaches this many times the speed of a joint at rest.
_FAST = 3.0

#: Creep in presliding is slower than this share of the fastest motion.
_CREEP = 2e-3


@dataclass(frozen=True)
class Rest:
    """A rest that ends in motion: samples `start` to `stop` at rest, moving until `end`.

    Attributes
    ----------
    direction
        Of the motion after it, 1 or -1.
    """

    start: int
    stop: int
    end: int
    direction: float


def is_measured(recording: Recording) -> bool:
    """Whether the position was measured."""
    return recording.position is not None and not recording.columns["position"].derived


def torque_noise(recording: Recording) -> float:
    """Standard deviation of the torque's noise; computed once."""
    kept = recording.remembered.setdefault("torque_noise", {})
    if "torque" not in kept:
        kept["torque"] = noise_level(recording.time, recording.torque, recording.segment)
    return kept["torque"]


def still_speed(recording: Recording) -> float:
    """Speed below which the smooth velocity is that of a joint at rest, per s; computed once.

    Five standard deviations of the noise that the zero-phase low-pass leaves in the velocity, and
    at least 0.2 % of the fastest motion.
    """
    kept = recording.remembered.setdefault("still_speed", {})
    if "speed" not in kept:
        rate, cutoff = recording.rate_hz, recording.cutoff_hz
        passed = 0.5 * rate if cutoff is None else min(cutoff, 0.5 * rate)
        left = float(np.sqrt(2.0 * passed / rate)) if rate > 0.0 else 1.0
        if recording.columns["velocity"].derived and recording.position is not None:
            noise = noise_level(recording.time, recording.position, recording.segment)
            # White noise of a position, differentiated within the band that passes.
            noise *= 2.0 * np.pi * passed / np.sqrt(3.0)
        else:
            noise = noise_level(recording.time, recording.velocity, recording.segment)
        fastest = float(np.abs(recording.velocity_smooth).max())
        kept["speed"] = max(SIGMAS * noise * left, _CREEP * fastest)
    return kept["speed"]


def rests(recording: Recording) -> Iterator[Rest]:
    """The rests of a recording that end in motion, in order of time.

    A joint rests while it is slower than its `still_speed`. A smooth reversal also passes
    through zero: it is no rest, unless it stays there for longer than its acceleration explains.
    """
    speed = recording.velocity_smooth
    threshold = still_speed(recording)
    moving = _moving(np.abs(speed), threshold)
    for part in segment_slices(recording.segment):
        edges = np.flatnonzero(np.diff(moving[part])) + 1 + part.start
        bounds = [part.start, *map(int, edges), part.stop]
        for start, stop, end in zip(bounds, bounds[1:], bounds[2:], strict=False):
            if moving[start] or min(stop - start, end - stop) < FEWEST:
                continue
            away = np.abs(speed[stop:end])
            fast = np.flatnonzero(away > _FAST * threshold)
            if not fast.size:
                continue
            rise = float(recording.time[stop + fast[0]] - recording.time[stop])
            rested = float(recording.time[stop] - recording.time[start])
            # The rise from one to three thresholds takes as long as a reversal from -1 to 1.
            if rested > _LONGER * rise:
                yield Rest(start, stop, end, float(np.sign(speed[stop])))


def _moving(speed: Array, threshold: float) -> NDArray[np.bool_]:
    """The samples of stretches above the threshold that become clearly faster, [n]."""
    above = speed > threshold
    edges = np.flatnonzero(np.diff(above)) + 1
    bounds = np.concatenate([[0], edges, [speed.size]])
    fastest = np.maximum.reduceat(speed, bounds[:-1])
    number = np.repeat(np.arange(bounds.size - 1), np.diff(bounds))
    return above & (fastest > _FAST * threshold)[number]
