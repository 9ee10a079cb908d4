"""Recordings of a joint whose friction hides one effect or more, to judge the improvement loop.

Nothing of the product is imported and none of its functional forms is reused, so that a fit can
only succeed by naming the right cause, never by sharing the formula. The forms used here, with
``x`` scaled and the amplitude searched so that the effect has the size asked for:

stribeck
    Hess-Soom ``1/(1 + x^2)``, ``sech x``, or a monotone PCHIP table of abs(v): the usual stretched
    exponential is only one of many shapes that fall with speed.
nonlinear_viscous
    ``atan`` or ``log1p`` saturation, or churning ``x^2/(1 + x)``; never a power.
direction
    Both coefficients differ by the sign of v. What an offset explains does not count as size.
load
    Hyperbola ``sqrt(1 + x^2) - 1`` or rational ``x^2/(1 + x)`` of abs(load): flat, then linear.
temperature_viscous
    Vogel ``exp(A/(T + 95) - A/(Tm + 95))`` or Arrhenius in kelvin, as lubricants thin.
temperature_dry
    Softplus or a piecewise-linear table of T.
presliding
    Maxwell slip: 24 elastic-slip elements with nonlocal memory, loading curve
    ``1 - (1 - x/xm)^n``; no bristle equation. On a grid 8 to 16 times finer than the rows.
position
    Two or three Gaussian bumps along the stroke.
offset
    A constant in the torque channel.
inertia, gravity
    The given load_torque lacks a part of the true one.
gain
    The recording multiplies the current by a nominal torque constant, the joint gets the true one.
saturation
    The current that a torque takes where iron saturates: Froelich's ``T/(1 - abs T/b)`` or
    ``T/sqrt(1 - (T/b)^2)``; the recording multiplies it by the torque constant of small currents.
spring
    A cable pack that stiffens (``sinh``), gives way (``atan``) or hangs slack (softplus), its rest
    position anywhere; its mean over the stroke is taken out.
ripple
    ``sin(x + b sin(x + c))`` of the angle of a magnet or a pole: more than two harmonics, without
    its mean.
drift
    Run-in ``t/(t + c)``, wear ``log(1 + t/c)`` or a power law; never an exponential.
delay
    The torque channel shows the joint at t - tau. The motion is analytic in t, so the joint is
    evaluated there and nothing is interpolated, however fine tau is.

The motion is a piecewise analytic mixture: multi-sines, trapezoid and quintic moves with dwells,
slow scans, cosine strokes with differing reversal accelerations; the payload changes in dwells.
Everything is drawn from ``numpy.random.default_rng(seed)``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.signal import lfilter

Array = NDArray[np.float64]
Local = Callable[[Array], tuple[Array, Array, Array]]
Shape = Callable[[Array], Array]

EFFECTS = (
    "stribeck",
    "nonlinear_viscous",
    "direction",
    "load",
    "temperature_viscous",
    "temperature_dry",
    "presliding",
    "position",
    "offset",
    "inertia",
    "gravity",
    "delay",
    "gain",
    "spring",
    "ripple",
    "drift",
    "saturation",
)

#: What each limited motion cannot show, by the column "needs" of the table of effects.
LIMITS: dict[str, list[str]] = {
    "isothermal": ["temperature_viscous", "temperature_dry"],
    "one_direction": ["direction", "offset", "position", "ripple", "spring"],
    "constant_load": ["load", "quadrant", "gain", "saturation"],
    "no_slow_motion": [
        "stribeck",
        "nonlinear_viscous",
        "presliding",
        "frictional_lag",
        "inertia",
    ],
    "warm_up_only": ["drift"],
    "short_range": ["gravity"],
}

#: Largest amplitude tried; where it does not reach the asked size, the noise is lowered instead.
CAPS = {
    "stribeck": 1.2,
    "nonlinear_viscous": 4.0,
    "direction": 0.7,
    "load": 2.0,
    "temperature_viscous": 1.0,
    "temperature_dry": 0.6,
    "presliding": 0.05,
    "position": 1.2,
    "offset": 1.0,
    "inertia": 0.7,
    "gravity": 0.5,
    "delay": 2.6,
    "gain": 0.35,
    "spring": 2.0,
    "ripple": 1.5,
    "drift": 0.7,
    "saturation": 0.75,
}

#: Shorter presliding distances (in half strokes) drown in the encoder: raise the noise instead.
SHORTEST_REACH = 1.2e-3

ELEMENTS = 24


# --- motion ---


@dataclass
class Motion:
    """A chain of moves, each analytic in its own time; at rest before and after them."""

    starts: list[float] = field(default_factory=list)
    moves: list[Local] = field(default_factory=list)
    origins: list[float] = field(default_factory=list)
    end: float = 0.0
    q: float = 0.0

    def add(self, duration: float, move: Local, advance: float) -> None:
        """Append a move that lasts `duration` and ends `advance` further on, at rest."""
        self.starts.append(self.end)
        self.moves.append(move)
        self.origins.append(self.q)
        self.end += duration
        self.q += advance

    def rest(self, duration: float) -> None:
        """Append a dwell."""
        self.add(duration, lambda t: (0 * t, 0 * t, 0 * t), 0.0)

    def __call__(self, t: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at sorted times `t`."""
        q, v, a = np.full_like(t, self.q), np.zeros_like(t), np.zeros_like(t)
        edges = np.searchsorted(t, [*self.starts, self.end])
        q[: edges[0]] = self.origins[0]
        for i, move in enumerate(self.moves):
            rows = slice(edges[i], edges[i + 1])
            if rows.stop > rows.start:
                dq, v[rows], a[rows] = move(t[rows] - self.starts[i])
                q[rows] = self.origins[i] + dq
        return q, v, a


