"""Friction laws with a memory as differential equations, solved by SciPy's Radau.

Each law is the rate of its state and the torque, written from the papers and not from the
stepping formulas of the core. Symbols and letters are those of `reference`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
Rate = Callable[[Array, float, Any, Any], Array]


@dataclass(frozen=True)
class Dynamic:
    """A law with a memory.

    Attributes
    ----------
    rate
        ``rate(z, v, p, x) -> dz/dt``: state, velocity, parameters, other inputs and constants.
    torque
        ``torque(z, dz, v, p, x)``.
    dry, stiffness
        ``dry(v, p, x)``: the dry magnitude; ``stiffness(p)``: torque per deflection. The
        deflection is measured in ``dry/stiffness``.
    damping
        ``damping(v, p, x)``: torque per deflection rate.
    """

    rate: Rate
    torque: Callable[[Array, Array, float, Any, Any], float]
    dry: Callable[[float, Any, Any], float]
    stiffness: Callable[[Any], float]
    damping: Callable[[float, Any, Any], float] = field(default=lambda v, p, x: 0.0)
    states: Callable[[Any], int] = field(default=lambda x: 1)


DYNAMIC: dict[str, Dynamic] = {}


def _stribeck(v: float, speed: float, exponent: float) -> float:
    return float(np.exp(-(np.abs(v / speed) ** exponent)))


def _bristle(
    dry: Callable[[float, Any, Any], float],
    stiffness: Callable[[Any], float],
    damping: Callable[[float, Any, Any], float],
    rest: Callable[[float, Any, Any], float],
) -> Dynamic:
    """dz/dt = v - s0 |v|/D z, tf = s0 z + s1 dz/dt + rest (Canudas de Wit et al. 1995)."""

    def rate(z: Array, v: float, p: Any, x: Any) -> Array:
        return np.array([v]) if v == 0 else v - stiffness(p) * abs(v) / dry(v, p, x) * z

    def torque(z: Array, dz: Array, v: float, p: Any, x: Any) -> float:
        return float(stiffness(p) * z[0] + damping(v, p, x) * dz[0] + rest(v, p, x))

    return Dynamic(rate, torque, dry, stiffness, damping)


DYNAMIC["lugre"] = _bristle(
    dry=lambda v, p, x: p.a4 + (p.a5 - p.a4) * _stribeck(v, p.a6, p.a7),
    stiffness=lambda p: p.a1,
    damping=lambda v, p, x: p.a2,
    rest=lambda v, p, x: p.a3 * v,
)


def _thinning(v: float, p: Any, x: Any) -> float:
    """Viscous part of tadese_t: sgn v (a6 + a7 T) (1 - exp(-|(a8 + a9 T) v|^(a10 + a11 T)))."""
    if v == 0:
        return 0.0
    with np.errstate(over="ignore", divide="ignore"):
        y = np.float64(abs((p.a8 + p.a9 * x.T) * v)) ** (p.a10 + p.a11 * x.T)
    return float(-np.sign(v) * (p.a6 + p.a7 * x.T) * np.expm1(-y))


DYNAMIC["tadese_t"] = _bristle(
    dry=lambda v, p, x: p.a3 + (p.a4 - p.a3) * _stribeck(v, p.a5, 2),
    stiffness=lambda p: p.a1,
    damping=lambda v, p, x: p.a2,
    rest=_thinning,
)


def _quadrant(v: float, x: Any) -> int:
    """1 to 4 for (v, tl) = ++, -+, --, +-; 0 at rest or without load (Tadese et al., figure 3)."""
    return {(1, 1): 1, (-1, 1): 2, (-1, -1): 3, (1, -1): 4}.get(
        (int(np.sign(v)), int(np.sign(x.tl))), 0
    )


def _by_direction(p: Any, name: str, v: float) -> float:
    return float(getattr(p, f"{name}_plus" if v > 0 else f"{name}_minus"))


def _four_quadrants(v: float, p: Any, x: Any) -> float:
    """Tadese et al. 2021, eqs 13 (with the sign that friction needs) and 15."""
    if v == 0:
        return 0.0
    level = _by_direction(p, "s20", v) + _by_direction(p, "s2T", v) * x.T
    speed = _by_direction(p, "s30", v) + _by_direction(p, "s3T", v) * x.T
    viscous = np.sign(v) * level * (1 - np.exp(-abs(v / speed)))
    i = _quadrant(v, x)
    if i == 0:
        return float(viscous)
    g1, g2, g3, l1, l2 = (getattr(p, f"{name}_{i}") for name in ("g1", "g2", "g3", "l1", "l2"))
    return float(viscous + g1 * (1 - np.exp(-abs(g2 * v))) + g3 + (l1 + l2 * v) * x.tl)


DYNAMIC["tadese_full"] = _bristle(
    dry=lambda v, p, x: _by_direction(p, "Fc", v),
    stiffness=lambda p: p.s0,
    damping=lambda v, p, x: float(p.s1 * np.exp(-abs(v / p.vd))),
    rest=_four_quadrants,
)


def _xiao_load(v: float, p: Any, x: Any) -> float:
    """A coefficient per quadrant on |tl|, after the review, section 2.2."""
    i = _quadrant(v, x)
    return float(p.s2 * v + (np.sign(v) * getattr(p, f"l_{i}") * abs(x.tl) if i else 0.0))


DYNAMIC["xiao"] = _bristle(
    dry=lambda v, p, x: p.Fc + (p.Fs - p.Fc) * _stribeck(v, p.vs, 2),
    stiffness=lambda p: p.s0,
    damping=lambda v, p, x: p.s1,
    rest=_xiao_load,
)


def _dahl_rate(z: Array, v: float, p: Any, x: Any) -> Array:
    u = 1 - np.sign(v) * p.a1 * z / p.a2
    return v * np.sign(u) * np.abs(u) ** p.a3


DYNAMIC["dahl"] = Dynamic(
    rate=_dahl_rate,
    torque=lambda z, dz, v, p, x: float(p.a1 * z[0]),
    dry=lambda v, p, x: p.a2,
    stiffness=lambda p: p.a1,
)


def _indri_signs(v: float, p: Any) -> tuple[float, float]:
    s0 = 2 / np.pi * np.arctan(p.a5 * v)
    return s0, s0 * v


def _indri_dry(v: float, p: Any, x: Any) -> float:
    _, s1 = _indri_signs(v, p)
    return float(p.a6 + p.a7 * 2 / np.pi * np.arctan(s1 * p.a8))


def _indri_rate(z: Array, v: float, p: Any, x: Any) -> Array:
    s0, s1 = _indri_signs(v, p)
    return s0**2 * v - p.a1 * s1 / _indri_dry(v, p, x) * z


def _indri_damping(v: float, p: Any, x: Any) -> float:
    """Infinite at rest without acceleration, where the bristle stands still."""
    scaled = x.a * x.largest_velocity / x.largest_acceleration
    motion = np.sqrt(p.a3 * scaled**2 + v**2)
    return float(p.a2 / motion + p.a4) if motion else 0.0


def _indri_torque(z: Array, dz: Array, v: float, p: Any, x: Any) -> float:
    s0, _ = _indri_signs(v, p)
    viscous = p.a9 * v + p.a10 * v**2 * s0
    return float(p.a1 * z[0] + _indri_damping(v, p, x) * dz[0] + viscous)


DYNAMIC["indri_b"] = Dynamic(_indri_rate, _indri_torque, _indri_dry, lambda p: p.a1, _indri_damping)


@dataclass(frozen=True)
class Motion:
    """Velocity held over each step, and the other inputs likewise.

    Attributes
    ----------
    dt, velocity : arrays [n]
        Steps in s and the velocity held over each.
    others : arrays [n] by letter
        Temperature, load, acceleration ...
    """

    dt: Array
    velocity: Array
    others: Mapping[str, Array]

    def inputs(self, k: int, constants: Mapping[str, float]) -> SimpleNamespace:
        """What the law sees in step `k` besides the velocity."""
        row = {name: float(column[k]) for name, column in self.others.items()}
        return SimpleNamespace(**row, **constants)


@dataclass(frozen=True)
class Solution:
    """Torque at the end of each step and the size of an error that the solver may make there."""

    torque: Array
    size: Array


def solve(
    law: Dynamic,
    parameters: Mapping[str, float],
    motion: Motion,
    constants: Mapping[str, float] | None = None,
    start: Sequence[float] | None = None,
) -> Solution:
    """Radau with rtol 1e-11 and atol 1e-9 of the largest deflection, restarted at each step.

    `Solution.size` is what an error of one whole largest deflection, ``max(D)/s0``, makes of the
    torque: ``max(D) (1 + s1 |v|/D)``, because the damping sees the rate, which errs by
    ``s0 |v|/D`` of the deflection.
    """
    p, fixed = SimpleNamespace(**parameters), dict(constants or {})
    rows = range(motion.velocity.size)
    seen = [motion.inputs(k, fixed) for k in rows]
    speeds = motion.velocity.tolist()
    dry = np.array([law.dry(v, p, x) for v, x in zip(speeds, seen, strict=True)])
    largest = float(np.max(dry))
    z = np.zeros(law.states(p)) if start is None else np.array(start, dtype=float)
    torque, size = np.empty(len(speeds)), np.empty(len(speeds))
    for k, (v, x) in enumerate(zip(speeds, seen, strict=True)):
        if v != 0 and motion.dt[k] > 0:
            solved = solve_ivp(
                lambda t, z, v=v, x=x: law.rate(z, v, p, x),
                (0.0, motion.dt[k]),
                z,
                method="Radau",
                rtol=1e-11,
                atol=1e-9 * largest / law.stiffness(p),
            )
            assert solved.success, solved.message
            z = solved.y[:, -1]
        torque[k] = law.torque(z, law.rate(z, v, p, x), v, p, x)
        size[k] = largest * (1 + law.damping(v, p, x) * abs(v) / dry[k])
    return Solution(torque, size)
