"""Joints in motion: a friction model on an inertia, in open or closed loop.

`simulate` moves it; `Joint` says what is moved, `Torque`, `Follow` or `Pull` by what. `validate`
holds a simulated motion against a measured one.
"""

from stribeck.simulate.arm import ArmMotion, PlanarArm, simulate_arm
from stribeck.simulate.drive import Controller, Drive, Follow, Pull, Torque
from stribeck.simulate.joint import Joint, Transmission
from stribeck.simulate.result import Simulation
from stribeck.simulate.run import simulate
from stribeck.simulate.trajectory import Fourier, Quintic, Sampled, Trajectory, Trapezoid
from stribeck.simulate.validation import Growth, Validation, validate, validate_closed_loop

__all__ = [
    "ArmMotion",
    "Controller",
    "Drive",
    "Follow",
    "Fourier",
    "Growth",
    "Joint",
    "PlanarArm",
    "Pull",
    "Quintic",
    "Sampled",
    "Simulation",
    "Torque",
    "Trajectory",
    "Transmission",
    "Trapezoid",
    "Validation",
    "simulate",
    "simulate_arm",
    "validate",
    "validate_closed_loop",
]
