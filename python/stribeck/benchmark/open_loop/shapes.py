"""Random members of families of functions; amplitudes are set later."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
import scipy

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.open_loop.joint import SimulatedJoint
from stribeck.benchmark.open_loop.moves import Array

#: Functions and numbers by name, drawn at random.
Shapes: TypeAlias = dict[str, Any]
Shape = Callable[[Array], Array]
#: Constant of the Vogel equation, and absolute zero, K below 0 degC.
VOGEL, KELVIN = 95.0, 273.15


def draw_shapes(
    rng: np.random.Generator, joint: SimulatedJoint, loads: Array, temperatures: Array
) -> Shapes:
    """Draw functions of speed, load, temperature and position, and of unknown torques."""
    vs = joint.vmax * log_uniform(rng, 0.02, 0.06)
    falls = _falls_with_speed(vs, rng.uniform(0.93, 1.07, 5))
    scale = float(np.sqrt(np.mean(loads**2))) * rng.uniform(0.3, 1.5) + 1e-12
    grows = _grows_with_load(scale)
    middle, span = float(temperatures.mean()), max(float(np.ptp(temperatures)), 1.0)
    thins = _thins_with_temperature(middle)
    knee, sign = middle + span * rng.uniform(-0.4, 0.0), -1.0 if rng.random() < 0.7 else 1.0
    bend = span * rng.uniform(0.2, 0.4)
    nodes = middle + span * np.array([-0.8, -0.2, 0.2, 0.8])
    values = np.cumsum([0.0, *np.sort(rng.uniform(0.2, 0.5, 3))[:: int(rng.choice([-1, 1]))]])
    dry: list[Shape] = [
        lambda x: np.logaddexp(0, (x - knee) / bend) * bend / span,
        lambda x: np.interp(x, nodes, values),
    ]
    pick_dry = dry[int(rng.integers(2))]
    zero = float(pick_dry(np.asarray(middle)))
    count = int(rng.integers(2, 4))
    places = np.linspace(-0.7, 0.7, count) + rng.uniform(-0.15, 0.15, count)
    spots = joint.centre + joint.half * places
    heights = rng.uniform(0.5, 1.0, count) * np.where(np.arange(count) % 2, -0.5, 1.0)
    width = joint.half * rng.uniform(0.26, 0.4)
    curve = int(rng.integers(3))
    exponent = float(rng.uniform(3.0, 4.5))
    return {
        "stribeck": falls[int(rng.integers(3))],
        "load": grows[int(rng.integers(2))],
        "viscosity": thins[int(rng.integers(2))],
        "dry": lambda x: sign * (pick_dry(x) - zero),
        "position": lambda q: heights @ np.exp(-0.5 * ((q - spots[:, None]) / width) ** 2),
        "rate": lambda v, alpha: _rate(joint, curve, v, alpha),
        "exponent": exponent,
        "direction": (float(rng.uniform(-0.3, 0.3)), float(rng.choice([-1.0, 1.0]))),
        "offset": float(rng.choice([-1.0, 1.0])),
        "gravity": float(rng.uniform(-1.0, 1.0)),
        "delay": float(rng.choice([-1.0, 1.0])),
    }


def _falls_with_speed(vs: float, jitter: Array) -> list[Shape]:
    """Hess and Soom's rational function, a hyperbolic secant, and a monotone table."""
    fall = np.clip(np.array([0.9, 0.6, 0.3, 0.1, 0.03]) * jitter, 0, 1)
    knots = _table([0, 0.4, 0.9, 1.5, 2.4, 3.6, 5], [1, *fall, 0])
    return [
        lambda s: 1 / (1 + (s / vs) ** 2),
        lambda s: 1 / np.cosh(np.minimum(s / vs, 300.0)),
        lambda s: knots(s / vs),
    ]


def _table(x: Sequence[float], y: Sequence[float]) -> Shape:
    curve = scipy.interpolate.PchipInterpolator(x, y)
    last, value = x[-1], y[-1]
    return lambda s: np.where(s < last, curve(np.minimum(s, last)), value)


def _grows_with_load(scale: float) -> list[Shape]:
    """A hyperbola and a rational curve: flat, then linear."""
    return [
        lambda x: np.sqrt(1 + (x / scale) ** 2) - 1,
        lambda x: (x / scale) ** 2 / (1 + np.abs(x) / scale),
    ]


