"""Joints in motion: a friction model on an inertia, in open or closed loop.

`simulate` moves it; `Joint` says what is moved, `Torque`, `Follow` or `Pull` by what.
"""

from stribeck.simulate.drive import Controller, Drive, Follow, Pull, Torque
from stribeck.simulate.joint import Joint
from stribeck.simulate.result import Simulation
from stribeck.simulate.run import simulate
from stribeck.simulate.trajectory import Fourier, Quintic, Trajectory, Trapezoid

__all__ = [
    "Controller",
    "Drive",
    "Follow",
    "Fourier",
    "Joint",
    "Pull",
    "Quintic",
    "Simulation",
    "Torque",
    "Trajectory",
    "Trapezoid",
    "simulate",
]
