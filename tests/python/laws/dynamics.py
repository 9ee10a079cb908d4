"""Friction laws with a memory as differential equations, solved by SciPy's Radau.

Each law is the rate of its state and the torque, written from the papers and not from the
stepping formulas of the core. Symbols and letters are those of `reference`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
Rate = Callable[[Array, float, Any, Any], Array]
Phase = tuple[Array, Callable[[Array], Array], list[Callable[[Array], float]]]


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
    states
        ``states(p)``: how many numbers the state has, all 0 at the start.
    switches
        ``switches(z, v, p, x) -> (z, rate, events)`` for a law whose elements stick and slip:
        the state as the phase starts, the rate while no element switches, and one function
        ``event(z)`` for each switch, 0 from above where it happens.
    """

    rate: Rate
    torque: Callable[[Array, Array, float, Any, Any], float]
    dry: Callable[[float, Any, Any], float]
    stiffness: Callable[[Any], float]
    damping: Callable[[float, Any, Any], float] = field(default=lambda v, p, x: 0.0)
    states: Callable[[Any], int] = field(default=lambda p: 1)
    switches: Callable[[Array, float, Any, Any], Phase] | None = None


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


def _bliman_rate(z: Array, v: float, p: Any, x: Any) -> Array:
    """Bliman and Sorine 1995, second order: dx/ds = A x + B sgn(v) in the distance s."""
    f1, f2, s = (1 + p.rho) * p.Fc, p.rho * p.Fc, np.sign(v)
    return abs(v) * np.array([(f1 * s - z[0]) / (p.eta * p.eps), -(f2 * s + z[1]) / p.eps])


DYNAMIC["bliman_sorine"] = Dynamic(
    rate=_bliman_rate,
    torque=lambda z, dz, v, p, x: float(z[0] + z[1]),
    dry=lambda v, p, x: (1 + 2 * p.rho) * p.Fc,
    stiffness=lambda p: 1.0,
    states=lambda p: 2,
)


def _elastoplastic_dry(v: float, p: Any, x: Any) -> float:
    return float(p.Fc + (p.Fs - p.Fc) * _stribeck(v, p.vs, 2))


def _elastoplastic_rate(z: Array, v: float, p: Any, x: Any) -> Array:
    """Dupont et al. 2002, eqs 8-14: purely elastic up to the breakaway deflection."""
    if v == 0:
        return np.zeros(1)
    largest = _elastoplastic_dry(v, p, x) / p.s0
    breakaway = p.b * largest
    along = float(z[0] * np.sign(v))
    if along <= breakaway:
        plastic = 0.0
    elif along >= largest:
        plastic = 1.0
    else:
        middle = (largest + breakaway) / 2
        plastic = 0.5 * np.sin(np.pi * (along - middle) / (largest - breakaway)) + 0.5
    return np.array([v * (1 - plastic * along / largest)])


DYNAMIC["elastoplastic"] = Dynamic(
    rate=_elastoplastic_rate,
    torque=lambda z, dz, v, p, x: float(p.s0 * z[0] + p.s1 * dz[0] + p.s2 * v),
    dry=_elastoplastic_dry,
    stiffness=lambda p: p.s0,
    damping=lambda v, p, x: p.s1,
)


#: So close to its limit an element counts as having reached it: the solver's events are as exact.
REACHED = 1e-12


def elements(p: Any) -> tuple[Array, Array]:
    """Friction and stiffness of each element."""
    numbers = range(1, _count(p) + 1)
    return (
        np.array([getattr(p, f"F{i}") for i in numbers]),
        np.array([getattr(p, f"k{i}") for i in numbers]),
    )


def _count(p: Any) -> int:
    return sum(1 for name in vars(p) if name[0] == "F" and name[1:].isdigit())


def _level(v: float, p: Any, exponent: float) -> float:
    """The sliding level s(v)."""
    return float(np.sum(elements(p)[0]) + p.dFs * _stribeck(v, p.vs, exponent))


def _gms_switches(z: Array, v: float, p: Any, x: Any) -> Phase:
    """Generalized Maxwell slip (Lampaert et al. 2003): the torques of the elements, then 1 for
    each that slides and the direction of that sliding.

    An element sticks, df/dt = k v, until f = a s; then it slides, df/dt = C (a - f/s) along v,
    until the velocity goes through zero.
    """
    friction, stiffness = elements(p)
    n, s, direction = friction.size, _level(v, p, p.alpha), np.sign(v)
    share = friction / np.sum(friction)
    slides = (z[n : 2 * n] == direction) if direction else np.zeros(n, dtype=bool)
    slides |= direction * z[:n] >= share * s - REACHED * s
    start = np.concatenate([z[:n], np.where(slides, direction, 0.0)])

    def rate(z: Array) -> Array:
        sticking = stiffness * v
        sliding = p.C * (share * direction - z[:n] / s)
        return np.concatenate([np.where(slides, sliding, sticking), np.zeros(n)])

    events = [
        lambda z, i=i: float(share[i] * s - direction * z[i]) for i in np.flatnonzero(~slides)
    ]
    return start, rate, events