def _thins_with_temperature(middle: float) -> list[Callable[[Array, float], Array]]:
    """Viscosity after Vogel and Arrhenius, relative to that at the middle temperature."""
    return [
        lambda x, a: np.exp(1500 * a * (1 / (x + VOGEL) - 1 / (middle + VOGEL))),
        lambda x, a: np.exp(9000 * a * (1 / (x + KELVIN) - 1 / (middle + KELVIN))),
    ]


def _rate(joint: SimulatedJoint, curve: int, v: Array, alpha: float) -> Array:
    """Friction of the lubricant: two curves that saturate with speed, and one that steepens."""
    if alpha == 0:
        return joint.viscous * v
    x = np.abs(v) / joint.vmax
    if curve == 0:
        y = np.arctan(alpha * x) / alpha
    elif curve == 1:
        y = np.log1p(alpha * x) / alpha
    else:
        y = x * (1 + alpha * x * x / (1 + x))
    return np.asarray(joint.viscous * joint.vmax * np.sign(v) * y)


def draw_additive_shapes(
    rng: np.random.Generator, joint: SimulatedJoint, loads: Array, end: float
) -> Shapes:
    """Draw functions of effects other than those of speed, load and temperature."""
    neutral, stiff = float(rng.uniform(-0.3, 0.3)), float(rng.uniform(0.8, 1.6))
    springs: list[Shape] = [
        lambda u: np.sinh(stiff * (u - neutral)),
        lambda u: np.arctan(2.0 * stiff * (u - neutral)),
        lambda u: np.logaddexp(0.0, 4.0 * (u - neutral)) / 4.0,
    ]
    pull, stroke = springs[int(rng.integers(3))], np.linspace(-1.0, 1.0, 401)
    mean, spread = float(pull(stroke).mean()), float(pull(stroke).std())
    towards = float(rng.choice([-1.0, 1.0]))
    wave = 2 * math.pi * log_uniform(rng, 6.0, 40.0) / (2 * joint.half)
    bend, phase, second = rng.uniform(0.2, 0.45), *rng.uniform(0, 2 * math.pi, 2)
    turn = np.linspace(0.0, 2 * math.pi, 720, endpoint=False)
    level = float(np.mean(np.sin(turn + bend * np.sin(turn - phase + second))))
    age = _ageing(end, end * rng.uniform(0.1, 0.5))[int(rng.integers(3))]
    largest = float(np.abs(loads).max()) + joint.coulomb + joint.viscous * joint.vmax
    root = bool(rng.integers(2))

    def saturated(torque: Array, x: float) -> Array:
        r = x * np.minimum(np.abs(torque) / largest, 1.2)
        return np.asarray(torque / (np.sqrt(1 - r * r) if root else 1 - r))

    return {
        "spring": lambda q: towards * (pull((q - joint.centre) / joint.half) - mean) / spread,
        "ripple": lambda q: np.sin(wave * q + phase + bend * np.sin(wave * q + second)) - level,
        "drift": lambda t: age(np.maximum(t, 0.0)),
        "saturation": saturated,
        "gain": float(rng.choice([-1.0, 1.0])),
    }


def _ageing(end: float, slow: float) -> list[Shape]:
    """Run-in, wear, and a power law."""
    return [
        lambda t: -t / (t + slow),
        lambda t: np.log1p(t / slow) / math.log1p(end / slow),
        lambda t: (1 + t / slow) ** -0.6 - 1,
    ]


def draw_quadrant_shape(rng: np.random.Generator, joint: SimulatedJoint, loads: Array) -> Shapes:
    """Draw tooth friction per load, for a joint that drives its load or is driven by it.

    A driven gear train has a larger sliding share under load, so its losses are larger. With speed
    the lubricant film carries the load, at a lower speed in one direction of power.
    """
    share, film = float(rng.uniform(0.3, 0.9)), joint.vmax * float(rng.uniform(0.2, 0.6))
    scale = float(np.sqrt(np.mean(loads**2))) + 1e-12
    worse = float(rng.choice([-1.0, 1.0]))

    def loss(v: Array, tl: Array) -> Array:
        power = np.sign(v * tl)
        uneven = 1 + share * worse * power / (1 + np.abs(v) / film)
        return np.asarray(np.abs(tl) / scale * uneven)

    return {"quadrant": loss}
