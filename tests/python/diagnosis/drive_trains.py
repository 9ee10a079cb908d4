"""Joints with friction that lags, with play and with a drive train that twists, by numpy alone.

Nothing here shares a formula with the fitted effects: friction looks at an earlier speed, and two
inertias with a spring between them are simulated under a controller.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray
from synthetic import COULOMB, VISCOUS, joint, motion

Array = NDArray[np.float64]

#: Samples a second of a recording, and steps of the simulation between two of them.
RATE, STEPS = 200.0, 20
#: RMS of the torque noise in N m.
NOISE = 0.03


def late_stribeck(delay: float, rows: int = 6000, noise: float = NOISE) -> pl.DataFrame:
    """Friction whose fall with speed looks at the speed of `delay` seconds before."""
    t, _, v, _ = motion(rows)
    earlier = np.interp(t - delay, t, v)
    return joint(1.5 / (1.0 + (earlier / 0.12) ** 2) * np.sign(v), rows=rows, noise=noise)


@dataclass(frozen=True)
class TwoInertias:
    """A motor and a joint with gravity, a spring with play between them.

    Inertias in kg m2 as the joint feels them, stiffness in N m/rad, play in rad, weight in N m; the
    spring carries twice the torque of a linear one at a twist of `hardening` rad.
    """

    motor: float = 0.1
    load: float = 0.9
    stiffness: float = 1500.0
    damping: float = 6.0
    play: float = 0.0
    weight: float = 8.0
    hardening: float = np.inf

    def spring(self, twist: float, rate: float) -> float:
        """Torque that a twist of the drive train carries; flanks only push."""
        half = 0.5 * self.play
        stiffness = self.stiffness * (1.0 + (twist / self.hardening) ** 2)
        if not self.play:
            return stiffness * twist + self.damping * rate
        if twist > half:
            return max(stiffness * (twist - half) + self.damping * rate, 0.0)
        if twist < -half:
            return min(stiffness * (twist + half) + self.damping * rate, 0.0)
        return 0.0

    def simulated(self, rows: int = 6000) -> dict[str, Array]:
        """Motion of both ends and the motor torque while a controller tracks `reference`."""
        step = 1.0 / (RATE * STEPS)
        wanted = reference(np.arange(rows * STEPS) * step)
        q, v, a = (column.tolist() for column in wanted)
        motor, motor_speed = q[0], v[0]
        load, load_speed = q[0], v[0]
        total = self.motor + self.load
        made = []
        for k in range(rows * STEPS):
            ahead = total * a[k] + self.weight * np.sin(motor) + VISCOUS * v[k]
            ahead += COULOMB * np.sign(v[k])
            torque = ahead + 300.0 * (q[k] - motor) + 40.0 * (v[k] - motor_speed)
            carried = self.spring(motor - load, motor_speed - load_speed)
            load_acceleration = (carried - self.weight * np.sin(load)) / self.load
            free = motor_speed + step * (torque - carried) / self.motor
            held = max(abs(free) - step * COULOMB / self.motor, 0.0)
            after = np.copysign(held, free) / (1.0 + step * VISCOUS / self.motor)
            if k % STEPS == 0:
                made.append(
                    (
                        motor,
                        motor_speed,
                        (after - motor_speed) / step,
                        torque,
                        load,
                        load_speed,
                        load_acceleration,
                    )
                )
            motor_speed = float(after)
            motor += step * motor_speed
            load_speed += step * load_acceleration
            load += step * load_speed
        names = (
            "motor",
            "motor_speed",
            "motor_acceleration",
            "torque",
            "load",
            "load_speed",
            "load_acceleration",
        )
        return dict(zip(names, np.array(made).T, strict=True))

    def resonance(self) -> float:
        """Frequency in Hz of the load on its spring."""
        return float(np.sqrt(self.stiffness / self.load)) / (2.0 * np.pi)

    def recorded(
        self, side: str, rows: int = 6000, seed: int = 4, *, seen: bool = False
    ) -> pl.DataFrame:
        """What a recording with the sensors on one `side`, motor or load, holds.

        The load torque is that of a rigid joint of the same inertia and weight: one that moves as
        the motor was told to, or, if `seen`, as it moved; or as the joint was seen to.
        """
        made = self.simulated(rows)
        rng = np.random.default_rng(seed)
        t = np.arange(rows) / RATE
        q, v = made[side], made[f"{side}_speed"]
        wanted, _, a = reference(t) if side == "motor" else (q, v, made["load_acceleration"])
        if side == "motor" and seen:
            wanted, a = q, np.gradient(v, 1.0 / RATE)
        load = (self.motor + self.load) * a + self.weight * np.sin(wanted)
        return pl.DataFrame(
            {
                "time": t,
                "position": q,
                "velocity": v + 1e-4 * rng.standard_normal(rows),
                "torque": made["torque"] + NOISE * rng.standard_normal(rows),
                "load_torque": load,
                "temperature": 30.0 - 12.0 * np.cos(2.0 * np.pi * t / t[-1]),
            }
        )


def reference(t: Array) -> tuple[Array, Array, Array]:
    """Position, velocity and acceleration of four sines that never repeat together."""
    q, v, a = np.zeros_like(t), np.zeros_like(t), np.zeros_like(t)
    for size, frequency, phase in (
        (0.8, 0.13, 0.3),
        (0.35, 0.41, 1.1),
        (0.12, 0.97, 2.0),
        (0.025, 2.3, 0.7),
    ):
        w = 2.0 * np.pi * frequency
        q += size * np.sin(w * t + phase)
        v += size * w * np.cos(w * t + phase)
        a -= size * w**2 * np.sin(w * t + phase)
    return q, v, a
