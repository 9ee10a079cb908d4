"""Sizes of a joint, and a motion rich enough to identify friction."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
#: Position, velocity and acceleration of a move at the times since its start.
Move: TypeAlias = Callable[[Array], tuple[Array, Array, Array]]


@dataclass(frozen=True)
class GeneratedJoint:
    """Sizes of a joint, in SI units; forces for a prismatic one."""

    kind: str
    stroke: float
    speed: float
    coulomb: float
    viscous: float
    inertia: float
    gravity: float

    @property
    def units(self) -> tuple[str, str]:
        """Unit of torque and of position."""
        return ("N m", "rad") if self.kind == "revolute" else ("N", "m")


JOINTS = {
    "revolute": GeneratedJoint("revolute", 1.2, 2.0, 8.0, 5.0, 1.2, 22.0),
    "prismatic": GeneratedJoint("prismatic", 0.35, 0.5, 60.0, 150.0, 18.0, 150.0),
}


@dataclass(frozen=True)
class Motion:
    """Moves from rest to rest, one after another, each an analytic function of time."""

    starts: tuple[float, ...]
    origins: tuple[float, ...]
    moves: tuple[Move, ...]
    swaps: tuple[float, ...]

    def __call__(self, t: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at the times `t`."""
        q, v, a = np.empty_like(t), np.empty_like(t), np.empty_like(t)
        which = np.maximum(np.searchsorted(self.starts, t, side="right") - 1, 0)
        for i in np.unique(which):
            rows = which == i
            dq, v[rows], a[rows] = self.moves[i](np.maximum(t[rows] - self.starts[i], 0.0))
            q[rows] = self.origins[i] + dq
        return q, v, a


def _pass(distance: float, speed: float, ramp: float) -> tuple[float, Move]:
    """Duration and move with a cruise at `speed` and cosine-shaped ramps of the speed."""
    # If the distance is too short to reach the speed: the same ramps to a lower speed.
    cruise = abs(distance) / speed - ramp
    if cruise < 0.0:
        speed, cruise = abs(distance) / ramp, 0.0
    top = math.copysign(speed, distance)
    end = cruise + 2.0 * ramp
    w = math.pi / ramp

    def up(t: Array) -> tuple[Array, Array, Array]:
        return (
            0.5 * top * (t - np.sin(w * t) / w),
            0.5 * top * (1.0 - np.cos(w * t)),
            0.5 * top * w * np.sin(w * t),
        )

    def move(t: Array) -> tuple[Array, Array, Array]:
        rising, falling = np.minimum(t, ramp), np.clip(end - t, 0.0, ramp)
        q_up, v_up, a_up = up(rising)
        q_down, v_down, a_down = up(falling)
        first, last = t < ramp, t > ramp + cruise
        q = np.where(last, distance - q_down, q_up + top * np.clip(t - ramp, 0.0, cruise))
        v = np.where(first, v_up, np.where(last, v_down, top))
        a = np.where(first, a_up, np.where(last, -a_down, 0.0))
        return q, v, a

    return end, move


def _oscillation(duration: float, reach: float, frequency: float) -> Move:
    """Oscillation about the current position that grows from rest and decays to rest."""
    w, e = 2.0 * math.pi * frequency, math.pi / duration

    def move(t: Array) -> tuple[Array, Array, Array]:
        t = np.minimum(t, duration)
        grow, rate, bend = (
            np.sin(e * t) ** 2,
            e * np.sin(2.0 * e * t),
            2.0 * e * e * np.cos(2.0 * e * t),
        )
        s, c = np.sin(w * t), np.cos(w * t)
        return (
            reach * grow * s,
            reach * (rate * s + grow * w * c),
            reach * (bend * s + 2.0 * rate * w * c - grow * w * w * s),
        )

    return move


def _dwell(t: Array) -> tuple[Array, Array, Array]:
    zero = np.zeros_like(t)
    return zero, zero, zero


def plan_motion(rng: np.random.Generator, joint: GeneratedJoint, seconds: float) -> Motion:
    """Draw a motion of at least `seconds` with slow and fast passes, oscillations and dwells."""
    starts: list[float] = []
    origins: list[float] = []
    moves: list[Move] = []
    swaps: list[float] = []
    now, at, turn = 0.0, 0.0, 0

    def add(duration: float, move: Move, advance: float) -> None:
        nonlocal now, at
        starts.append(now)
        origins.append(at)
        moves.append(move)
        now, at = now + duration, at + advance

    add(0.5, _dwell, 0.0)
    while now < seconds:
        slow, middle = rng.uniform(0.008, 0.06), rng.uniform(0.12, 0.45)
        # Every speed is used in both directions, so that direction and speed are independent.
        for share in (rng.uniform(0.75, 1.0), middle, slow):
            speed = share * joint.speed
            ramp = rng.uniform(0.25, 0.5)
            way = -1.0 if at > 0.0 else 1.0
            room = joint.stroke * rng.uniform(0.6, 1.0) + abs(at)
            distance = way * min(room, speed * rng.uniform(1.4, 2.0))
            for leg in (distance, -distance):
                duration, move = _pass(leg, speed, ramp)
                add(duration, move, leg)
            if rng.uniform() < 0.5:
                duration, move = _pass(0.5 * distance, 0.5 * joint.speed, ramp)
                add(duration, move, 0.5 * distance)
            swaps.append(now + 0.15)
            add(0.3, _dwell, 0.0)
        if turn % 2 == 0:
            frequency = rng.uniform(0.3, 1.1)
            reach = min(0.9 * joint.speed / (2.0 * math.pi * frequency), 0.4 * joint.stroke)
            add(3.0, _oscillation(3.0, reach, frequency), 0.0)
            swaps.append(now + 0.15)
            add(0.3, _dwell, 0.0)
        turn += 1
    add(60.0, _dwell, 0.0)
    return Motion(tuple(starts), tuple(origins), tuple(moves), tuple(swaps))
