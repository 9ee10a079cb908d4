"""The motion of a recording: a random sequence of sines, moves, slow scans and strokes."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.open_loop.joint import SimulatedJoint
from stribeck.benchmark.open_loop.motion import MoveChain
from stribeck.benchmark.open_loop.moves import Array, multisine, quintic, stroke, trapezoid


def schedule(
    rng: np.random.Generator,
    joint: SimulatedJoint,
    duration: float,
    limit: str | None,
    brisk: bool = False,
    smooth: bool = False,
) -> tuple[MoveChain, Array]:
    """Return the motion, and the times at which the payload may change (the middle of dwells).

    A `brisk` motion has few slow reversals, so that few samples are inside the presliding distance.
    A `smooth` motion has no jumps of acceleration, near which the direction is uncertain under a
    delay.
    """
    scheduler = _Scheduler(rng, joint, brisk, smooth)
    return scheduler.fill(duration, scheduler.kinds(limit))


class _Scheduler:
    """Appends parts of one kind of motion each."""

    def __init__(
        self, rng: np.random.Generator, joint: SimulatedJoint, brisk: bool, smooth: bool
    ) -> None:
        self.rng, self.joint, self.brisk, self.smooth = rng, joint, brisk, smooth
        self.motion = MoveChain(q=joint.centre)
        self.motion.rest(0.5)

    def kinds(self, limit: str | None) -> list[Callable[[float], None]]:
        """Return the kinds of motion that are allowed under `limit`."""
        if limit == "one_direction":
            return [self.one_way]
        if limit == "no_slow_motion":
            return [self.fast]
        if self.smooth:
            return [self.sines, self.moves, self.slow, self.sines]
        return [
            self.sines,
            self.moves,
            self.slow,
            self.strokes,
            self.moves,
            self.sines,
            self.strokes,
            self.slow,
        ]

    def fill(
        self, duration: float, kinds: list[Callable[[float], None]]
    ) -> tuple[MoveChain, Array]:
        """Append parts of all kinds in random order, with a dwell after each."""
        rng, motion = self.rng, self.motion
        swaps: list[float] = []
        while motion.end < duration:
            for i in rng.permutation(len(kinds)):
                kinds[i](rng.uniform(7.0, 13.0))
                motion.rest(rng.uniform(0.4, 0.8))
                swaps.append(motion.end - 0.2)
        return motion, np.asarray(swaps)

    def go(self, q: float, vmax: float, amax: float) -> None:
        """Move to `q`, unless it is already there."""
        delta = q - self.motion.q
        if abs(delta) <= 1e-3 * self.joint.half:
            return
        total, move = trapezoid(delta, vmax, amax)
        if self.smooth:
            total = max(1.875 * abs(delta) / vmax, math.sqrt(5.8 * abs(delta) / amax))
            move = quintic(delta, total)
        self.motion.add(total, move, delta)

    def sines(self, length: float) -> None:
        """Append a multi-sine within the limits of position, speed and acceleration."""
        rng, joint = self.rng, self.joint
        start = joint.centre + 0.1 * joint.half * rng.uniform(-1, 1)
        self.go(start, 0.5 * joint.vmax, joint.amax / 2)
        n = int(rng.integers(3, 7))
        omega = joint.vmax / joint.half * rng.uniform(0.3, 2.2, n)
        amp, phase = rng.uniform(0.3, 1.0, n), rng.uniform(0, 2 * math.pi, n)
        amp /= omega**0.7
        probe = np.linspace(0, length, 1500)
        q, v, a = multisine(amp, omega, phase, length, length / 8)(probe)
        scale = min(
            0.9 * joint.half / np.abs(q).max(),
            joint.vmax / np.abs(v).max(),
            joint.amax / np.abs(a).max(),
        )
        self.motion.add(length, multisine(amp * scale, omega, phase, length, length / 8), 0.0)

    def moves(self, length: float) -> None:
        """Append point-to-point moves at all speeds, with dwells."""
        rng, joint, motion = self.rng, self.joint, self.motion
        end = motion.end + length
        while motion.end < end:
            q = joint.centre + joint.half * rng.uniform(-1, 1)
            d = abs(q - motion.q)
            if d < 0.1 * joint.half:
                continue
            v = joint.vmax * rng.uniform(0.15, 1.0)
            if rng.random() < 0.5:
                self.go(q, v, joint.amax * rng.uniform(0.2, 1.0))
            else:
                total = max(1.875 * d / v, math.sqrt(5.8 * d / joint.amax))
                motion.add(total, quintic(q - motion.q, total), q - motion.q)
            motion.rest(rng.uniform(0.1, 0.6))

    def slow(self, length: float) -> None:
        """Append slow scans back and forth."""
        rng, joint, motion = self.rng, self.joint, self.motion
        end, side = motion.end + length, 1.0 if motion.q < joint.centre else -1.0
        while motion.end < end:
            v = joint.vmax * log_uniform(rng, 0.05 if self.brisk else 0.008, 0.12)
            room = joint.half - side * (motion.q - joint.centre)
            d = min(v * rng.uniform(1.5, 5.0), max(room, 0.02 * joint.half))
            self.go(motion.q + side * d, v, joint.amax * log_uniform(rng, 0.02, 0.3))
            if rng.random() < (0.1 if self.brisk else 0.5):
                side = -side
            if rng.random() < 0.3:
                motion.rest(rng.uniform(0.1, 0.4))

    def strokes(self, length: float) -> None:
        """Append cosine strokes with different accelerations at the reversals."""
        rng, joint, motion = self.rng, self.joint, self.motion
        end = motion.end + length
        while motion.end < end:
            d = (
                joint.half
                * log_uniform(rng, 0.2 if self.brisk else 0.05, 0.9)
                * (-1 if motion.q > joint.centre else 1)
            )
            a = joint.amax * log_uniform(rng, 0.08, 1.0)
            total = math.pi * max(math.sqrt(abs(d) / 2 / a), abs(d) / 2 / joint.vmax)
            for i in range(int(rng.integers(1, 4)) * 2 + 1):
                back = d * (-1) ** i
                motion.add(total, stroke(back, total), back)

    def one_way(self, length: float) -> None:
        """Append forward moves only."""
        rng, joint, motion = self.rng, self.joint, self.motion
        end = motion.end + length
        while motion.end < end:
            d = rng.uniform(0.2, 2.5)
            v = joint.vmax * log_uniform(rng, 0.02, 1.0)
            if rng.random() < 0.5:
                way = d * min(1.0, 4 * v / joint.vmax)
                self.go(motion.q + way, v, joint.amax * rng.uniform(0.2, 1.0))
            else:
                total = max(1.875 * d / v, math.sqrt(5.8 * d / joint.amax))
                way = d * min(1, 12 / total)
                motion.add(min(total, 12.0), quintic(way, min(total, 12.0)), 0.0)
                motion.q += way
            motion.rest(rng.uniform(0.1, 0.5))

    def fast(self, length: float) -> None:
        """Append moves near the top speed over the whole stroke."""
        rng, joint, motion = self.rng, self.joint, self.motion
        end = motion.end + length
        while motion.end < end:
            v = joint.vmax * rng.uniform(0.7, 1.0)
            side = -1 if motion.q > joint.centre else 1
            place = joint.centre + side * joint.half * rng.uniform(0.85, 1.0)
            self.go(place, v, joint.vmax / 0.15)
            motion.rest(rng.uniform(0.05, 0.2))