def _trapezoid(delta: float, vmax: float, amax: float) -> tuple[float, Local]:
    """A move of `delta` with a trapezoid of speed."""
    d, s = abs(delta), math.copysign(1.0, delta)
    top = min(vmax, math.sqrt(d * amax))
    ramp = top / amax
    total = d / top + ramp

    def move(t: Array) -> tuple[Array, Array, Array]:
        left = total - t
        up, down = t < ramp, left < ramp
        q = np.where(up, amax * t * t / 2, top * (t - ramp / 2))
        q = np.where(down, d - amax * left * left / 2, q)
        v = np.where(up, amax * t, np.where(down, amax * left, top))
        a = np.where(up, amax, np.where(down, -amax, 0.0))
        return s * q, s * v, s * a

    return total, move


def _quintic(delta: float, total: float) -> Local:
    """A minimum-jerk move."""

    def move(t: Array) -> tuple[Array, Array, Array]:
        x = t / total
        return (
            delta * x**3 * (10 - 15 * x + 6 * x * x),
            delta * 30 * x * x * (1 - x) ** 2 / total,
            delta * 60 * x * (1 - x) * (1 - 2 * x) / total**2,
        )

    return move


def _stroke(delta: float, total: float) -> Local:
    """Half a cosine: it leaves and reaches rest with full acceleration."""
    w = math.pi / total

    def move(t: Array) -> tuple[Array, Array, Array]:
        c, s = np.cos(w * t), np.sin(w * t)
        return delta / 2 * (1 - c), delta / 2 * w * s, delta / 2 * w * w * c

    return move


def _multisine(amp: Array, omega: Array, phase: Array, total: float, ramp: float) -> Local:
    """A sum of sines that fades in and out, so that it starts and ends at rest."""

    def fade(t: Array) -> tuple[Array, Array, Array]:
        x = np.clip(np.minimum(t, total - t) / ramp, 0.0, 1.0)
        s = np.where(t < total / 2, 1.0, -1.0)
        return (
            x**3 * (10 - 15 * x + 6 * x * x),
            s * 30 * x * x * (1 - x) ** 2 / ramp,
            60 * x * (1 - x) * (1 - 2 * x) / ramp**2,
        )

    def move(t: Array) -> tuple[Array, Array, Array]:
        arg = omega[:, None] * t + phase[:, None]
        f0 = amp @ np.sin(arg)
        f1 = (amp * omega) @ np.cos(arg)
        f2 = -(amp * omega**2) @ np.sin(arg)
        w0, w1, w2 = fade(t)
        return w0 * f0, w1 * f0 + w0 * f1, w2 * f0 + 2 * w1 * f1 + w0 * f2

    return move


@dataclass
class Joint:
    """The base joint: what is known before anything is hidden."""

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


