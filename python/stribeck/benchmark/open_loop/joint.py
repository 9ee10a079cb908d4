"""The joint without hidden effects: size, friction, inertia and gravity."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stribeck.benchmark.draws import log_uniform


@dataclass
class SimulatedJoint:
    """The joint without hidden effects."""

    kind: str
    coulomb: float
    viscous: float
    vmax: float
    amax: float
    half: float
    centre: float
    inertia: float
    gravity: float
    phase: float
    spring: float


def draw_joint(
    rng: np.random.Generator, effects: Sequence[str], limit: str | None
) -> SimulatedJoint:
    """Draw a joint with magnitudes over decades; revolute for gravity and one-way rotation."""
    kind = "prismatic" if rng.random() < 0.15 else "revolute"
    if "gravity" in effects or limit in ("one_direction", "short_range"):
        kind = "revolute"
    coulomb = log_uniform(rng, 0.05, 100.0)
    half = log_uniform(rng, 0.8, 2.6) if kind == "revolute" else log_uniform(rng, 0.1, 0.5)
    if "gravity" in effects:
        half = rng.uniform(1.8, 2.8)
    if limit == "short_range":
        half = rng.uniform(0.04, 0.07)
    vmax = half * log_uniform(rng, 0.6, 2.5)
    amax = vmax * rng.uniform(2.5, 6.0)
    heavy = 2.0 if "delay" in effects else 1.0
    gravity = coulomb * heavy * log_uniform(rng, 0.8, 3.5)
    inertia = coulomb / amax * log_uniform(rng, 0.4, 1.8)
    spring = gravity / half * rng.uniform(0.3, 0.8) if kind == "prismatic" else 0.0
    if limit == "constant_load":
        inertia, spring = 0.0, 0.0
    if "presliding" in effects:
        vmax, amax = vmax * 1.5, amax * 1.5
    if "delay" in effects:
        inertia, amax = inertia * 2, amax * 0.5
    rate_share = rng.uniform(0.35, 1.0) if "delay" in effects else log_uniform(rng, 0.35, 1.8)
    if "temperature_viscous" in effects:
        rate_share = max(rate_share, 0.7)
    if "nonlinear_viscous" in effects:
        rate_share = rng.uniform(1.3, 2.5)
    return SimulatedJoint(
        kind=kind,
        coulomb=coulomb,
        viscous=coulomb * rate_share / vmax,
        vmax=vmax,
        amax=amax,
        half=half,
        centre=float(rng.uniform(-0.6, 0.6) * half),
        inertia=inertia,
        gravity=gravity,
        phase=float(rng.uniform(-math.pi, math.pi)),
        spring=spring,
    )
