"""A servo with a pendulum, simulated here and by BAM (Duclusaud et al. 2024), friction model M6.

BAM is read from a checkout of its repository; nothing of it is kept here. Both simulate the same
closed loop: a sampled proportional controller of the voltage and a motor with back-EMF, with the
parameters that BAM gives for this servo.
"""

from __future__ import annotations

import subprocess
import sys
from argparse import ArgumentTypeError
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np
import stribeck as sb
from stribeck.motion.simulate.drive import Controller, Follow
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.result import Simulation
from stribeck.motion.simulate.run import simulate
from timing import line, medians

SERVO = "xl330"
TRAJECTORY = "sin_sin"
#: Of BAM's recordings of this servo: mass (kg) at the end of a rod (m), gain, supply (V).
PENDULUM = {"mass": 0.49, "arm_mass": 0.0, "length": 0.1, "kp": 400.0, "vin": 7.5}
#: Time step of its processed logs, s.
STEP = 0.005
#: Largest difference of position (share of the motion) at `STEP`, and how much of it may be left at
#: a `FINER`th of the step: BAM's integrator is of first order.
APART = 0.01
FINER = 16
LEFT = 2.0 / FINER

#: Names of the parameters of `bam_m6` in BAM's files.
NAMES = {
    "coulomb_friction": "friction_base",
    "stribeck_height": "friction_stribeck",
    "external_coulomb": "load_friction_external",
    "motor_coulomb": "load_friction_motor",
    "external_stribeck": "load_friction_external_stribeck",
    "motor_stribeck": "load_friction_motor_stribeck",
    "external_quadratic": "load_friction_external_quad",
    "motor_quadratic": "load_friction_motor_quad",
    "stribeck_velocity": "dtheta_stribeck",
    "stribeck_exponent": "alpha",
    "viscous_friction": "friction_viscous",
}


def checkout(text: str) -> Path:
    """A folder that holds BAM, from the command line."""
    folder = Path(text)
    if not (folder / "bam" / "simulate.py").is_file():
        raise ArgumentTypeError(f"{folder} holds no bam/simulate.py: give a checkout of Rhoban/bam")
    return folder


def bam(folder: Path) -> ModuleType:
    """BAM's packages."""
    sys.path.insert(0, str(folder))
    import bam.model
    import bam.simulate
    import bam.trajectory

    return bam


def version(folder: Path) -> str:
    """Commit of the checkout, or nothing where it is no repository."""
    said = subprocess.run(
        ["git", "-C", folder, "rev-parse", "--short=9", "HEAD"],
        capture_output=True,
        text=True,
        check=False,
    )
    return said.stdout.strip()


@dataclass(frozen=True)
class Desired:
    """BAM's trajectory; its velocity is not used by the controller."""

    at: np.ndarray
    step: float
    duration: float

    def __call__(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Position (rad) at `time` [n] (s), and zeros."""
        still = np.zeros_like(time)
        return self.at[np.rint(time / self.step).astype(np.intp)], still, still


class Servo:
    """The same closed loop for both simulators."""

    def __init__(self, package: ModuleType, step: float) -> None:
        self.model = package.model.load_model(motor_name=SERVO, model="m6")
        # An error of the mounting, which is no part of a simulated pendulum.
        self.model.q_offset.value = 0.0
        self.simulator = package.simulate.Simulator(self.model)
        trajectory = package.trajectory.trajectories[TRAJECTORY]
        steps = round(trajectory.duration / step)
        goal = np.array([trajectory(k * step)[0] for k in range(steps)])
        entries = [{"position": 0.0, "goal_position": at, "torque_enable": True} for at in goal]
        self.log = {**PENDULUM, "dt": step, "entries": entries}
        self.step = step
        self.friction = sb.model(
            "bam_m6", **{ours: getattr(self.model, name).value for ours, name in NAMES.items()}
        )
        self.joint, self.drive = self._joint(), self._drive(goal, trajectory.duration)

    def _joint(self) -> Joint:
        self.model.actuator.load_log(self.log)
        bench = self.model.actuator.testbench
        return Joint.revolute(
            bench.compute_mass(0.0, 0.0) + self.model.actuator.get_extra_inertia(),
            gravity_sin=-bench.compute_bias(np.pi / 2.0, 0.0),
        )

    def _drive(self, goal: np.ndarray, duration: float) -> Follow:
        """`kt/R (vin gain (qd - q) - kt v)`: both parts sampled, as in BAM."""
        actuator = self.model.actuator
        torque_per_volt = self.model.kt.value / self.model.R.value
        stiffness = torque_per_volt * actuator.vin * actuator.kp * actuator.error_gain
        damping = torque_per_volt * self.model.kt.value
        controller = Controller(stiffness, damping, velocity_weight=0.0)
        return Follow(Desired(goal, self.step, duration), controller)

    def theirs(self) -> tuple[list[float], list[float], list[float]]:
        """Positions (rad), velocities (rad/s) and voltages at the start of each step."""
        return self.simulator.rollout_log(self.log, simulate_control=True)

    def ours(self, seconds: float | None = None) -> Simulation:
        """The same motion, here, or the first seconds of it."""
        return simulate(
            self.friction,
            self.joint,
            self.drive,
            seconds=seconds,
            step=self.step,
            position=0.0,
            velocity=0.0,
        )

    def one_step(self) -> Simulation:
        """The first step: what a call takes."""
        return self.ours(self.step)


def apart(servo: Servo) -> float:
    """Largest difference of position between both, as a share of the motion."""
    positions, _, voltages = servo.theirs()
    supply = servo.model.actuator.vin
    assert np.abs(voltages).max() < supply, "the voltage saturates: that is not what is compared"
    theirs = np.array(positions)
    ours = servo.ours().instant_position[:-1]
    return float(np.abs(theirs - ours).max() / np.ptp(ours))


def compare_simulators(folder: Path) -> None:
    """Check that both give the same motion, then print their times."""
    package = bam(folder)
    servo, finer = Servo(package, STEP), Servo(package, STEP / FINER)
    coarse, fine = apart(servo), apart(finer)
    assert coarse < APART, f"{coarse:.3g} of the motion apart"
    assert fine < LEFT * coarse, f"{fine:.3g} of the motion apart at a step {FINER} times finer"
    steps = len(servo.log["entries"])
    mine, other = line(
        f"bam_m6 with a pendulum in closed loop, 1 log, {steps} steps",
        f"BAM simulator, M6 ({version(folder)})",
        servo.ours,
        servo.theirs,
        25,
    )
    _, call = medians(servo.ours, servo.one_step, 25)
    print(
        f"  {steps / mine:.3g} steps/s here, {steps / other:.3g} by BAM; here a call of one step "
        f"takes {1e3 * call:.2g} ms, the others {1e6 * (mine - call) / (steps - 1):.2g} µs each; "
        f"positions {coarse:.2%} of the motion apart, {fine:.3%} at a step {FINER} times finer"
    )
