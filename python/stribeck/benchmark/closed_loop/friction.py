"""Friction of the joint, and other unknown torques.

Dry friction is the sum of Coulomb and Stribeck friction, scaled by temperature, position and age,
and of friction per load. Amplitudes are relative to Coulomb friction unless stated otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.benchmark.closed_loop.effects import OUTSIDE
from stribeck.benchmark.closed_loop.machine import Machine
from stribeck.benchmark.draws import log_uniform

Array = NDArray[np.float64]
Shape = Callable[[Array], Array]
Amplitudes = Mapping[str, float]
#: Smallest factor that a change can apply to dry friction.
LEAST = 0.05
#: Height of the Stribeck curve if friction lags.
LAGGING_HEIGHT = 0.8


@dataclass(frozen=True)
class Shapes:
    """One random form of each dependence, with magnitudes of about one.

    Attributes
    ----------
    falls
        Stribeck curve against speed: Popp and Stelter's ``1/(1 + x)``, logistic, or a raised
        cosine.
    bends
        Nonlinear function of the speed: Eyring's ``asinh``, rational, or ``sinh``. Arguments: speed
        divided by top speed, and amplitude.
    per_load
        Friction against load: with a preload, or the 4/3 power of a Hertzian contact.
    film
        Speed above which motoring and generating do not differ.
    thins
        Viscosity against temperature and amplitude: Slotte's power, or Walther's double logarithm.
    dry_of_temperature
        Seals that soften over a few kelvin (logistic), or a hyperbola.
    of_place
        Tight spot with flat flanks, or the triangle wave of a bent screw.
    of_age
        Linear wear, diffusion ``sqrt t``, or a run-in ``1/(1 + t/c)^2``.
    """

    falls: Shape
    bends: Callable[[Array, float], Array]
    per_load: Shape
    film: float
    uneven: float
    thins: Callable[[Array, float], Array]
    dry_of_temperature: Shape
    of_place: Shape
    of_age: Shape
    outside_of_time: Mapping[str, Shape]
    outside_of_place: Shape
    outside_of_speed: Shape
    gap: tuple[float, float]
    directions: tuple[float, float]
    spring: Shape
    ripple: Shape
    signs: Mapping[str, float]


@dataclass(frozen=True)
class State:
    """State of the joint at each row: the true one, or the one measured by the drive.

    Attributes
    ----------
    direction : array [n]
        Factor of the dry friction: the sign of speed, or the state of the contact.
    falls : array [n]
        Value of the Stribeck curve at the present or a past speed.
    """

    time: Array
    position: Array
    velocity: Array
    acceleration: Array
    load: Array
    temperature: Array
    direction: Array
    falls: Array


@dataclass(frozen=True)
class Friction:
    """Friction of one machine, with one set of shapes."""

    machine: Machine
    shapes: Shapes

    def torque(self, s: State, x: Amplitudes) -> Array:
        """Friction and unknown position-dependent torques at each row."""
        dry = self.dry(s, x) * (
            1 + x.get("direction", 0.0) * self.shapes.directions[0] * s.direction
        )
        rate = self.rate(s, x)
        return np.asarray(dry * s.direction + rate + self.conservative(s.position, x))

    def dry(self, s: State, x: Amplitudes) -> Array:
        """Magnitude of dry friction, without the asymmetry of the directions."""
        return np.asarray(
            self.machine.coulomb
            * (
                (x.get("coulomb", 1.0) + stribeck_height(x) * s.falls)
                * self.change(s.time, s.temperature, x)
                * np.maximum(1 + x.get("position", 0.0) * self.shapes.of_place(s.position), LEAST)
                * self.outside_change(s, x)
                + self.per_load(s.velocity, s.load, x)
            )
        )

    def change(self, t: Array, temperature: Array, x: Amplitudes) -> Array:
        """Factor of dry friction that depends on time only."""
        made = 1 + x.get("temperature_dry", 0.0) * self.shapes.dry_of_temperature(temperature)
        made = made * (1 + x.get("drift", 0.0) * self.shapes.of_age(t))
        for name, shape in self.shapes.outside_of_time.items():
            if name in x:
                made = made * np.maximum(1 + x[name] * shape(t), LEAST)
        return np.asarray(made + 0.0 * t)

    def per_load(self, v: Array, load: Array, x: Amplitudes) -> Array:
        """Friction per load; with `quadrant`, different for a driving and a driven joint."""
        made = x.get("load", 0.0) * self.shapes.per_load(np.abs(load))
        if y := x.get("quadrant", 0.0):
            uneven = self.shapes.uneven * np.sign(v * load) * self.fades(np.abs(v))
            made = made + y * self.shapes.per_load(np.abs(load)) * (1 + uneven)
        return np.asarray(made)

    def fades(self, speed: Array) -> Array:
        """Share of the difference between the quadrants that remains at a speed."""
        return np.asarray(1 / (1 + (speed / self.shapes.film) ** 2))

    def outside_change(self, s: State, x: Amplitudes) -> Array:
        """Factor of dry friction from effects outside the library."""
        made = np.ones_like(s.velocity)
        speed = np.abs(s.velocity)
        if y := x.get("position_speed"):
            shapes = self.shapes
            made += y * shapes.outside_of_place(s.position) * shapes.outside_of_speed(speed)
        if y := x.get("speed_gap"):
            made += y * ((speed > self.shapes.gap[0]) & (speed < self.shapes.gap[1]))
        if y := x.get("acceleration_sign"):
            made += y * speeding_up(self.machine, s.velocity * s.acceleration)
        return np.maximum(made, LEAST)

    def rate(self, s: State, x: Amplitudes) -> Array:
        """Friction of the lubricant."""
        one = self.machine.viscous * x.get("viscous", 1.0) * self.thinned(s.temperature, x)
        uneven = 1 + x.get("direction", 0.0) * self.shapes.directions[1] * np.sign(s.velocity)
        return np.asarray(one * np.sign(s.velocity) * self.bent(np.abs(s.velocity), x) * uneven)

    def bent(self, speed: Array, x: Amplitudes) -> Array:
        """Nonlinear function of the speed in the friction of the lubricant."""
        if y := x.get("nonlinear_viscous"):
            top = self.shapes.bends(np.ones(1), y)
            return self.machine.vmax * self.shapes.bends(speed / self.machine.vmax, y) / top
        return speed

    def thinned(self, temperature: Array, x: Amplitudes) -> Array:
        """Viscosity relative to that at the middle temperature."""
        if y := x.get("temperature_viscous"):
            return self.shapes.thins(temperature, y)
        return np.ones_like(temperature)

    def conservative(self, q: Array, x: Amplitudes) -> Array:
        """Torques that are independent of velocity: offset, spring, ripple."""
        made = self.shapes.signs["offset"] * x.get("offset", 0.0) + 0.0 * q
        if y := x.get("spring"):
            made = made + y * self.shapes.spring(q)
        if y := x.get("ripple"):
            made = made + y * self.shapes.ripple(q)
        return np.asarray(self.machine.coulomb * made)


def speeding_up(machine: Machine, power: Array) -> Array:
    """Return -1 to 1 for falling to rising speed; `power` is velocity times acceleration."""
    return np.tanh(power / (0.03 * machine.vmax**2 / machine.ramp))


def stribeck_height(x: Amplitudes) -> float:
    """Height of the Stribeck curve relative to Coulomb friction; larger if friction lags."""
    return x.get("stribeck", LAGGING_HEIGHT if "frictional_lag" in x else 0.0)


def draw_shapes(
    rng: np.random.Generator,
    machine: Machine,
    loads: Array,
    temperatures: Array,
    dwells: Array,
    duration: float,
) -> Shapes:
    """Draw one random member of each family."""
    vs = machine.vmax * log_uniform(rng, 0.02, 0.06)
    falls: list[Shape] = [
        lambda s: 1 / (1 + 1.4 * s / vs),
        lambda s: 2 / (1 + np.exp(np.minimum(1.3 * s / vs, 300.0))),
        lambda s: 0.5 + 0.5 * np.cos(np.pi * np.minimum(s / (3 * vs), 1.0)),
    ]
    bends: list[Callable[[Array, float], Array]] = [
        lambda u, y: np.arcsinh(2 * y * u) / (2 * y),
        lambda u, y: u / (1 + y * u),
        lambda u, y: np.sinh(np.minimum(0.6 * y * u, 50.0)) / (0.6 * y),
    ]
    scale = float(np.sqrt(np.mean(loads**2))) + 1e-12
    preload = scale * float(rng.uniform(0.1, 0.5))
    per_load: list[Shape] = [
        lambda w: np.maximum(w - preload, 0.0) / scale,
        lambda w: (w / scale) ** (4 / 3),
    ]
    middle, span = float(temperatures.mean()), max(float(np.ptp(temperatures)), 1.0)
    directions = (
        float(rng.uniform(0.15, 0.35) * rng.choice([-1, 1])),
        float(rng.uniform(0.4, 0.7) * rng.choice([-1, 1])),
    )
    return Shapes(
        falls=falls[int(rng.integers(3))],
        bends=bends[int(rng.integers(3))],
        per_load=per_load[int(rng.integers(2))],
        film=machine.vmax * float(rng.uniform(0.15, 0.4)),
        uneven=float(rng.uniform(0.4, 0.9) * rng.choice([-1, 1])),
        thins=_thins(rng, middle),
        dry_of_temperature=_softens(rng, middle, span),
        of_place=_of_place(rng, machine),
        of_age=_of_age(rng, duration),
        outside_of_time=_outside_of_time(rng, dwells, duration),
        outside_of_place=_square_wave(rng, machine),
        outside_of_speed=_about_zero(machine.vmax * float(rng.uniform(0.2, 0.4))),
        gap=_gap(rng, machine),
        directions=directions,
        spring=_spring(rng, machine),
        ripple=_ripple(rng, machine),
        signs={n: float(rng.choice([-1.0, 1.0])) for n in ("offset", "gain", "delay")},
    )


def _thins(rng: np.random.Generator, middle: float) -> Callable[[Array, float], Array]:
    """Slotte ``((Tm + c)/(T + c))^n``, or Walther ``log log (nu + 0.7) = A - B log T``."""
    if rng.random() < 0.5:
        zero = float(rng.uniform(20.0, 45.0))
        return lambda x, y: ((middle + zero) / (x + zero)) ** (4.0 * y)
    kelvin = 273.15

    def walther(x: Array, y: float) -> Array:
        slope = 6.5 * y
        level = math.log10(math.log10(90.7)) + slope * math.log10(middle + kelvin)
        grade = 10 ** (10 ** (level - slope * np.log10(x + kelvin))) - 0.7
        return np.asarray(grade / 90.0)

    return walther


def _softens(rng: np.random.Generator, middle: float, span: float) -> Shape:
    sign = float(rng.choice([-1.0, -1.0, 1.0]))
    if rng.random() < 0.5:
        knee = middle + span * float(rng.uniform(-0.2, 0.2))
        return lambda x: sign * 2 * (1 / (1 + np.exp(-5 * (x - knee) / span)) - 0.5)
    far = span * float(rng.uniform(0.7, 1.5))
    return lambda x: sign * 1.5 * (x - middle) / (span / 2 + far + (x - middle))


def _of_place(rng: np.random.Generator, machine: Machine) -> Shape:
    """A tight spot with flat flanks, or the triangle wave of a bent screw."""
    spot = machine.centre + machine.half * float(rng.uniform(-0.5, 0.5))
    width = machine.half * float(rng.uniform(0.25, 0.45))
    if rng.random() < 0.5:
        return lambda q: 1.6 / (1 + ((q - spot) / width) ** 4) - 0.4
    period = machine.half * float(rng.uniform(0.8, 1.6))
    return lambda q: 4 * np.abs(np.mod((q - spot) / period, 1.0) - 0.5) - 1


def _of_age(rng: np.random.Generator, duration: float) -> Shape:
    slow = duration * float(rng.uniform(0.15, 0.4))
    ages: list[Shape] = [
        lambda t: t / duration,
        lambda t: -np.sqrt(np.maximum(t, 0.0) / duration),
        lambda t: 1.3 / (1 + np.maximum(t, 0.0) / slow) ** 2,
    ]
    return ages[int(rng.integers(3))]


def _outside_of_time(rng: np.random.Generator, dwells: Array, duration: float) -> dict[str, Shape]:
    """Humidity (a slow triangle wave), moves of another joint, and random starts."""
    period = duration / float(rng.uniform(4.0, 8.0))
    phase = float(rng.random())
    nodes = np.sort(rng.uniform(0.0, duration, 4 * len(dwells) + 8))
    poses = rng.uniform(-1.0, 1.0, nodes.size)
    starts = np.sort(np.concatenate([dwells, rng.uniform(0.0, duration, 2 * len(dwells))]))
    luck = rng.uniform(-1.6, 1.6, starts.size + 1)
    made: dict[str, Shape] = {
        "humidity": lambda t: 4 * np.abs(np.mod(t / period + phase, 1.0) - 0.5) - 1,
        "second_axis_load": lambda t: np.interp(t, nodes, poses),
        "restart": lambda t: luck[np.searchsorted(starts, t)],
    }
    assert set(made) < set(OUTSIDE)
    return made


def _square_wave(rng: np.random.Generator, machine: Machine) -> Shape:
    period = machine.half * float(rng.uniform(0.5, 0.9))
    shift = float(rng.random())
    return lambda q: np.tanh(3 * np.sin(2 * np.pi * (q / period + shift)))


def _about_zero(middle: float) -> Shape:
    """Function of speed: negative at low speed, positive at high speed."""
    return lambda s: (s - middle) / (s + middle)


def _gap(rng: np.random.Generator, machine: Machine) -> tuple[float, float]:
    low = machine.vmax * float(rng.uniform(0.12, 0.25))
    return low, low * float(rng.uniform(1.7, 2.3))


def _spring(rng: np.random.Generator, machine: Machine) -> Shape:
    """A cable that is slack up to a point, or a hose that stiffens.

    The mean over the stroke is subtracted. Neither is a sine of the angle, as gravity is.
    """
    rest, towards = float(rng.uniform(-0.3, 0.3)), float(rng.choice([-1.0, 1.0]))
    slack = bool(rng.random() < 0.5)

    def pull(q: Array) -> Array:
        u = towards * (q - machine.centre) / machine.half - rest
        return np.maximum(u, 0.0) ** 1.5 if slack else u * np.abs(u)

    over = pull(machine.centre + machine.half * np.linspace(-1.0, 1.0, 301))
    mean, spread = float(over.mean()), float(over.std())
    return lambda q: towards * (pull(q) - mean) / spread


def _ripple(rng: np.random.Generator, machine: Machine) -> Shape:
    """Rounded six-step commutation, without its mean."""
    period = 2 * machine.half / log_uniform(rng, 6.0, 30.0)
    shift = float(rng.random())
    steep = float(rng.uniform(0.6, 1.2))
    scale = math.tanh(steep)
    return lambda q: np.tanh(steep * np.sin(2 * np.pi * (q / period + shift))) / scale
