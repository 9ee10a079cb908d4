"""Laws with a memory, solved exactly over a step of held velocity, at 50 digits with derivatives.

Where the state's equation is linear, dz/dt = b - r z, its solution is an exponential; Dahl's is
separable. `dynamics` holds the same laws as differential equations: the two check each other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from mpmath import mp, mpf

from laws.dual import Dual, atan, exp, log, magnitude, power, sign, sqrt, variable
from laws.dynamics import Motion
from laws.reference import rising, stribeck

State = list[Dual]


@dataclass(frozen=True)
class Exact:
    """A law with a memory.

    Attributes
    ----------
    advance
        ``advance(z, v, dt, p, x) -> z`` at the end of a step.
    torque
        ``torque(z, v, p, x)`` there.
    states
        ``states(p)``: how many numbers the state has, all 0 at the start.
    """

    advance: Callable[[State, mpf, mpf, Any, Any], State]
    torque: Callable[[State, mpf, Any, Any], Dual]
    states: Callable[[Any], int] = lambda p: 1


EXACT: dict[str, Exact] = {}


def relax(z: Dual, source: Dual | mpf, rate: Dual, dt: mpf) -> Dual:
    """The solution of dz/dt = source - rate z after dt."""
    decay = exp(-rate * dt)
    return z * decay + source * (1 - decay) / rate if rate.value else z + source * dt


def _bristle(
    dry: Callable[[mpf, Any, Any], Dual],
    stiffness: Callable[[Any], Dual],
    damping: Callable[[mpf, Any, Any], Dual],
    rest: Callable[[mpf, Any, Any], Dual],
) -> Exact:
    def pace(v: mpf, p: Any, x: Any) -> Dual:
        return stiffness(p) * abs(v) / dry(v, p, x)

    def advance(z: State, v: mpf, dt: mpf, p: Any, x: Any) -> State:
        return [relax(z[0], v, pace(v, p, x), dt)] if v else z

    def torque(z: State, v: mpf, p: Any, x: Any) -> Dual:
        slip = v - pace(v, p, x) * z[0] if v else Dual(0)
        return stiffness(p) * z[0] + damping(v, p, x) * slip + rest(v, p, x)

    return Exact(advance, torque)


EXACT["lugre"] = _bristle(
    dry=lambda v, p, x: p.a4 + (p.a5 - p.a4) * stribeck(Dual(v), p.a6, p.a7),
    stiffness=lambda p: p.a1,
    damping=lambda v, p, x: p.a2,
    rest=lambda v, p, x: p.a3 * v,
)

EXACT["tadese_t"] = _bristle(
    dry=lambda v, p, x: p.a3 + (p.a4 - p.a3) * stribeck(Dual(v), p.a5, 2),
    stiffness=lambda p: p.a1,
    damping=lambda v, p, x: p.a2,
    rest=lambda v, p, x: (
        (p.a6 + p.a7 * x.T)
        * rising(power(magnitude((p.a8 + p.a9 * x.T) * v), p.a10 + p.a11 * x.T))
        * sign(v)
    ),
)


def _quadrant(v: mpf, x: Any) -> int:
    """1 to 4 for (v, tl) = ++, -+, --, +-; 0 at rest or without load."""
    return int({(1, 1): 1, (-1, 1): 2, (-1, -1): 3, (1, -1): 4}.get((sign(v), sign(x.tl)), 0))


def _side(p: Any, name: str, v: mpf) -> Dual:
    return getattr(p, name + ("_plus" if v > 0 else "_minus"))


def _four_quadrants(v: mpf, p: Any, x: Any) -> Dual:
    level = _side(p, "s20", v) + _side(p, "s2T", v) * x.T
    speed = _side(p, "s30", v) + _side(p, "s3T", v) * x.T
    viscous = level * rising(v / speed) * sign(v)
    i = _quadrant(v, x)
    if not i:
        return viscous
    g1, g2, g3, l1, l2 = (getattr(p, f"{name}_{i}") for name in ("g1", "g2", "g3", "l1", "l2"))
    return viscous + g1 * rising(g2 * v) + g3 + (l1 + l2 * v) * x.tl


EXACT["tadese_full"] = _bristle(
    dry=lambda v, p, x: _side(p, "Fc", v),
    stiffness=lambda p: p.s0,
    damping=lambda v, p, x: p.s1 * exp(-abs(v) / magnitude(p.vd)),
    rest=_four_quadrants,
)


def _xiao_load(v: mpf, p: Any, x: Any) -> Dual:
    i = _quadrant(v, x)
    return p.s2 * v + (getattr(p, f"l_{i}") * abs(x.tl) * sign(v) if i else 0)


EXACT["xiao"] = _bristle(
    dry=lambda v, p, x: p.Fc + (p.Fs - p.Fc) * stribeck(Dual(v), p.vs, 2),
    stiffness=lambda p: p.s0,
    damping=lambda v, p, x: p.s1,
    rest=_xiao_load,
)


def _dahl_advance(z: State, v: mpf, dt: mpf, p: Any, x: Any) -> State:
    """du/dt = -k sgn(u) |u|^a3 for u = 1 - sgn(v) a1 z/a2 and k = a1 |v|/a2."""
    if not v:
        return z
    u = 1 - p.a1 * z[0] * sign(v) / p.a2
    travel = p.a1 * abs(v) * dt / p.a2
    if p.a3.value == 1:
        after = u * exp(-travel)
    elif u.value == 0:
        after = u
    else:
        left = power(magnitude(u), 1 - p.a3) - (1 - p.a3) * travel
        after = sign(u) * power(left, 1 / (1 - p.a3)) if left > 0 else Dual(0)
    return [(1 - after) * p.a2 / p.a1 * sign(v)]


EXACT["dahl"] = Exact(_dahl_advance, lambda z, v, p, x: p.a1 * z[0])


def _indri(v: mpf, p: Any) -> tuple[Dual, Dual, Dual]:
    s0 = atan(p.a5 * v) * (2 / mp.pi)
    s1 = s0 * v
    return s0, s1, p.a6 + p.a7 * atan(s1 * p.a8) * (2 / mp.pi)


def _indri_advance(z: State, v: mpf, dt: mpf, p: Any, x: Any) -> State:
    s0, s1, g = _indri(v, p)
    return [relax(z[0], s0 * s0 * v, p.a1 * s1 / g, dt)]


def _indri_torque(z: State, v: mpf, p: Any, x: Any) -> Dual:
    s0, s1, g = _indri(v, p)
    slip = s0 * s0 * v - p.a1 * s1 / g * z[0]
    scaled = x.a * x.largest_velocity / x.largest_acceleration
    motion = p.a3 * scaled * scaled + v * v
    damped = (p.a2 / sqrt(motion) + p.a4) * slip if motion.value else Dual(0)
    return p.a1 * z[0] + damped + p.a9 * v + p.a10 * v * v * s0


EXACT["indri_b"] = Exact(_indri_advance, _indri_torque)


def _bliman_advance(z: State, v: mpf, dt: mpf, p: Any, x: Any) -> State:
    near, far = abs(v) / (p.eta * p.eps), abs(v) / p.eps
    fast = relax(z[0], (1 + p.rho) * p.Fc * near * sign(v), near, dt)
    slow = relax(z[1], -p.rho * p.Fc * far * sign(v), far, dt)
    return [fast, slow]


EXACT["bliman_sorine"] = Exact(_bliman_advance, lambda z, v, p, x: z[0] + z[1], states=lambda p: 2)


def _elements(p: Any) -> list[tuple[Dual, Dual]]:
    """Friction and stiffness of each element."""
    count = _count(p)
    return [(getattr(p, f"F{i}"), getattr(p, f"k{i}")) for i in range(1, count + 1)]


def _count(p: Any) -> int:
    return sum(1 for name in vars(p) if name[0] == "F" and name[1:].isdigit())


def _levels(v: mpf, p: Any, exponent: Dual) -> tuple[Dual, Dual]:
    """F = F1 + ... + FN and the sliding level s(v)."""
    total = sum((friction for friction, _ in _elements(p)), Dual(0))
    return total, total + p.dFs * stribeck(Dual(v), p.vs, exponent)


def _gms_advance(z: State, v: mpf, dt: mpf, p: Any, x: Any) -> State:
    """An element that starts to slide within the step does so on its level and stays there; one
    that slides already relaxes towards it. The second half of the state: directions of sliding."""
    direction = sign(v)
    if not direction:
        return [*z[: len(z) // 2], *(Dual(0) for _ in z[len(z) // 2 :])]
    total, level = _levels(v, p, p.alpha)
    torques, slides = [], []
    for (friction, stiffness), f, slid in zip(
        _elements(p), z[: len(z) // 2], z[len(z) // 2 :], strict=True
    ):
        end = friction / total * level * direction
        if slid.value == direction or f.value * direction >= end.value * direction:
            torques.append(end + (f - end) * exp(-p.C * dt / level))
            slides.append(Dual(direction))
            continue
        stuck = f + stiffness * v * dt
        reached = stuck.value * direction >= end.value * direction
        torques.append(end if reached else stuck)
        slides.append(Dual(direction if reached else 0))
    return [*torques, *slides]


EXACT["gms"] = Exact(
    _gms_advance,
    lambda z, v, p, x: sum(z[: len(z) // 2], Dual(0)) + p.s2 * v,
    states=lambda p: 2 * _count(p),
)


def _leuven_slip(z: State, v: mpf, p: Any) -> Dual:
    return v * (1 - sum(z, Dual(0)) * sign(v) / _levels(v, p, p.delta)[1])


def _leuven_advance(z: State, v: mpf, dt: mpf, p: Any, x: Any) -> State:
    """From switch to switch: with the stiffness K of the elements that stick, the hysteresis
    torque goes from y to s + (y - s) exp(-K |v| t/s) along v."""
    if not v:
        return z
    total, s = _levels(v, p, p.delta)
    limits = [friction * (total + p.dFs) / total for friction, _ in _elements(p)]
    left = Dual(dt)
    while True:
        y = sum(z, Dual(0)) * sign(v)
        way = sign(s - y) * sign(v)
        sticking = [i for i, f in enumerate(z) if way * f.value < limits[i].value]
        if not way or not sticking:
            return z
        stiffness = sum((_elements(p)[i][1] for i in sticking), Dual(0))
        travels = {i: (way * limits[i] - z[i]) / _elements(p)[i][1] for i in sticking}
        first = min(sticking, key=lambda i: abs(travels[i].value))
        after = y + stiffness * travels[first] * sign(v)
        decay = (s - after) / (s - y)
        pace = stiffness * abs(v) / s
        free = (s + (y - s) * exp(-pace * left) - y) / stiffness * sign(v)
        if decay.value > 0 and exp(-pace * left).value < decay.value:
            left = left + log(decay) / pace
            z = _moved(z, travels[first], sticking, p)
            z[first] = way * limits[first]
        else:
            return _moved(z, free, sticking, p)


def _moved(z: State, travel: Dual, sticking: list[int], p: Any) -> State:
    springs = _elements(p)
    return [f + springs[i][1] * travel if i in sticking else f for i, f in enumerate(z)]


EXACT["leuven"] = Exact(
    _leuven_advance,
    lambda z, v, p, x: sum(z, Dual(0)) + p.s1 * _leuven_slip(z, v, p) + p.s2 * v,
    states=_count,
)


def solve(
    law: Exact,
    parameters: Mapping[str, float],
    motion: Motion,
    constants: Mapping[str, float] | None = None,
) -> list[Dual]:
    """Torque at the end of each step, with its derivatives by the parameters."""
    p = SimpleNamespace(**{name: variable(name, x) for name, x in parameters.items()})
    fixed = {name: mpf(x) for name, x in (constants or {}).items()}
    z: State | None = None
    torques = []
    for k, v in enumerate(motion.velocity.tolist()):
        row = {name: mpf(float(column[k])) for name, column in motion.others.items()}
        x = SimpleNamespace(**row, **fixed)
        if z is None:
            z = [Dual(0) for _ in range(law.states(p))]
        z = law.advance(z, mpf(v), mpf(float(motion.dt[k])), p, x)
        torques.append(law.torque(z, mpf(v), p, x))
    return torques


def as_arrays(torques: list[Dual], symbols: list[str]) -> tuple[np.ndarray, np.ndarray]:
    """Values [n] and gradients [n, p] in double precision."""
    value = np.array([float(t.value) for t in torques])
    slope = np.array([[float(t.slope.get(s, mpf(0))) for s in symbols] for t in torques])
    return value, slope
