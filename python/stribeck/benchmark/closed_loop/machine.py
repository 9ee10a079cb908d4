"""The joint, its load and its drive, without hidden effects."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from stribeck.benchmark.draws import log_uniform

#: Control and integration step, s.
STEP = 1e-3
#: Sampling rates, Hz; each sampling period is a whole number of steps.
RATES = (100, 125, 200)


@dataclass(frozen=True)
class Machine:
    """A joint under control.

    Attributes
    ----------
    half, centre
        Half the stroke and its middle.
    vmax, ramp
        Top speed of the reference, and the time in which it is reached.
    inertia, motor_share
        Inertia of motor and link, and the share of the motor.
    gravity, phase
        Largest gravity torque at unit payload, and the angle at which it acts.
    count
        Encoder resolution at the joint side.
    speed_noise
        Noise of the speed sent by the drive, in addition to encoder quantisation.
    cutoff
        Cut-off of both low-pass filters of the channels, 1/s.
    stiffness, damping
        Gains of the position controller.
    """

    kind: str
    half: float
    centre: float
    vmax: float
    ramp: float
    coulomb: float
    viscous: float
    inertia: float
    motor_share: float
    gravity: float
    phase: float
    count: float
    speed_noise: float
    cutoff: float
    stiffness: float
    damping: float
    rate: int

    def gravity_torque(self, q: np.ndarray, payload: np.ndarray) -> np.ndarray:
        """Torque of the payload; constant along a vertical prismatic axis."""
        if self.kind == "prismatic":
            return payload * self.gravity + 0.0 * q
        return np.asarray(payload * self.gravity * np.cos(q + self.phase))


def draw_machine(rng: np.random.Generator, effects: Collection[str]) -> Machine:
    """Draw a joint with magnitudes over decades on which the hidden effects are visible."""
    turns = {"gravity", "backlash", "elasticity"} & set(effects)
    kind = "prismatic" if rng.random() < 0.15 and not turns else "revolute"
    half = log_uniform(rng, 0.6, 1.8) if kind == "revolute" else log_uniform(rng, 0.08, 0.4)
    if kind == "revolute" and {"gravity", "spring"} & set(effects):
        half = float(rng.uniform(1.4, 2.2))
    vmax = half * log_uniform(rng, 0.8, 2.5)
    ramp = float(rng.uniform(0.18, 0.35))
    coulomb = log_uniform(rng, 0.05, 80.0)
    shares = {"temperature_viscous": (0.8, 1.6), "nonlinear_viscous": (1.2, 2.4)}
    low, high = next((shares[e] for e in shares if e in effects), (0.35, 1.5))
    inertia = coulomb * ramp / vmax * log_uniform(rng, 0.6, 2.0)
    if {"delay", "backlash", "elasticity"} & set(effects):
        inertia *= 2.0
    centre = float(rng.uniform(-1.0, 1.0))
    phase = float(rng.uniform(-math.pi, math.pi))
    if "backlash" in effects:
        # Gravity, and so the load torque, changes its sign within the stroke.
        phase = math.pi / 2 - centre + float(rng.uniform(-0.3, 0.3)) * half
    # Enough samples inside the presliding distance must be moving samples; samples whose direction
    # is uncertain because of a delay must not.
    coarser = 0.25 if "presliding" in effects else 3.0 if "delay" in effects else 1.0
    natural = 2 * math.pi * float(rng.uniform(5.0, 9.0))
    return Machine(
        kind=kind,
        half=half,
        centre=centre,
        vmax=vmax,
        ramp=ramp,
        coulomb=coulomb,
        viscous=coulomb * log_uniform(rng, low, high) / vmax,
        inertia=inertia,
        motor_share=float(rng.uniform(0.35, 0.65)),
        gravity=coulomb * log_uniform(rng, 0.8, 3.0),
        phase=phase,
        count=half / 2.0 ** int(rng.integers(22, 24)),
        speed_noise=vmax * log_uniform(rng, 8e-4, 1.6e-3) * coarser,
        cutoff=2 * math.pi * float(rng.uniform(110.0, 180.0)),
        stiffness=inertia * natural**2,
        damping=2 * float(rng.uniform(0.7, 1.0)) * inertia * natural,
        rate=int(rng.choice(RATES)),
    )
