"""Points at which a law is compared with its reference: random ones and special ones."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice, product
from typing import Any
from zlib import crc32

import numpy as np
import stribeck as sb
from mpmath import mpf
from stribeck.models.catalog import catalog
from stribeck.models.parameter import Parameter

from laws.published import TABLE_7
from laws.reference import LETTERS

#: A joint of a collaborative robot.
SPEED, TORQUE, EXCURSION, ACCELERATION, PERIOD = 2.0, 10.0, 1.0, 5.0, 1e-3

#: What the catalog's bounds are multiples of, for that joint.
SCALES = {
    "none": 1.0,
    "speed": SPEED,
    "torque": TORQUE,
    "position": EXCURSION,
    "stiffness": TORQUE / EXCURSION,
    "damping": TORQUE / SPEED,
    "square_damping": TORQUE / SPEED**2,
    "cubic_damping": TORQUE / SPEED**3,
    "root_damping": TORQUE / SPEED**0.5,
    "inverse_speed": 1 / SPEED,
    "inverse_torque": 1 / TORQUE,
    "inertia": TORQUE / ACCELERATION,
    "torque_rate": TORQUE * SPEED / EXCURSION,
    "sample_period": PERIOD,
}

#: Fixed constants, drawn between these. The base temperature stays below all temperatures.
CONSTANTS = {
    "base_temperature": (-40.0, -20.0),
    "smoothing_velocity": (1e-4, 1e-1),
    "stribeck_exponent": (0.5, 3.0),
    "largest_velocity": (1.0, 4.0),
    "largest_acceleration": (5.0, 20.0),
}

#: The edge of what a law must bear.
LARGEST = {"v": 1e12, "tl": 1e6, "tm": 1e6, "te": 1e6, "a": 1e6, "q": 1e6, "T": 120.0}


@dataclass(frozen=True)
class Point:
    """Values by symbol, inputs by letter, constants by name."""

    law: str
    parameters: Mapping[str, float]
    inputs: Mapping[str, float]
    constants: Mapping[str, float]

    @property
    def model(self) -> sb.Model:
        """The model with these values."""
        return sb.model(self.law, constants=self.constants, **self.parameters)

    @property
    def channels(self) -> dict[str, Any]:
        """The inputs as the model takes them."""
        return {name: [self.inputs[letter]] for name, letter in LETTERS.items()}

    @property
    def exact(self) -> tuple[dict[str, mpf], dict[str, mpf]]:
        """Parameters, and inputs with constants, as the reference takes them."""
        given = {**self.inputs, **self.constants}
        return (
            {name: mpf(float(x)) for name, x in self.parameters.items()},
            {name: mpf(float(x)) for name, x in given.items()},
        )

    @property
    def rounded(self) -> Point:
        """The same point in single precision."""

        def single(numbers: Mapping[str, float]) -> dict[str, float]:
            return {name: float(np.float32(x)) for name, x in numbers.items()}

        return replace(
            self,
            parameters=single(self.parameters),
            inputs=single(self.inputs),
            constants=single(self.constants),
        )


def generator(law: str, purpose: str) -> np.random.Generator:
    """The random numbers of one law and purpose: the same in every run."""
    return np.random.default_rng(crc32(f"{law} {purpose}".encode()))


def random_points(law: str, count: int) -> Iterator[Point]:
    """Points in the range of random starts, within the catalog's bounds.

    Parameters are uniform in their range in `SCALES`, or log-uniform where the range is
    positive and spans more than a decade. Speeds are log-uniform from 1e-6 to 1e2 rad/s, of either
    sign; temperatures -10 to 90 degC; torques +-30 N m.
    """
    rng = generator(law, "random")
    parameters = sb.model(law).parameters
    for _ in range(count):
        yield Point(
            law=law,
            parameters={p.symbol: draw(rng, p) for p in parameters},
            inputs=draw_inputs(rng),
            constants=draw_constants(rng, law),
        )


def draw(rng: np.random.Generator, p: Parameter) -> float:
    """A value of one parameter in the range of its random starts."""
    low, high = max(p.lower, p.drawn[0]), min(p.upper, p.drawn[1])
    lower, upper = low * SCALES[p.scale], high * SCALES[p.scale]
    if lower > 0 and upper > 10 * lower:
        return float(np.exp(rng.uniform(np.log(lower), np.log(upper))))
    return float(rng.uniform(lower, upper))


def draw_inputs(rng: np.random.Generator) -> dict[str, float]:
    """One instant of a motion."""
    return {
        "v": float(rng.choice([-1, 1]) * 10 ** rng.uniform(-6, 2)),
        "T": float(rng.uniform(-10, 90)),
        "tl": float(rng.uniform(-30, 30)),
        "tm": float(rng.uniform(-30, 30)),
        "te": float(rng.uniform(-30, 30)),
        "a": float(rng.uniform(-20, 20)),
        "q": float(rng.uniform(-3, 3)),
    }


def draw_constants(rng: np.random.Generator, law: str) -> dict[str, float]:
    """The constants that the law uses."""
    drawn = {name: float(rng.uniform(*span)) for name, span in CONSTANTS.items()}
    return {name: x for name, x in drawn.items() if name in catalog()["laws"][law]["constants"]}


#: Parameters at which a formula turns: a denominator or an exponent that a temperature or a speed
#: takes through zero, in numbers that a float holds exactly.
TURNING: dict[str, tuple[dict[str, float], ...]] = {
    "bittencourt_b": ({"a8": -25.0, "a9": 0.5},),
    "iskandar": ({"a5": 8.0, "a6": -1.0, "a7": 0.03125}, {"a11": 0.5, "a12": 0.0, "a13": 0.0}),
    "m_star": ({"vs0": -25.0, "vs_T": 0.5},),
    "zhou": ({"a2": 1.0, "a5": 1.0},),
    "wolf": ({"a4": 1.0, "a6": 1.0},),
    "li": ({"a4": 0.5},),
    "dong": ({"a3": 16.34, "a5": 16.34}, {"a3": 1e-9, "a5": 1e-9}),
    "makkar": ({"a2": 3.0, "a3": 3.0}, {"a3": 0.0}),
    "gaz_a": ({"a4": 1e-9}, {"a4": 1e6, "a5": 0.0}),
    "gaz_b": ({"a2": 1e4, "a3": 1.0}, {"a2": 1e-9}, {"a2": 1e3, "a3": -5.0}, {"a3": 0.0}),
    "shao": ({"a3": 1e-9}, {"a3": 1e9}),
}

#: Temperatures at which one of `TURNING` is singular, and one that is not.
TEMPERATURES = (30.0, 50.0, 16.0)

SPEEDS = (0.0, 5e-324, 1e-300, 1e-40, 1e-12, 1e-3, 0.25, 1.0, 3.0, 1e6, LARGEST["v"])
#: Load, motor and external torque, and acceleration.
EFFORTS = (
    (0.0, 0.0, 0.0, 0.0),
    (1.0, 1.0, -1.0, 2.0),
    (-2.0, 4.0, 1.0, -3.0),
    (1e6, -1e6, 1e6, 1e6),
    (3.0, 3.0, 3.0, -1e-9),
)


def special_points(law: str, stride: int = 1) -> Iterator[Point]:
    """Rest, the smallest and the largest speeds, loads and exponents, singular temperatures.

    With a `stride`, every so many of the points; 7 shares no factor with the inputs' counts.
    """
    return islice(_special_points(law), 0, None, stride)


def _special_points(law: str) -> Iterator[Point]:
    rng = generator(law, "special")
    constants = draw_constants(rng, law)
    reads = catalog()["laws"][law]["channels"]
    speeds = [s * v for v in SPEEDS for s in (1.0, -1.0)]
    temperatures = TEMPERATURES if "temperature" in reads else TEMPERATURES[:1]
    efforts = EFFORTS if set(reads) - {"temperature"} else EFFORTS[:1]
    everywhere = list(product(speeds, temperatures, efforts))
    somewhere = list(product((3.0, -0.25, 0.0), temperatures[:1], efforts[2:3] or efforts))
    for parameters, where in [
        *((each, everywhere) for each in special_parameters(law, rng)),
        *((each, somewhere) for each in vanishing_parameters(law, rng)),
    ]:
        for v, T, (tl, tm, te, a) in where:
            inputs = {"v": v, "T": T, "tl": tl, "tm": tm, "te": te, "a": a, "q": 0.0}
            yield Point(law, parameters, inputs, constants)


def special_parameters(law: str, rng: np.random.Generator) -> Iterator[dict[str, float]]:
    """Published, drawn, turning and steep parameters."""
    table = sb.model(law).parameters
    drawn = {p.symbol: draw(rng, p) for p in table}
    yield drawn
    if law in TABLE_7:
        yield TABLE_7[law]
    for changed in TURNING.get(law, ()):
        yield {**drawn, **changed}
    steep = {p.symbol: 1887.0 for p in table if "exponent" in p.name and p.upper > p.lower}
    if steep:
        near_one = {p.symbol: 0.25 for p in table if "stribeck_velocity" in p.name}
        yield {**drawn, **steep, **near_one}


def vanishing_parameters(law: str, rng: np.random.Generator) -> Iterator[dict[str, float]]:
    """The start of a fit, and each parameter that may be 0 at 0, the others drawn."""
    table = sb.model(law).parameters
    yield {p.symbol: p.start * SCALES[p.scale] for p in table}
    for vanishing in table:
        if vanishing.lower <= 0 <= vanishing.upper:
            yield {p.symbol: draw(rng, p) for p in table} | {vanishing.symbol: 0.0}
