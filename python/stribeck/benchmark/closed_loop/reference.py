"""The reference motion of the controller.

Rectangular pulses of speed are filtered by two moving averages, as in many controllers. This gives
S-shaped speed profiles, and the area of a pulse is the length of the move. Between the moves there
are sums of sines that fade in and out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.benchmark.closed_loop.machine import STEP, Machine
from stribeck.benchmark.draws import log_uniform

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Reference:
    """Reference motion at intervals of `STEP`; `dwells` are times at rest."""

    time: Array
    position: Array
    velocity: Array
    acceleration: Array
    dwells: Array


def draw_reference(rng: np.random.Generator, machine: Machine, duration: float) -> Reference:
    """Moves at all speeds, slow scans, quick strokes and sines, in random order."""
    builder = _Pulses(rng, machine)
    while builder.end < duration:
        kinds = (builder.moves, builder.scans, builder.strokes, builder.sines, builder.scans)
        for k in rng.permutation(len(kinds)):
            kinds[k]()
            builder.wait(float(rng.uniform(0.3, 0.7)) + 2 * machine.ramp)
            builder.dwells.append(builder.end - 0.1)
    return builder.reference(round(duration / STEP))


class _Pulses:
    def __init__(self, rng: np.random.Generator, machine: Machine) -> None:
        self.rng, self.machine = rng, machine
        self.speeds: list[Array] = [np.zeros(round(0.7 / STEP))]
        self.waves: list[tuple[float, Array]] = []
        self.dwells: list[float] = []
        self.end, self.q = 0.7, machine.centre

    def wait(self, seconds: float) -> None:
        self._pulse(0.0, seconds)

    def _pulse(self, speed: float, seconds: float) -> None:
        steps = max(round(seconds / STEP), 1)
        self.speeds.append(np.full(steps, speed))
        self.end += steps * STEP
        self.q += speed * steps * STEP

    def _go(self, target: float, speed: float) -> None:
        way = target - self.q
        if abs(way) > 0.02 * self.machine.half:
            self._pulse(math.copysign(speed, way), abs(way) / speed)

    def _place(self) -> float:
        return self.machine.centre + self.machine.half * float(self.rng.uniform(-1.0, 1.0))

    def moves(self) -> None:
        """Add point-to-point moves with dwells."""
        for _ in range(5):
            self._go(self._place(), self.machine.vmax * float(self.rng.uniform(0.2, 1.0)))
            self.wait(float(self.rng.uniform(0.05, 0.5)))

    def scans(self) -> None:
        """Add slow motion back and forth, with speeds over more than a decade."""
        side = 1.0 if self.q < self.machine.centre else -1.0
        for _ in range(5):
            speed = self.machine.vmax * log_uniform(self.rng, 0.012, 0.15)
            self._pulse(side * speed, float(self.rng.uniform(0.8, 1.8)))
            if self.rng.random() < 0.6:
                side = -side

    def strokes(self) -> None:
        """Add reversals without a dwell."""
        first = self._place()
        way = self.machine.half * log_uniform(self.rng, 0.1, 0.8)
        other = first - math.copysign(way, first - self.machine.centre)
        speed = self.machine.vmax * log_uniform(self.rng, 0.15, 1.0)
        self._go(first, 0.6 * self.machine.vmax)
        for _ in range(3):
            self._go(other, speed)
            self._go(first, speed)

    def sines(self) -> None:
        """Add a sum of sines about the middle of the stroke."""
        self._go(self.machine.centre, 0.5 * self.machine.vmax)
        self.wait(3 * self.machine.ramp)
        length = float(self.rng.uniform(7.0, 11.0))
        t = np.arange(round(length / STEP)) * STEP
        count = int(self.rng.integers(3, 6))
        top = self.machine.vmax / self.machine.half
        rates = top * self.rng.uniform(0.4, 1.8, count)
        phases = self.rng.uniform(0.0, 2 * math.pi, count)
        wave = np.sin(np.outer(t, rates) + phases) @ (self.rng.uniform(0.4, 1.0, count) / rates)
        wave *= np.sin(math.pi * t / length) ** 2
        fastest = float(np.abs(np.gradient(wave, STEP)).max())
        scale = min(0.9 * self.machine.half / np.abs(wave).max(), self.machine.vmax / fastest)
        self.waves.append((self.end, scale * wave))
        self.wait(length)

    def reference(self, steps: int) -> Reference:
        """Return the filtered motion up to `steps`."""
        pulses = np.concatenate(self.speeds)
        for seconds in (self.machine.ramp, 0.5 * self.machine.ramp):
            pulses = np.asarray(
                scipy.ndimage.uniform_filter1d(pulses, round(seconds / STEP), mode="nearest")
            )
        q = self.machine.centre + np.cumsum(pulses) * STEP
        for start, wave in self.waves:
            at = round(start / STEP)
            q[at : at + wave.size] += wave
        v = np.diff(q, prepend=q[0]) / STEP
        a = np.diff(v, prepend=v[0]) / STEP
        t = STEP * np.arange(steps, dtype=np.float64)
        dwells = np.array([d for d in self.dwells if d < t[-1]])
        return Reference(t, q[:steps], v[:steps], a[:steps], dwells)
