"""The windup of a transmission: the motor's position at the joint side minus that of the joint."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError, option
from stribeck.recording.derive import Smoother, choose_cutoff
from stribeck.recording.motion.derived_motion import acceleration_cutoff, slope
from stribeck.recording.recording import Recording
from stribeck.recording.rows import SIGMAS, noise_level, segment_slices

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: The windup turns if it comes back by this many standard deviations of its noise.
_TURN = 6.0
#: Share of samples in which the motor must move for its friction to be seen.
_MOVES = 0.1


@dataclass(frozen=True)
class Windup:
    """The samples of a recording from which the windup is read, arrays [n] in order of time.

    Attributes
    ----------
    time, segment
        As in the recording.
    windup
        Motor minus joint, rad or m, without its noise; the zeros of both encoders are arbitrary.
    noise
        Standard deviation of the noise that is left in it.
    torque
        At the joint side, as recorded.
    torque_noise
        Standard deviation of its noise.
    velocity, acceleration
        Of the motor, at the joint side, per s and s2.
    rising
        Direction of the windup, 1 or -1; it turns when the windup comes back beyond its noise.
    moves
        Whether the motor moves, so that its friction has a direction.
    locked
        Whether the joint is held, so that the motor moves by its windup alone; its friction is then
        part of the hysteresis.
    """

    time: Array
    segment: NDArray[np.int64]
    windup: Array
    noise: float
    torque: Array
    torque_noise: float
    velocity: Array
    acceleration: Array
    rising: Array
    moves: bool
    locked: bool

    @property
    def range(self) -> float:
        """Span of the windup but for 0.1 % at each end, rad or m."""
        low, high = np.quantile(self.windup, [0.001, 0.999])
        return float(high - low)

    @classmethod
    def of(cls, recording: Recording) -> Windup:
        """The windup of a recording with two encoders.

        Raises
        ------
        FitError
            One of them is missing, or the torque was not measured at the motor's side.
        """
        motor, joint = _positions(recording)
        time, segment = recording.time, recording.segment
        raw = motor - joint
        sigma = noise_level(time, raw, segment)
        cutoff = choose_cutoff(time, raw, segment, 1)
        windup = Smoother(time, segment, cutoff).smooth(raw)
        if cutoff is not None and recording.rate_hz > 0.0:
            sigma *= float(np.sqrt(min(2.0 * cutoff / recording.rate_hz, 1.0)))
        velocity, speed_cutoff = slope(time, motor, segment)
        if recording.motor_velocity is not None:
            velocity = recording.motor_velocity
        typical = recording.scales()["sample_period"]
        highest = acceleration_cutoff(time, velocity, segment, typical, speed_cutoff)
        acceleration = Smoother(time, segment, highest).smooth(motor, 2)
        moving = np.abs(velocity) > max(
            recording.velocity_threshold, SIGMAS * noise_level(time, velocity, segment)
        )
        locked = float(np.ptp(joint)) < float(np.ptp(raw))
        moves = not locked and bool(moving.mean() > _MOVES)
        kept = moving if moves else np.ones(time.size, dtype=bool)
        rising = _directions(windup, segment, _TURN * sigma)
        kept &= rising != 0.0
        return cls(
            time[kept],
            segment[kept],
            windup[kept],
            sigma,
            recording.torque[kept],
            noise_level(time, recording.torque, segment),
            velocity[kept],
            acceleration[kept],
            rising[kept],
            moves,
            locked,
        )


def _positions(recording: Recording) -> tuple[Array, Array]:
    path = recording.path
    if recording.motor_position is None:
        raise FitError(
            f"{path}: has no position of the motor, which shows the windup of the transmission: "
            f"name it with {option('map', 'motor_position=COLUMN')} and give {option('gear_ratio')}"
        )
    if recording.position is None or recording.averaged:
        raise FitError(f"{path}: the windup needs samples in time with a position of the joint")
    if recording.torque_at == "link" or "friction_torque" in recording.columns:
        raise FitError(
            f"{path}: the windup is compared with the torque of the motor, which is not recorded"
        )
    return recording.motor_position, recording.position


def _directions(values: Array, segment: NDArray[np.int64], least: float) -> Array:
    """Whether a signal rises (1) or falls (-1), [n]; 0 until it has moved by `least`."""
    found = np.zeros(values.size)
    for part in segment_slices(segment):
        direction, low, high = 0.0, float(values[part.start]), float(values[part.start])
        for k in range(part.start, part.stop):
            x = float(values[k])
            low, high = min(low, x), max(high, x)
            if direction >= 0.0 and x < high - least:
                direction, low = -1.0, x
            elif direction <= 0.0 and x > low + least:
                direction, high = 1.0, x
            found[k] = direction
            if direction > 0.0:
                low = x
            elif direction < 0.0:
                high = x
    return found
