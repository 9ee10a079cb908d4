"""Recordings of a six-joint arm like the UR5e of the review, with friction outside the catalog.

The review of 25 friction models (2024/25, section 4) moves a UR5e through trapezoidal speed
profiles between six way points (Test 1), and through fifth-degree polynomials between twenty way
points in sixty seconds, repeated ninety times while the joints warm up (Test 2). The sampling rate
is 500 Hz. This module makes recordings of this kind:

- load torques from gravity, inertia and the coupling of the joints (`arm`), with the kinematics
  and masses that the manufacturer publishes; links are point masses, so loads are approximate;
- friction from `true_friction`, which is not a law of the catalog, with magnitudes like the
  friction torques of the review's figures 6 and 10;
- joint temperatures from one heat capacity and one thermal resistance per joint, heated by
  friction and by the copper losses of the motor;
- currents with correlated noise, quantised by the converter; positions quantised by the encoder
  of the motor; velocities as differences of positions.

Motor constants and friction are plausible for motors and strain-wave gears of these sizes; they
are not measurements of a UR5e.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from functools import cached_property

import numpy as np
import polars as pl
import scipy
from numpy.typing import NDArray

from stribeck.base.errors import SpecError
from stribeck.fitting.energy import Motor, electrical_power
from stribeck.motion.generate.arm import Arm
from stribeck.motion.generate.trajectory import (
    Limits,
    Trajectory,
    quintic_trajectory,
    trapezoidal_trajectory,
    way_points,
)
from stribeck.motion.generate.true_friction import TrueFriction

Array = NDArray[np.float64]

JOINTS = ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")
TESTS = {1: "trapezoidal", 2: "quintic"}
#: Rate of the controller, Hz, and the cycles of Test 2.
RATE = 500.0
REPEATS = 90
CYCLE_SECONDS = 60.0
DWELL = 0.25
LIMITS = Limits(speed=math.pi, acceleration=4.0)
ROOM_TEMPERATURE = 24.0
#: Encoder steps per motor turn.
ENCODER_STEPS = 8192
#: Steps of the current converter, A, and of the temperature sensor, K.
CURRENT_STEP = 0.002
TEMPERATURE_STEP = 0.0625
TEMPERATURE_NOISE = 0.05
#: Correlation of the current noise from one sample at `RATE` to the next.
NOISE_MEMORY = 0.5

#: Kinematics, masses [kg] and centres of mass [m] as Universal Robots publishes them.
UR5E = Arm(
    length=np.array([0.0, -0.425, -0.3922, 0.0, 0.0, 0.0]),
    offset=np.array([0.1625, 0.0, 0.0, 0.1333, 0.0997, 0.0996]),
    twist=np.array([math.pi / 2, 0.0, 0.0, math.pi / 2, -math.pi / 2, 0.0]),
    mass=np.array([3.761, 8.058, 2.846, 1.37, 1.3, 0.365]),
    centre=np.array(
        [
            [0.0, -0.02561, 0.00193],
            [0.2125, 0.0, 0.11336],
            [0.15, 0.0, 0.0265],
            [0.0, -0.0018, 0.01634],
            [0.0, 0.0018, 0.01634],
            [0.0, 0.0, -0.001159],
        ]
    ),
    rotor_inertia=np.array([0.7, 0.7, 0.7, 0.1, 0.1, 0.1]),
)
#: Range of the way points, rad.
LOWEST = np.array([-2.4, -2.6, -2.2, -2.4, -2.4, -2.4])
HIGHEST = np.array([2.4, -0.5, 2.2, 2.4, 2.4, 2.4])


@dataclass(frozen=True)
class Drive:
    """Motor, gear, friction and thermal constants of a joint.

    Attributes
    ----------
    motor
        Constants of the review's eqs 1 and 7.
    friction
        True friction of the joint.
    current_noise
        RMS of the current noise, A.
    heating
        Steady-state rise of the joint's temperature per power loss, K/W.
    warm_up
        Time constant of that rise, s.
    """

    motor: Motor
    friction: TrueFriction
    current_noise: float
    heating: float
    warm_up: float


_LARGE = Drive(
    motor=Motor(km=0.11, kb=0.12, kt=0.12, gear_ratio=100.0),
    friction=TrueFriction(
        coulomb=9.0,
        stribeck_rise=0.3,
        stribeck_velocity=0.12,
        shear=15.0,
        shear_velocity=1.1,
        thinning=700.0,
        dry_cooling=0.004,
        load_share=0.2,
        load_scale=30.0,
        asymmetry=0.06,
        slips=(0.15e-3, 0.5e-3, 1.5e-3, 4e-3),
        shares=(0.35, 0.3, 0.2, 0.15),
    ),
    current_noise=0.05,
    heating=2.0,
    warm_up=1500.0,
)
_SMALL = Drive(
    motor=Motor(km=0.05, kb=0.1, kt=0.1, gear_ratio=100.0),
    friction=TrueFriction(
        coulomb=1.9,
        stribeck_rise=0.35,
        stribeck_velocity=0.1,
        shear=3.2,
        shear_velocity=0.9,
        thinning=750.0,
        dry_cooling=0.004,
        load_share=0.25,
        load_scale=5.0,
        asymmetry=0.05,
        slips=(0.2e-3, 0.7e-3, 2e-3, 5e-3),
        shares=(0.35, 0.3, 0.2, 0.15),
    ),
    current_noise=0.02,
    heating=5.5,
    warm_up=1200.0,
)


def _drives(rng: np.random.Generator) -> tuple[Drive, ...]:
    """Three large and three small joints, each with different friction."""
    drives = []
    for kind in (_LARGE, _LARGE, _LARGE, _SMALL, _SMALL, _SMALL):
        f = kind.friction
        spread = rng.uniform(0.85, 1.15, 6)
        drives.append(
            replace(
                kind,
                friction=replace(
                    f,
                    coulomb=f.coulomb * spread[0],
                    stribeck_rise=f.stribeck_rise * spread[1],
                    shear=f.shear * spread[2],
                    shear_velocity=f.shear_velocity * spread[3],
                    load_share=f.load_share * spread[4],
                    asymmetry=f.asymmetry * spread[5] * rng.choice([-1.0, 1.0]),
                ),
            )
        )
    return tuple(drives)


@dataclass(frozen=True)
class RobotRecording:
    """The recording of an arm like a UR5e; rows are generated on demand.

    Parameters
    ----------
    test
        1: trapezoidal speed profiles, one cycle. 2: quintic polynomials, sixty seconds per cycle.
    seed
        Seed of way points, friction and noise.
    repeats
        Number of cycles; 90 for Test 2 in the review.
    every
        Record one cycle out of this number; the arm also warms up in the others.
    rate
        Sample rate, Hz: 500, or 500 divided by a whole number.

    Raises
    ------
    SpecError
        A size out of range.

    Examples
    --------
    >>> made = RobotRecording(test=2, repeats=2, rate=50.0)
    >>> made.rows, made.joint_frame("elbow").columns[:4]
    (36000, ['joint', 'run', 'time', 'position'])
    """

    test: int = 2
    seed: int = 0
    repeats: int = REPEATS
    every: int = 1
    rate: float = RATE

    def __post_init__(self) -> None:
        if self.test not in TESTS:
            raise SpecError(f"test {self.test} is unknown: 1 (trapezoidal) or 2 (quintic)")
        if self.seed < 0:
            raise SpecError(f"seed {self.seed} is negative: give 0 or more")
        if not 1 <= self.repeats <= 10_000:
            raise SpecError(f"{self.repeats} repeats are out of range: give 1 to 10000")
        if not 1 <= self.every <= self.repeats:
            raise SpecError(
                f"recording every {self.every} cycles of {self.repeats} is out of range: give 1 to "
                f"{self.repeats}"
            )
        if not 1.0 <= self.rate <= RATE or not float(RATE / self.rate).is_integer():
            raise SpecError(
                f"a rate of {self.rate:g} Hz cannot be taken from {RATE:g} Hz: give {RATE:g} Hz "
                f"divided by a whole number, such as 250, 100 or 50"
            )

    @cached_property
    def drives(self) -> tuple[Drive, ...]:
        """The joints' motors and their friction, from the seed."""
        return _drives(np.random.default_rng([self.seed, 1]))

    @cached_property
    def trajectory(self) -> Trajectory:
        """One cycle of the motion, from the seed."""
        rng = np.random.default_rng([self.seed, 2])
        if self.test == 1:
            # Far enough apart to reach the largest speed.
            points = way_points(
                rng, LOWEST, HIGHEST, 6, 1.1 * LIMITS.speed**2 / LIMITS.acceleration
            )
            return trapezoidal_trajectory(points, LIMITS, DWELL)
        points = way_points(rng, LOWEST, HIGHEST, 20, 0.5)
        closed = np.concatenate([points, points[:1]])
        return quintic_trajectory(rng, closed, LIMITS, DWELL, CYCLE_SECONDS)

    @property
    def rows(self) -> int:
        """Number of rows of the recording, over all joints."""
        return len(self._recorded) * self._cycle_rows * len(JOINTS)

    @property
    def _recorded(self) -> range:
        return range(0, self.repeats, self.every)

    @property
    def _samples(self) -> int:
        """Samples of a cycle at the controller's rate."""
        return math.ceil(self.trajectory.seconds * RATE - 1e-6)

    @property
    def _stride(self) -> int:
        return round(RATE / self.rate)

    @property
    def _cycle_rows(self) -> int:
        return -(-self._samples // self._stride)

    @cached_property
    def _motion(self) -> tuple[Array, Array, Array]:
        return self.trajectory(np.arange(self._samples) / RATE)

    @cached_property
    def _load(self) -> Array:
        return UR5E.load_torque(*self._motion)

    def joint_frame(self, joint: str) -> pl.DataFrame:
        """All recorded cycles of one joint, one after another."""
        return pl.concat(self.cycles(joint))

    def cycles(self, joint: str) -> Iterator[pl.DataFrame]:
        """The recorded cycles of one joint.

        Yields
        ------
        polars.DataFrame
            ``joint``, ``run`` (the cycle, from 1), ``time`` [s], ``position`` [rad], ``velocity``
            [rad/s], ``current`` [A], ``load_torque`` [N m], ``temperature`` [degC].
        """
        k = JOINTS.index(joint)
        drive = self.drives[k]
        position, velocity, load = (part[:, k] for part in (*self._motion[:2], self._load))
        clock = np.arange(self._samples) / RATE
        temperature = ROOM_TEMPERATURE
        deflections: tuple[float, ...] = (0.0,) * len(drive.friction.slips)
        for cycle in range(self.repeats):
            settled = _heated(drive, temperature, load, velocity)
            along = settled + (temperature - settled) * np.exp(-clock / drive.warm_up)
            torque, deflections = drive.friction.torque(
                position, velocity, along, load, deflections
            )
            temperature = float(along[-1])
            if cycle in self._recorded:
                rng = np.random.default_rng([self.seed, 3, k, cycle])
                yield self._measured(k, cycle, load + torque, along, rng)

    def _measured(
        self, k: int, cycle: int, torque: Array, temperature: Array, rng: np.random.Generator
    ) -> pl.DataFrame:
        """One cycle as the sensors measure it."""
        drive, motor = self.drives[k], self.drives[k].motor
        clock = np.arange(self._samples) / RATE
        position = _stepped(
            self._motion[0][:, k], 2.0 * math.pi / (ENCODER_STEPS * motor.gear_ratio)
        )
        noise = _current_noise(rng, drive.current_noise, clock.size)
        current = _stepped(torque / (motor.gear_ratio * motor.kt) + noise, CURRENT_STEP)
        sensed = temperature + TEMPERATURE_NOISE * rng.standard_normal(clock.size)
        return pl.DataFrame(
            {
                "time": cycle * self._samples / RATE + clock,
                "position": position,
                "velocity": np.diff(position, prepend=position[0]) * RATE,
                "current": current,
                "load_torque": self._load[:, k],
                "temperature": _stepped(sensed, TEMPERATURE_STEP),
            }
        )[:: self._stride].select(
            pl.lit(JOINTS[k]).alias("joint"), pl.lit(cycle + 1).alias("run"), pl.all()
        )

    def truth(self) -> dict[str, object]:
        """True friction of the recording, and how it was generated, as JSON."""
        return {
            "robot": "ur5e",
            "test": self.test,
            "motion": TESTS[self.test],
            "seed": self.seed,
            "repeats": self.repeats,
            "every": self.every,
            "rate_hz": self.rate,
            "cycle_s": self._samples / RATE,
            "rows": self.rows,
            "joints": {
                joint: {
                    "motor": asdict(drive.motor),
                    "friction": asdict(drive.friction),
                    "current_noise_A": drive.current_noise,
                    "torque_noise_Nm": drive.current_noise
                    * drive.motor.kt
                    * drive.motor.gear_ratio,
                    "heating_K_per_W": drive.heating,
                    "warm_up_s": drive.warm_up,
                }
                for joint, drive in zip(JOINTS, self.drives, strict=True)
            },
        }

    def sidecar_text(self) -> str:
        """The sidecar: joint kind, and each joint's gear ratio and motor constants."""
        lines = ['kind = "recording"', 'joint_kind = "revolute"']
        for joint, drive in zip(JOINTS, self.drives, strict=True):
            m = drive.motor
            lines += ["", f"[joints.{joint}]", f"gear_ratio = {m.gear_ratio}"]
            lines += [f"torque_constant = {m.kt}", f"km = {m.km}", f"kb = {m.kb}", f"kt = {m.kt}"]
        return "\n".join(lines) + "\n"


def _heated(drive: Drive, temperature: float, load: Array, velocity: Array) -> float:
    """Steady-state temperature in degC if every cycle had the power loss of this one."""
    still = np.full_like(velocity, temperature)
    friction = np.sign(velocity) * drive.friction.dry(velocity, still, load)
    friction = friction + drive.friction.viscous(velocity, still)
    motor_torque = load + friction
    shaft_power = motor_torque * velocity
    copper = electrical_power(motor_torque, velocity, drive.motor) - shaft_power
    lost = float(np.mean(copper + friction * velocity))
    return ROOM_TEMPERATURE + drive.heating * lost


def _stepped(values: Array, step: float) -> Array:
    return np.round(values / step) * step


def _current_noise(rng: np.random.Generator, level: float, count: int) -> Array:
    """Noise [n] of RMS `level`, correlated over a few samples."""
    drive = level * math.sqrt(1.0 - NOISE_MEMORY**2)
    white = drive * rng.standard_normal(count + 50)
    return np.asarray(scipy.signal.lfilter([1.0], [1.0, -NOISE_MEMORY], white)[50:])
