"""Identification as in the papers.

=============== ================================================ ===========================
what            how                                              source
=============== ================================================ ===========================
``fit``         root mean square, bounds, 20 random starts       UR5e review 2024/25, eqs 4-5
``grid_fit``    linear regression inside a grid, absolute error  Bittencourt 2010, eqs 5-6
=============== ================================================ ===========================

`averaged_points` (Bittencourt 2010, eq 4) and `segment_points` (Gantry, section 3) turn a
recording into steady-state friction points, on which a model is then fitted.
"""

from __future__ import annotations

from stribeck.methods.averaging import averaged_points
from stribeck.methods.segments import segment_points
from stribeck.methods.steady import SteadyPoint, SteadyPoints
from stribeck.methods.stretches import Line, Search, constant_speed

__all__ = [
    "Line",
    "Search",
    "SteadyPoint",
    "SteadyPoints",
    "averaged_points",
    "constant_speed",
    "segment_points",
]