def _no_rate(z: Array, v: float, p: Any, x: Any) -> Array:
    return np.zeros_like(z)


DYNAMIC["gms"] = Dynamic(
    rate=_no_rate,
    torque=lambda z, dz, v, p, x: float(np.sum(z[: _count(p)]) + p.s2 * v),
    dry=lambda v, p, x: float(_level(v, p, p.alpha)),
    stiffness=lambda p: 1.0,
    states=lambda p: 2 * _count(p),
    switches=_gms_switches,
)


def _leuven_slip(z: Array, v: float, p: Any) -> float:
    """dz/dt = v (1 - f/s) along v (Lampaert et al. 2002, with n = 1)."""
    return float(v * (1 - np.sum(z) * np.sign(v) / _level(v, p, p.delta)))


def _leuven_switches(z: Array, v: float, p: Any, x: Any) -> Phase:
    """The hysteresis force of N Maxwell elements, each df = k dz until it slips at W."""
    friction, stiffness = elements(p)
    limit = friction * (1 + p.dFs / np.sum(friction))
    way = np.sign(_leuven_slip(z, v, p))
    start = np.where(way * z >= limit - REACHED * np.sum(limit), way * limit, z)
    sticks = way * start < limit

    def rate(z: Array) -> Array:
        return np.where(sticks, stiffness, 0.0) * _leuven_slip(z, v, p)

    events = [lambda z, i=i: float(limit[i] - way * z[i]) for i in np.flatnonzero(sticks)]
    return start, rate, events


DYNAMIC["leuven"] = Dynamic(
    rate=_no_rate,
    torque=lambda z, dz, v, p, x: float(np.sum(z) + p.s1 * _leuven_slip(z, v, p) + p.s2 * v),
    dry=lambda v, p, x: float(_level(v, p, p.delta)),
    stiffness=lambda p: 1.0,
    damping=lambda v, p, x: p.s1,
    states=_count,
    switches=_leuven_switches,
)


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
    tolerance = 1e-9 * largest / law.stiffness(p)
    for k, (v, x) in enumerate(zip(speeds, seen, strict=True)):
        if law.switches is not None:
            z = _switching_step(law, z, v, float(motion.dt[k]), p, x, tolerance)
        elif v != 0:
            rate = partial(_autonomous, law.rate, v, p, x)
            z = _radau(rate, z, float(motion.dt[k]), tolerance, []).z
        torque[k] = law.torque(z, law.rate(z, v, p, x), v, p, x)
        size[k] = largest * (1 + law.damping(v, p, x) * abs(v) / dry[k])
    return Solution(torque, size)


def _autonomous(rate: Rate, v: float, p: Any, x: Any, z: Array) -> Array:
    return rate(z, v, p, x)


@dataclass(frozen=True)
class _Stretch:
    """The state at the end of a stretch and how long it took."""

    z: Array
    duration: float


def _radau(
    rate: Callable[[Array], Array],
    z: Array,
    dt: float,
    tolerance: float,
    events: list[Callable[[Array], float]],
) -> _Stretch:
    """Up to `dt` or the first event."""

    def stopping(event: Callable[[Array], float]) -> Callable[[float, Array], float]:
        def watched(t: float, z: Array) -> float:
            return event(z)

        watched.terminal = True  # type: ignore[attr-defined]
        watched.direction = -1  # type: ignore[attr-defined]
        return watched

    solved = solve_ivp(
        lambda t, z: rate(z),
        (0.0, dt),
        z,
        method="Radau",
        rtol=1e-11,
        atol=tolerance,
        events=[stopping(event) for event in events],
    )
    assert solved.success, solved.message
    return _Stretch(solved.y[:, -1], float(solved.t[-1]))


def _switching_step(
    law: Dynamic, z: Array, v: float, dt: float, p: Any, x: Any, tolerance: float
) -> Array:
    """One step of held velocity, restarted wherever an element sticks or slips."""
    assert law.switches is not None
    left = dt
    while True:
        z, rate, events = law.switches(z, v, p, x)
        if v == 0 or left <= 1e-14 * dt:
            return z
        stretch = _radau(rate, z, left, tolerance, events)
        z, left = stretch.z, left - stretch.duration