def _log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def _draw_joint(rng: np.random.Generator, effects: Sequence[str], limit: str | None) -> Joint:
    """A joint with magnitudes over decades; gravity and one-way rotation need a revolute one."""
    kind = "prismatic" if rng.random() < 0.15 else "revolute"
    if "gravity" in effects or limit in ("one_direction", "short_range"):
        kind = "revolute"
    coulomb = _log_uniform(rng, 0.05, 100.0)
    half = _log_uniform(rng, 0.8, 2.6) if kind == "revolute" else _log_uniform(rng, 0.1, 0.5)
    if "gravity" in effects:
        half = rng.uniform(1.8, 2.8)
    if limit == "short_range":
        half = rng.uniform(0.04, 0.07)
    vmax = half * _log_uniform(rng, 0.6, 2.5)
    amax = vmax * rng.uniform(2.5, 6.0)
    heavy = 2.0 if "delay" in effects else 1.0
    gravity = coulomb * heavy * _log_uniform(rng, 0.8, 3.5)
    inertia = coulomb / amax * _log_uniform(rng, 0.4, 1.8)
    spring = gravity / half * rng.uniform(0.3, 0.8) if kind == "prismatic" else 0.0
    if limit == "constant_load":
        inertia, spring = 0.0, 0.0
    if "presliding" in effects:
        vmax, amax = vmax * 1.5, amax * 1.5
    if "delay" in effects:
        inertia, amax = inertia * 2, amax * 0.5
    rate_share = rng.uniform(0.35, 1.0) if "delay" in effects else _log_uniform(rng, 0.35, 1.8)
    if "temperature_viscous" in effects:
        rate_share = max(rate_share, 0.7)
    if "nonlinear_viscous" in effects:
        rate_share = rng.uniform(1.3, 2.5)
    return Joint(
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


def _plan(
    rng: np.random.Generator,
    joint: Joint,
    duration: float,
    limit: str | None,
    brisk: bool = False,
    smooth: bool = False,
) -> tuple[Motion, Array]:
    """The motion, and the times at which the payload may change (the middle of dwells).

    A `brisk` motion has few slow reversals: few rows are inside the presliding distance. In a
    `smooth` one the acceleration never jumps: no row near a jump is undecided under a delay.
    """
    m = Motion(q=joint.centre)
    m.rest(0.5)
    swaps: list[float] = []

    def target(spread: float = 1.0) -> float:
        return joint.centre + spread * joint.half * rng.uniform(-1, 1)

    def go(q: float, vmax: float, amax: float) -> None:
        if abs(q - m.q) > 1e-3 * joint.half:
            total, move = _trapezoid(q - m.q, vmax, amax)
            if smooth:
                d = abs(q - m.q)
                total = max(1.875 * d / vmax, math.sqrt(5.8 * d / amax))
                move = _quintic(q - m.q, total)
            m.add(total, move, q - m.q)

    def sines(length: float) -> None:
        go(joint.centre + 0.1 * joint.half * rng.uniform(-1, 1), 0.5 * joint.vmax, joint.amax / 2)
        n = int(rng.integers(3, 7))
        omega = joint.vmax / joint.half * rng.uniform(0.3, 2.2, n)
        amp, phase = rng.uniform(0.3, 1.0, n), rng.uniform(0, 2 * math.pi, n)
        amp /= omega**0.7
        probe = np.linspace(0, length, 1500)
        q, v, a = _multisine(amp, omega, phase, length, length / 8)(probe)
        scale = min(
            0.9 * joint.half / np.abs(q).max(),
            joint.vmax / np.abs(v).max(),
            joint.amax / np.abs(a).max(),
        )
        m.add(length, _multisine(amp * scale, omega, phase, length, length / 8), 0.0)

    def moves(length: float) -> None:
        end = m.end + length
        while m.end < end:
            q = target()
            d = abs(q - m.q)
            if d < 0.1 * joint.half:
                continue
            v = joint.vmax * rng.uniform(0.15, 1.0)
            if rng.random() < 0.5:
                go(q, v, joint.amax * rng.uniform(0.2, 1.0))
            else:
                total = max(1.875 * d / v, math.sqrt(5.8 * d / joint.amax))
                m.add(total, _quintic(q - m.q, total), q - m.q)
            m.rest(rng.uniform(0.1, 0.6))

    def slow(length: float) -> None:
        end, side = m.end + length, 1.0 if m.q < joint.centre else -1.0
        while m.end < end:
            v = joint.vmax * _log_uniform(rng, 0.05 if brisk else 0.008, 0.12)
            room = joint.half - side * (m.q - joint.centre)
            d = min(v * rng.uniform(1.5, 5.0), max(room, 0.02 * joint.half))
            go(m.q + side * d, v, joint.amax * _log_uniform(rng, 0.02, 0.3))
            if rng.random() < (0.1 if brisk else 0.5):
                side = -side
            if rng.random() < 0.3:
                m.rest(rng.uniform(0.1, 0.4))

    def strokes(length: float) -> None:
        end = m.end + length
        while m.end < end:
            d = (
                joint.half
                * _log_uniform(rng, 0.2 if brisk else 0.05, 0.9)
                * (-1 if m.q > joint.centre else 1)
            )
            a = joint.amax * _log_uniform(rng, 0.08, 1.0)
            total = math.pi * max(math.sqrt(abs(d) / 2 / a), abs(d) / 2 / joint.vmax)
            for i in range(int(rng.integers(1, 4)) * 2 + 1):
                back = d * (-1) ** i
                m.add(total, _stroke(back, total), back)

    def one_way(length: float) -> None:
        end = m.end + length
        while m.end < end:
            d = rng.uniform(0.2, 2.5)
            v = joint.vmax * _log_uniform(rng, 0.02, 1.0)
            if rng.random() < 0.5:
                go(m.q + d * min(1.0, 4 * v / joint.vmax), v, joint.amax * rng.uniform(0.2, 1.0))
            else:
                total = max(1.875 * d / v, math.sqrt(5.8 * d / joint.amax))
                m.add(min(total, 12.0), _quintic(d * min(1, 12 / total), min(total, 12.0)), 0.0)
                m.q += d * min(1, 12 / total)
            m.rest(rng.uniform(0.1, 0.5))

    def fast(length: float) -> None:
        end = m.end + length
        while m.end < end:
            v = joint.vmax * rng.uniform(0.7, 1.0)
            side = -1 if m.q > joint.centre else 1
            go(joint.centre + side * joint.half * rng.uniform(0.85, 1.0), v, joint.vmax / 0.15)
            m.rest(rng.uniform(0.05, 0.2))

    mixed = [sines, moves, slow, strokes, moves, sines, strokes, slow]
    if smooth:
        mixed = [sines, moves, slow, sines]
    kinds = {"one_direction": [one_way], "no_slow_motion": [fast]}.get(str(limit), mixed)
    while m.end < duration:
        for i in rng.permutation(len(kinds)):
            kinds[i](rng.uniform(7.0, 13.0))
            m.rest(rng.uniform(0.4, 0.8))
            swaps.append(m.end - 0.2)
    return m, np.asarray(swaps)


def _heat(rng: np.random.Generator, duration: float, limit: str | None) -> Callable[[Array], Array]:
    """Joint temperature: a duty cycle heats and cools, so that it is not a function of time."""
    grid = np.arange(-1.0, duration + 1.0, 0.05)
    start, span = rng.uniform(19.0, 30.0), rng.uniform(14.0, 28.0)
    if limit == "isothermal":
        return lambda t: start + 0 * t
    if limit == "warm_up_only":
        return lambda t: start + span * np.maximum(t, 0) / duration
    while True:
        power, t, on = np.zeros_like(grid), grid[0], True
        while t < grid[-1]:
            length = rng.uniform(0.1, 0.24) * duration
            power[grid >= t] = rng.uniform(0.75, 1.0) if on else rng.uniform(0.0, 0.2)
            t, on = t + length, not on
        tau = rng.uniform(0.09, 0.16) * duration
        k = 0.05 / tau
        smooth = lfilter([k * 4], [1, -(1 - k * 4)], power)
        rise = np.asarray(lfilter([k], [1, -(1 - k)], smooth))
        rise /= rise.max()
        if abs(np.corrcoef(rise, grid)[0, 1]) < 0.6:
            return lambda t: start + span * np.interp(t, grid, rise)


# --- effects ---


def _table(x: Sequence[float], y: Sequence[float]) -> Shape:
    curve = PchipInterpolator(x, y)
    last, value = x[-1], y[-1]
    return lambda s: np.where(s < last, curve(np.minimum(s, last)), value)


def _draw_shapes(rng: np.random.Generator, joint: Joint, loads: Array, temps: Array) -> dict:
    """One random member of each family; amplitudes come later."""
    vs = joint.vmax * _log_uniform(rng, 0.02, 0.06)
    jitter = rng.uniform(0.93, 1.07, 5)
    fall = np.clip(np.array([0.9, 0.6, 0.3, 0.1, 0.03]) * jitter, 0, 1)
    knots = _table([0, 0.4, 0.9, 1.5, 2.4, 3.6, 5], [1, *fall, 0])
    stribeck: list[Shape] = [
        lambda s: 1 / (1 + (s / vs) ** 2),
        lambda s: 1 / np.cosh(np.minimum(s / vs, 300.0)),
        lambda s: knots(s / vs),
    ]
    scale = float(np.sqrt(np.mean(loads**2))) * rng.uniform(0.3, 1.5) + 1e-12
    load: list[Shape] = [
        lambda x: np.sqrt(1 + (x / scale) ** 2) - 1,
        lambda x: (x / scale) ** 2 / (1 + np.abs(x) / scale),
    ]
    tm, span = float(temps.mean()), max(float(np.ptp(temps)), 1.0)
    vogel, kelvin = 95.0, 273.15
    viscosity: list[Callable[[Array, float], Array]] = [
        lambda x, a: np.exp(1500 * a * (1 / (x + vogel) - 1 / (tm + vogel))),
        lambda x, a: np.exp(9000 * a * (1 / (x + kelvin) - 1 / (tm + kelvin))),
    ]
    knee, sign = tm + span * rng.uniform(-0.4, 0.0), -1.0 if rng.random() < 0.7 else 1.0
    bend = span * rng.uniform(0.2, 0.4)
    nodes = tm + span * np.array([-0.8, -0.2, 0.2, 0.8])
    values = np.cumsum([0.0, *np.sort(rng.uniform(0.2, 0.5, 3))[:: int(rng.choice([-1, 1]))]])
    dry: list[Shape] = [
        lambda x: np.logaddexp(0, (x - knee) / bend) * bend / span,
        lambda x: np.interp(x, nodes, values),
    ]
    pick_dry = dry[int(rng.integers(2))]
    zero = float(pick_dry(np.asarray(tm)))
    count = int(rng.integers(2, 4))
    places = np.linspace(-0.7, 0.7, count) + rng.uniform(-0.15, 0.15, count)
    spots = joint.centre + joint.half * places
    heights = rng.uniform(0.5, 1.0, count) * np.where(np.arange(count) % 2, -0.5, 1.0)
    width = joint.half * rng.uniform(0.26, 0.4)
    pick_rate = int(rng.integers(3))

    def rate(v: Array, alpha: float) -> Array:
        if alpha == 0:
            return joint.viscous * v
        x = np.abs(v) / joint.vmax
        if pick_rate == 0:
            y = np.arctan(alpha * x) / alpha
        elif pick_rate == 1:
            y = np.log1p(alpha * x) / alpha
        else:
            y = x * (1 + alpha * x * x / (1 + x))
        return joint.viscous * joint.vmax * np.sign(v) * y

    exponent = float(rng.uniform(3.0, 4.5))
    return {
        "stribeck": stribeck[int(rng.integers(3))],
        "load": load[int(rng.integers(2))],
        "viscosity": viscosity[int(rng.integers(2))],
        "dry": lambda x: sign * (pick_dry(x) - zero),
        "position": lambda q: heights @ np.exp(-0.5 * ((q - spots[:, None]) / width) ** 2),
        "rate": rate,
        "exponent": exponent,
        "direction": (float(rng.uniform(-0.3, 0.3)), float(rng.choice([-1.0, 1.0]))),
        "offset": float(rng.choice([-1.0, 1.0])),
        "gravity": float(rng.uniform(-1.0, 1.0)),
        "delay": float(rng.choice([-1.0, 1.0])),
    }


def _draw_further_shapes(rng: np.random.Generator, joint: Joint, loads: Array, end: float) -> dict:
    """Shapes of the effects that are no part of the friction's dependence on v, tl and T."""
    neutral, stiff = float(rng.uniform(-0.3, 0.3)), float(rng.uniform(0.8, 1.6))
    springs: list[Shape] = [
        lambda u: np.sinh(stiff * (u - neutral)),
        lambda u: np.arctan(2.0 * stiff * (u - neutral)),
        lambda u: np.logaddexp(0.0, 4.0 * (u - neutral)) / 4.0,
    ]
    pull, stroke = springs[int(rng.integers(3))], np.linspace(-1.0, 1.0, 401)
    mean, spread = float(pull(stroke).mean()), float(pull(stroke).std())
    towards = float(rng.choice([-1.0, 1.0]))
    wave = 2 * math.pi * _log_uniform(rng, 6.0, 40.0) / (2 * joint.half)
    bend, phase, second = rng.uniform(0.2, 0.45), *rng.uniform(0, 2 * math.pi, 2)
    turn = np.linspace(0.0, 2 * math.pi, 720, endpoint=False)
    level = float(np.mean(np.sin(turn + bend * np.sin(turn - phase + second))))
    slow = end * rng.uniform(0.1, 0.5)
    ageing: list[Shape] = [
        lambda t: -t / (t + slow),
        lambda t: np.log1p(t / slow) / math.log1p(end / slow),
        lambda t: (1 + t / slow) ** -0.6 - 1,
    ]
    age = ageing[int(rng.integers(3))]
    largest = float(np.abs(loads).max()) + joint.coulomb + joint.viscous * joint.vmax
    root = bool(rng.integers(2))

    def saturated(torque: Array, x: float) -> Array:
        r = x * np.minimum(np.abs(torque) / largest, 1.2)
        return torque / (np.sqrt(1 - r * r) if root else 1 - r)

    return {
        "spring": lambda q: towards * (pull((q - joint.centre) / joint.half) - mean) / spread,
        "ripple": lambda q: np.sin(wave * q + phase + bend * np.sin(wave * q + second)) - level,
        "drift": lambda t: age(np.maximum(t, 0.0)),
        "saturation": saturated,
        "gain": float(rng.choice([-1.0, 1.0])),
    }


def maxwell_slip(q: Array, reach: float, exponent: float) -> Array:
    """Direction of dry friction, in -1..1, of parallel elastic-slip elements along a path `q`.

    Between two reversals every element is min(spring, slip), hence exact for the path as sampled.
    """
    nodes = np.arange(1, ELEMENTS + 1) / ELEMENTS
    curve = 1 - (1 - np.concatenate([[0.0], nodes])) ** exponent
    slope = np.append(np.diff(curve) * ELEMENTS, 0.0)
    weight = nodes * (slope[:-1] - slope[1:])
    limit = nodes * reach
    path = q[np.concatenate([[True], np.diff(q) != 0])]
    step = np.diff(path)
    turning = np.flatnonzero(step[1:] * step[:-1] < 0) + 1
    turning = np.concatenate([[0], turning, [len(path) - 1]])
    z, out = np.zeros(ELEMENTS), np.zeros_like(path)
    gain = weight / limit
    for i, j in pairwise(turning.tolist()):
        if j <= i:
            continue
        way = path[i + 1 : j + 1] - path[i]
        far = int(np.searchsorted(np.abs(way), 2 * reach))
        states = np.clip(z[:, None] + way[:far], -limit[:, None], limit[:, None])
        out[i + 1 : i + 1 + far] = gain @ states
        out[i + 1 + far : j + 1] = np.sign(way[-1])
        z = np.clip(z + way[-1], -limit, limit)
    return out[np.cumsum(np.diff(q, prepend=q[0]) != 0)]


@dataclass
class Recording:
    """A finished recording with what the tests of the generator itself need."""

    frame: pl.DataFrame
    truth: dict[str, Any]
    moving: NDArray[np.bool_]
    clean: Array
    contributions: dict[str, Array]


@dataclass
class World:
    """Everything drawn for one seed: evaluates the joint at any time for given amplitudes."""

    joint: Joint
    motion: Motion
    swaps: Array
    payload: Array
    heat: Callable[[Array], Array]
    holds: Array
    shapes: dict
    limit: str | None
    dt: float
    oversampling: int
    coarse: bool = False

    def true_load(self, t: Array, q: Array, a: Array) -> Array:
        """Load torque: inertia and a gravity-like part with a payload that changes in dwells."""
        j = self.joint
        if self.limit == "constant_load":
            return np.full_like(q, j.gravity)
        mass = self.payload[np.searchsorted(self.swaps, t)]
        if j.kind == "prismatic":
            return j.inertia * a + mass * j.gravity + j.spring * (q - j.centre)
        return j.inertia * a + mass * j.gravity * np.cos(q + j.phase)

    def direction(self, t: Array, q: Array, v: Array, amps: dict[str, float]) -> Array:
        """What multiplies the dry friction: sgn v, a hold at rest, or the Maxwell-slip state."""
        if amps.get("presliding"):
            m = 1 if self.coarse else self.oversampling
            fine = (t[:, None] + self.dt * (np.arange(1 - m, 1) / m)).ravel()
            path = self.motion(fine)[0]
            reach = amps["presliding"] * self.joint.half
            return maxwell_slip(path, reach, self.shapes["exponent"])[m - 1 :: m]
        d = np.sign(v)
        rest = v == 0
        edge = np.flatnonzero(np.diff(np.concatenate([[False], rest, [False]]).astype(int)))
        for k, (i, j) in enumerate(zip(edge[::2], edge[1::2], strict=True)):
            h = self.holds[k % len(self.holds)]
            d[i:j] = np.linspace(h[0], h[1], j - i)
        return d

    def friction(
        self, t: Array, q: Array, v: Array, a: Array, tl: Array, amps: dict[str, float]
    ) -> Array:
        """Friction torque, and what else acts without being known: offset, spring, ripple."""
        j, s = self.joint, self.shapes
        dry = np.full_like(q, j.coulomb)
        if x := amps.get("stribeck"):
            dry *= 1 + x * s["stribeck"](np.abs(v))
        if x := amps.get("load"):
            dry *= 1 + x * s["load"](np.abs(tl))
        if x := amps.get("temperature_dry"):
            dry *= 1 + x * s["dry"](self.heat(t))
        if x := amps.get("position"):
            dry *= np.maximum(1 + x * s["position"](q), 0.05)
        if x := amps.get("drift"):
            dry *= 1 + x * s["drift"](t)
        rate = s["rate"](v, amps.get("nonlinear_viscous", 0.0))
        if x := amps.get("temperature_viscous"):
            rate = rate * s["viscosity"](self.heat(t), x)
        if x := amps.get("direction"):
            of_dry, of_rate = s["direction"]
            dry *= 1 + 0.5 * x * of_dry * np.sign(v)
            rate = rate * (1 + 0.5 * x * of_rate * np.sign(v))
        constant = s["offset"] * amps.get("offset", 0.0) * j.coulomb
        for name in ("spring", "ripple"):
            if x := amps.get(name):
                constant = constant + x * j.coulomb * s[name](q)
        return dry * self.direction(t, q, v, amps) + rate + constant

    def known_load(self, q: Array, a: Array, tl: Array, amps: dict[str, float]) -> Array:
        """The load torque as the recording gives it: wrong by a hidden inertia or gravity error."""
        j = self.joint
        given = tl - amps.get("inertia", 0.0) * (j.inertia or j.coulomb / j.amax) * a
        return given - amps.get("gravity", 0.0) * j.gravity * np.cos(
            q + j.phase + self.shapes["gravity"]
        )

    def measured(self, t: Array, amps: dict[str, float]) -> tuple[Array, Array]:
        """Noise-free torque channel and the given load torque, both at the rows `t`."""
        q, v, a = self.motion(t)
        given = self.known_load(q, a, self.true_load(t, q, a), amps)
        late = t - self.shapes["delay"] * amps.get("delay", 0.0) * self.dt
        if late is not t:
            q, v, a = self.motion(late)
        tl = self.true_load(late, q, a)
        return self.shown(tl + self.friction(late, q, v, a, tl, amps), amps), given

    def shown(self, torque: Array, amps: dict[str, float]) -> Array:
        """The torque channel where `torque` acts: current times a nominal torque constant."""
        if x := amps.get("saturation"):
            torque = self.shapes["saturation"](torque, x)
        if x := amps.get("gain"):
            torque = torque / (1 - self.shapes["gain"] * x)
        return torque


def _beyond(y: Array, basis: Array) -> float:
    """RMS of what a least-squares fit of the basis leaves of y."""
    return float(np.sqrt(np.mean((y - basis @ np.linalg.lstsq(basis, y, rcond=None)[0]) ** 2)))


def _colour(rng: np.random.Generator, n: int) -> Array:
    """Unit noise: an AR(1) part with random correlation plus a white part."""
    rho, share = rng.uniform(0.0, 0.95), rng.uniform(0.2, 0.9)
    red = lfilter([math.sqrt(1 - rho * rho)], [1, -rho], rng.standard_normal(n + 500))[500:]
    return math.sqrt(share) * np.asarray(red) + math.sqrt(1 - share) * rng.standard_normal(n)


def _check(
    effects: Sequence[str], size: float | Sequence[float], limits: dict[str, bool]
) -> tuple[list[str], list[float], str | None]:
    """Effect names, a size for each, and the one limit, if any."""
    names = [e for e in effects if e != "none"]
    unknown = [e for e in names if e not in EFFECTS] + [k for k in limits if k not in LIMITS]
    if unknown:
        raise ValueError(f"unknown effect or limit: {unknown}")
    on = [k for k, wanted in limits.items() if wanted]
    if len(on) > 1:
        raise ValueError(f"one limit at a time, not {on}")
    sizes = [float(size)] * len(names) if isinstance(size, int | float) else list(size)
    if len(sizes) != len(names):
        raise ValueError("one size for each effect")
    return names, sizes, on[0] if on else None


def record(
    effects: Sequence[str], seed: int, size: float | Sequence[float] = 1.0, **limits: bool
) -> Recording:
    """Like `make`, with the noise-free torque and each effect's contribution as well."""
    names, sizes, limit = _check(effects, size, limits)
    rng = np.random.default_rng(seed)
    rate = float(rng.choice([125.0, 160.0, 200.0, 250.0]))
    duration = float(rng.uniform(130.0, 235.0))
    t = np.arange(round(duration * rate)) / rate
    joint = _draw_joint(rng, names, limit)
    motion, swaps = _plan(
        rng, joint, duration + 1.0, limit, "presliding" in names, "delay" in names
    )
    payload = rng.permutation(np.resize([0.35, 1.0, 1.6, 0.7], len(swaps) + 1))
    heat = _heat(rng, duration, limit)
    holds = rng.uniform(-0.9, 0.9, (997, 2))
    over = int(rng.integers(8, 17))
    world = World(joint, motion, swaps, payload, heat, holds, {}, limit, 1 / rate, over)
    q, v, a = motion(t)
    tl = world.true_load(t, q, a)
    world.shapes = _draw_shapes(rng, joint, tl, heat(t))
    # Drawn apart, so that recordings without these effects stay what they were.
    world.shapes |= _draw_further_shapes(np.random.default_rng([seed, 11]), joint, tl, duration)
    keep = np.ones(len(t), bool)
    if limit == "no_slow_motion":
        keep = (np.abs(v) > 0.69 * joint.vmax) & (a == 0)
    if limit == "one_direction":
        keep = v >= 0

    noise = joint.coulomb * _log_uniform(rng, 0.015, 0.05)
    base_sigma = joint.vmax * _log_uniform(rng, 4e-4, 1.4e-3)
    if "presliding" in names:  # the encoder must resolve the presliding distance
        base_sigma *= 0.4
    unit_v, unit = np.clip(rng.standard_normal(len(t)), -4.5, 4.5), _colour(rng, len(t))
    turn = np.abs(a[np.abs(v) < 0.02 * joint.vmax]) if np.any(np.abs(v) < 0.02 * joint.vmax) else a

    def sigma(amps: dict[str, float]) -> float:
        """Velocity noise; rows whose direction a delay leaves undecided must not be moving."""
        slip = float(np.max(np.abs(turn), initial=0.0)) * amps.get("delay", 0.0) / rate
        return max(base_sigma, 1.05 * slip / 5)

    def rows(amps: dict[str, float]) -> NDArray[np.bool_]:
        s = sigma(amps)
        return keep & (np.abs(v + s * unit_v) > 5 * s) & (t > 1.0)

    plain = world.measured(t, {})

    def contribution(amps: dict[str, float]) -> Array:
        torque, given = world.measured(t, amps)
        return (torque - given) - (plain[0] - plain[1])

    world.coarse = True

    def ratio(name: str, amp: float) -> float:
        amps = {name: amp}
        on = rows(amps)
        basis = np.stack([np.sign(v), v, *([np.ones_like(v)] if name == "direction" else [])], 1)
        return _beyond(contribution(amps)[on], basis[on]) / noise

    cannot = LIMITS.get(limit or "", [])
    amps: dict[str, float] = {}
    for name, want in zip(names, sizes, strict=True):
        cap = CAPS[name]
        if name in cannot:
            amps[name] = 0.4 * cap
            continue
        top = ratio(name, cap)
        if top < 1.02 * want:
            noise *= top / (1.02 * want)
        low, high = math.log(cap * 1e-4), math.log(cap)
        if name == "presliding":
            low = math.log(SHORTEST_REACH)
            noise *= max(1.0, ratio(name, SHORTEST_REACH) / (0.98 * want))
        best, error = cap, math.inf
        for _ in range(22):
            mid = (low + high) / 2
            reached = ratio(name, math.exp(mid))
            if abs(reached / want - 1) < error:
                best, error = math.exp(mid), abs(reached / want - 1)
            if error < 2e-3:
                break
            low, high = (mid, high) if reached < want else (low, mid)
        amps[name] = best
    world.coarse = False

    s = sigma(amps)
    on = rows(amps)
    clean, given = world.measured(t, amps)
    count = 2.0 ** round(math.log2(joint.half / 30000 / joint.vmax * base_sigma / 1e-3 + 1e-12))
    frame = pl.DataFrame(
        {
            "time": t,
            "position": np.round(q / count) * count if count > 0 else q,
            "velocity": v + s * unit_v,
            "acceleration": a,
            "torque": clean + noise * unit,
            "load_torque": given,
            "temperature": heat(t) + 0.04 * rng.standard_normal(len(t)),
        }
    )
    floor = noise * unit - joint.viscous * s * unit_v
    parts = {name: contribution({name: amp}) for name, amp in amps.items()}
    level = float(np.sqrt(np.mean(floor[on] ** 2)))
    basis = np.stack([np.sign(v), v], 1)[on]
    both = contribution(amps)[on] if amps else np.zeros(int(on.sum()))
    own = {}
    for name, part in parts.items():
        others = [parts[o][on] for o in parts if o != name]
        own[name] = _beyond(part[on], np.column_stack([basis, *others])) / level
    truth: dict[str, Any] = {
        "hidden": names or ["none"],
        "size": _beyond(both, basis) / level,
        "sizes": {n: _beyond(p[on], basis) / level for n, p in parts.items()},
        "sizes_beyond_others": own,
        "asked": dict(zip(names, sizes, strict=True)),
        "amplitudes": amps,
        "kind": joint.kind,
        "coulomb": joint.coulomb,
        "viscous": joint.viscous,
        "noise_rms": level,
        "velocity_noise": s,
        "rate": rate,
        "seed": seed,
        "limit": limit,
        "cannot_show": list(cannot),
        "closed_loop": False,
    }
    if "delay" in amps:
        truth["delay_s"] = world.shapes["delay"] * amps["delay"] / rate
    cut = {n: p[keep] for n, p in parts.items()}
    return Recording(frame.filter(pl.Series(keep)), truth, on[keep], clean[keep], cut)


def make(
    effects: Sequence[str], seed: int, size: float | Sequence[float] = 1.0, **limits: bool
) -> tuple[pl.DataFrame, dict[str, Any]]:
    """A recording that hides `effects`, and the truth about it.

    `size` is the RMS of an effect over the moving rows, beyond what a refitted Coulomb and viscous
    friction takes up, in units of the noise (one figure, or one for each effect). `limits` names
    one restriction of the motion (see LIMITS): effects in truth["cannot_show"] leave no trace
    there, so they get a fixed, physical amplitude instead. truth["noise_rms"] is what the true
    friction, evaluated at the recorded velocity, leaves over the moving rows.
    """
    r = record(effects, seed, size, **limits)
    return r.frame, r.truth


# --- closed loop ---


def _lookup(f: Shape, low: float, high: float, n: int = 16001) -> Callable[[float], float]:
    """A fast scalar version of `f` on [low, high], held beyond it."""
    values = np.broadcast_to(f(np.linspace(low, high, n)), (n,)).tolist()
    scale, last = (n - 1) / (high - low), n - 1

    def at(x: float) -> float:
        r = (x - low) * scale
        if r <= 0:
            return values[0]
        i = int(r)
        if i >= last:
            return values[last]
        return values[i] + (values[i + 1] - values[i]) * (r - i)

    return at


#: What the loop below does not simulate.
NOT_IN_CLOSED_LOOP = ("presliding", "delay", "gain", "spring", "ripple", "drift", "saturation")
CLOSED_LOOP_EFFECTS = tuple(e for e in EFFECTS if e not in NOT_IN_CLOSED_LOOP)


def make_closed_loop(
    effects: Sequence[str], seed: int, size: float | Sequence[float] = 1.0
) -> tuple[pl.DataFrame, dict[str, Any]]:
    """A joint under sampled PD control with feed-forward, recorded by its drive.

    Steps of 1 ms with a Karnopp zero-velocity band (inside it the joint sticks while the drive
    stays under breakaway); encoder counts; velocity from centred differences inside the drive;
    torque is the motor torque plus current noise. The size is searched on the reference motion;
    truth["sizes"] is what the real motion shows.
    """
    names, sizes, _ = _check(effects, size, {})
    if bad := [n for n in names if n not in CLOSED_LOOP_EFFECTS]:
        raise ValueError(f"not available in closed loop: {bad}")
    rng = np.random.default_rng([seed, 7])
    rate, m = [(125.0, 8), (200.0, 5), (250.0, 4)][int(rng.integers(3))]
    duration, h = float(rng.uniform(95.0, 120.0)), 1 / (rate * m)
    joint = _draw_joint(rng, names, None)
    motion, swaps = _plan(rng, joint, duration + 1.0, None)
    payload = rng.permutation(np.resize([0.35, 1.0, 1.6, 0.7], len(swaps) + 1))
    heat, holds = _heat(rng, duration, None), rng.uniform(-0.9, 0.9, (997, 2))
    world = World(joint, motion, swaps, payload, heat, holds, {}, None, 1 / rate, m)
    n = round(duration * rate)
    fine = np.arange(n * m) * h
    rq, rv, ra = motion(fine)
    t, v, q, a = fine[::m], rv[::m], rq[::m], ra[::m]
    tl = world.true_load(t, q, a)
    world.shapes = shapes = _draw_shapes(rng, joint, tl, heat(t))
    noise = joint.coulomb * _log_uniform(rng, 0.02, 0.05)

    def contribution(amps: dict[str, float], state: tuple[Array, ...]) -> Array:
        t, q, v, a, tl = state
        return (
            world.friction(t, q, v, a, tl, amps)
            - world.known_load(q, a, tl, amps)
            - world.friction(t, q, v, a, tl, {})
            + tl
        )

    amps: dict[str, float] = {}
    on = np.abs(v) > 0.01 * joint.vmax
    for name, want in zip(names, sizes, strict=True):
        one = np.ones_like(v) if name == "direction" else v
        basis = np.stack([np.sign(v), v, one], 1)[on]
        grid = np.geomspace(1e-4, 1.0, 60) * CAPS[name]
        state = (t, q, v, a, tl)
        found = [_beyond(contribution({name: float(x)}, state)[on], basis) for x in grid]
        noise = min(noise, found[-1] / (1.02 * want))
        amps[name] = float(np.exp(np.interp(want * noise, found, np.log(grid))))

    # scalar versions of everything the loop needs
    big = 3 * joint.vmax
    x = amps.get("stribeck", 0.0)
    by_speed = _lookup(lambda s: joint.coulomb * (1 + x * shapes["stribeck"](s)), 0.0, big, 60001)
    by_rate = _lookup(lambda s: shapes["rate"](s, amps.get("nonlinear_viscous", 0.0)), 0.0, big)
    y = amps.get("position", 0.0)
    ends = joint.centre - 1.5 * joint.half, joint.centre + 1.5 * joint.half
    by_place = _lookup(lambda p: np.maximum(1 + y * shapes["position"](p), 0.05), *ends)
    z = amps.get("load", 0.0)
    heavy = 4 * float(np.abs(tl).max())
    by_load = _lookup(lambda w: 1 + z * shapes["load"](w), 0.0, heavy)
    temps = heat(fine)
    hot = (1 + amps.get("temperature_dry", 0.0) * shapes["dry"](temps)).tolist()
    thin = shapes["viscosity"](temps, amps.get("temperature_viscous", 0.0)).tolist()
    mass = (payload[np.searchsorted(swaps, fine)] * joint.gravity).tolist()
    of_dry, of_rate = (0.5 * amps.get("direction", 0.0) * k for k in shapes["direction"])
    constant = shapes["offset"] * amps.get("offset", 0.0) * joint.coulomb
    revolute, inertia = joint.kind == "revolute", joint.inertia
    count = 2.0 ** round(math.log2(2 * joint.half / 3e5))
    wn = 2 * math.pi * rng.uniform(2.5, 5.0)
    kp, kd = inertia * wn * wn, 1.4 * inertia * wn
    band = 1e-4 * joint.vmax
    target, speed, push = rq.tolist(), rv.tolist(), (inertia * ra).tolist()
    pos, vel, acc, drive, current, smooth, last = target[0], 0.0, 0.0, 0.0, 0.0, 0.0, target[0]
    out_q, out_v = [0.0] * (n * m), [0.0] * (n * m)
    out_a, out_u, out_g = [0.0] * n, [0.0] * n, [0.0] * n
    for i in range(n * m):
        if revolute:
            g = mass[i] * math.cos(pos + joint.phase)
        else:
            g = mass[i] + joint.spring * (pos - joint.centre)
        if i % m == 0:
            seen = round(pos / count) * count
            smooth += 0.6 * ((seen - last) * rate - smooth)
            last, wanted = seen, speed[i]
            fade = wanted / (abs(wanted) + 0.01 * joint.vmax)
            current = push[i] + g + joint.coulomb * 0.8 * fade + joint.viscous * wanted
            drive = current + kp * (target[i] - seen) + kd * (wanted - smooth)
        free = drive - g - constant
        w = vel if vel != 0.0 else free
        side = 1.0 if w > 0 else -1.0
        s = abs(vel)
        dry = by_speed(s) * hot[i]
        if y:
            dry *= by_place(pos)
        dry *= 1 + side * of_dry
        rate_part = side * by_rate(s) * thin[i] * (1 + side * of_rate)
        if z:
            f = side * dry + rate_part + constant
            f = side * dry * by_load(abs(drive - f)) + rate_part + constant
            for _ in range(4):
                f = side * dry * by_load(abs(drive - f)) + rate_part + constant
            dry *= by_load(abs(drive - f))
        if s < band and abs(free) <= dry:
            vel = acc = 0.0
        else:
            acc = (free - side * dry - rate_part) / inertia
        out_q[i], out_v[i] = pos, vel
        if i % m == 0:
            k = i // m
            out_a[k], out_u[k], out_g[k] = acc, drive, g
        new = vel + h * acc
        if new * vel < 0:
            new = 0.0
        pos += 0.5 * h * (vel + new)
        vel = new

    path, true_v = np.asarray(out_q), np.asarray(out_v)
    seen = np.round(path / count) * count
    wide = np.pad(seen, 2, mode="edge")
    v_seen = ((wide[4:] - wide[:-4]) / (4 * h))[::m]
    q, v, a = path[::m], true_v[::m], np.asarray(out_a)
    torque, tl = np.asarray(out_u), inertia * a + np.asarray(out_g)
    sigma = count / math.sqrt(6) / (4 * h)
    on = (np.abs(v_seen) > 5 * sigma) & (t > 1.0)
    recorded = torque + noise * _colour(rng, n)
    given = world.known_load(q, a, tl, amps)
    law = tl + world.friction(t, q, v_seen, a, tl, amps)
    level = float(np.sqrt(np.mean((recorded - law)[on] ** 2)))
    basis = np.stack([np.sign(v_seen), v_seen], 1)[on]
    state = (t, q, np.where(on, v, 0), a, tl)
    parts = {k: contribution({k: x}, state)[on] for k, x in amps.items()}
    whole = contribution(amps, state)[on]
    frame = pl.DataFrame(
        {
            "time": t,
            "position": seen[::m],
            "velocity": v_seen,
            "acceleration": a,
            "torque": recorded,
            "load_torque": given,
            "temperature": heat(t) + 0.04 * rng.standard_normal(n),
        }
    )
    truth: dict[str, Any] = {
        "hidden": names or ["none"],
        "size": _beyond(whole, basis) / level if amps else 0.0,
        "sizes": {k: _beyond(p, basis) / level for k, p in parts.items()},
        "asked": dict(zip(names, sizes, strict=True)),
        "amplitudes": amps,
        "kind": joint.kind,
        "coulomb": joint.coulomb,
        "viscous": joint.viscous,
        "noise_rms": level,
        "current_noise": noise,
        "velocity_noise": sigma,
        "rate": rate,
        "seed": seed,
        "limit": None,
        "cannot_show": [],
        "closed_loop": True,
    }
    return frame, truth
