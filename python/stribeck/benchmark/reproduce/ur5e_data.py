"""What stands in for the measurements of the UR5e review: joint 1 with printed parameters.

The motions are those of the review's tests in kind (`motion.generate.ur5e`); friction is a law with
the parameters of table 7; noise has the standard deviation that tables 4 to 6 print for that law.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.evaluate import evaluate
from stribeck.models.model import Model
from stribeck.motion.generate.ur5e import UR5E, RobotRecording
from stribeck.recording.load import read
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Cycles of Test 2 that are used of ninety, and rates of one cycle and of several, Hz.
CYCLES = (0, 6, 15, 30, 55, 89)
RATE, THIN_RATE = 50.0, 5.0
#: Temperatures: of the room, of the warm joint [degC], and the time constant of its warming [s].
COLD, WARM, WARMING = 24.0, 38.0, 1500.0


@dataclass(frozen=True)
class Motion:
    """Joint 1 over one cycle or several: arrays [n], and the number of the cycle."""

    time: Array
    cycle: Array
    position: Array
    velocity: Array
    acceleration: Array
    load: Array
    temperature: Array

    def friction(self, model: Model) -> Array:
        """Friction torque, N m, array [n]; a bristle starts at rest in each cycle."""
        friction = np.zeros(self.time.size)
        # The motor torque, which Clochiatti's law reads, contains the friction itself.
        for _ in range(3 if "motor_torque" in model.core.needs else 1):
            friction = evaluate(model, self.recording(friction, 0.0, 0)).prediction - self.load
        return friction

    def recording(self, friction: Array, noise: float, seed: int) -> Recording:
        """The motion and its torque, with white noise of RMS `noise`; all samples count."""
        rng = np.random.default_rng([seed, 7])
        table = {
            "run": self.cycle,
            "time": self.time,
            "position": self.position,
            "velocity": self.velocity,
            "acceleration": self.acceleration,
            "load_torque": self.load,
            "temperature": self.temperature,
            "torque": self.load + friction + noise * rng.standard_normal(self.time.size),
        }
        return read(table, joint_kind="revolute", rows="all")


def motion(test: int, seed: int, *, warming: bool) -> Motion:
    """Joint 1 of Test 1 or 2; with `warming`, of several cycles while the joint warms up."""
    planned = RobotRecording(test=test, seed=seed).trajectory
    rate = THIN_RATE if warming else RATE
    clock = np.arange(int(planned.seconds * rate)) / rate
    q, v, a = planned(clock)
    load = UR5E.load_torque(q, v, a)[:, 0]
    cycles = np.array(CYCLES if warming else (0,))
    start = cycles * planned.seconds
    time = (start[:, None] + clock).ravel()
    many = cycles.size
    return Motion(
        time=time,
        cycle=np.repeat(cycles + 1, clock.size),
        position=np.tile(q[:, 0], many),
        velocity=np.tile(v[:, 0], many),
        acceleration=np.tile(a[:, 0], many),
        load=np.tile(load, many),
        temperature=WARM - (WARM - COLD) * np.exp(-time / WARMING),
    )


@lru_cache(maxsize=2)
def robot(test: int, seed: int) -> RobotRecording:
    """The synthetic arm of figures 4, 5, 8 and 9."""
    repeats = 1 if test == 1 else 90
    every = max(1, repeats - 1)
    return RobotRecording(test=test, seed=seed, repeats=repeats, every=every, rate=50.0)
