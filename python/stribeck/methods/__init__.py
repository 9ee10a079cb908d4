"""Identification as in the papers.

=================== ================================================== ========================
what                how                                                source
=================== ================================================== ========================
`stribeck.fit`      root mean square error, bounds, 20 random starts   UR5e review, eqs 4-5
`grid_fit`          regression inside a grid, least absolute error     Bittencourt, eqs 5-6
`averaged_points`   half the difference of forward and backward passes Bittencourt, eqs 3-4
`segment_points`    means over constant-speed stretches                Gantry, section 3
`three_step_fit`    temperature, load and presliding one after another Tadese, section V-A
`arm_fit`           inertia and friction of a planar two-joint arm     Indri, section 4.2
=================== ================================================== ========================

`averaged_points` and `segment_points` turn a recording into steady-state friction points, on which
a law is then fitted.
"""

from __future__ import annotations

from stribeck.methods.arm import ArmFit, arm_fit
from stribeck.methods.averaging import averaged_points
from stribeck.methods.grid import Axis, grid_fit
from stribeck.methods.segments import segment_points
from stribeck.methods.steady import SteadyPoint, SteadyPoints
from stribeck.methods.stretches import Line, Search, constant_speed
from stribeck.methods.three_step import Step, ThreeStepFit, three_step_fit
from stribeck.methods.trajectory import FOUR_HARMONICS, HarmonicTrajectory

__all__ = [
    "FOUR_HARMONICS",
    "ArmFit",
    "Axis",
    "HarmonicTrajectory",
    "Line",
    "Search",
    "SteadyPoint",
    "SteadyPoints",
    "Step",
    "ThreeStepFit",
    "arm_fit",
    "averaged_points",
    "constant_speed",
    "grid_fit",
    "segment_points",
    "three_step_fit",
]
