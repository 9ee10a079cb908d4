"""Values of the elementary functions at 50 digits, for tests/math.rs.

    .venv/bin/python tests/elementary/references.py

writes `references.csv` beside this file. Each row holds a format, a function, the bits of its
arguments, the bits of the number of that format that is nearest to the value, and how far the value
lies above that number, away from zero, in units of its last place.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import mpmath as mp
import numpy as np

# A phase of 1e6 beside a multiple of pi loses twenty digits.
mp.mp.dps = 80

POINTS = 40


@dataclass(frozen=True)
class Format:
    """A binary format: digits, the least exponent, how its bits are packed."""

    name: str
    digits: int
    least: int
    pack: tuple[str, str]

    def rounded(self, x: float) -> float:
        return struct.unpack(self.pack[0], struct.pack(self.pack[0], x))[0]

    def bits(self, x: float) -> str:
        return f"{struct.unpack(self.pack[1], struct.pack(self.pack[0], x))[0]:x}"


DOUBLE = Format("f64", 53, -1074, ("<d", "<Q"))
SINGLE = Format("f32", 24, -149, ("<f", "<I"))

FUNCTIONS: dict[str, Callable[..., mp.mpf]] = {
    "exp": mp.exp,
    "expm1": mp.expm1,
    "phi_1": lambda x: mp.expm1(x) / x,
    "phi_2": lambda x: (mp.expm1(x) - x) / x**2,
    "phi_3": lambda x: (mp.expm1(x) - x - x**2 / 2) / x**3,
    "ln": mp.log,
    "tanh": mp.tanh,
    "atan": mp.atan,
    "sin": mp.sin,
    "cos": mp.cos,
    "powf": lambda x, p: x**p,
}


def spread(random: np.random.Generator, low: float, high: float) -> np.ndarray:
    """Evenly spread numbers."""
    return random.uniform(low, high, POINTS)


def sizes(random: np.random.Generator, low: float, high: float) -> np.ndarray:
    """Numbers of either sign whose sizes are evenly spread on a logarithmic scale."""
    size = np.exp(random.uniform(np.log(low), np.log(high), POINTS))
    return size * random.choice([-1.0, 1.0], POINTS)


def arguments(name: str, kind: Format, random: np.random.Generator) -> Iterator[tuple[float, ...]]:
    """Where a function is to be judged: its whole range, and where it is difficult."""
    largest, subnormal = (1.7e308, 5e-322) if kind is DOUBLE else (3.4e38, 1e-43)
    overflow, underflow = (709.7, -745.1) if kind is DOUBLE else (88.7, -103.9)
    phase = 1e22 if kind is DOUBLE else 1e10
    near_zero = [spread(random, -2, 2), spread(random, -0.4, 0.4)]
    if name == "exp":
        ranges = [*near_zero, spread(random, underflow, overflow), sizes(random, subnormal, 1)]
        ranges.append(spread(random, underflow, underflow + 30))
    elif name == "expm1":
        ranges = [*near_zero, spread(random, -45, overflow), sizes(random, subnormal, 1)]
    elif name.startswith("phi"):
        ranges = [*near_zero, spread(random, -60, overflow), sizes(random, 1e-20, 1e3 * phase)]
        ranges = [values[values < overflow] for values in ranges]
    elif name == "ln":
        ranges = [spread(random, 0.7, 1.42), spread(random, 0.99, 1.01), spread(random, 0, 20)]
        ranges.append(abs(sizes(random, subnormal, largest)))
    elif name == "powf":
        yield from powers(kind, random)
        return
    elif name in ("sin", "cos"):
        ranges = [spread(random, -7, 7), spread(random, -3000, 3000), spread(random, -1e6, 1e6)]
        ranges += [sizes(random, 1e-20, phase), np.arange(1, POINTS) * np.pi / 2]
    else:
        ranges = [*near_zero, spread(random, -6, 6), sizes(random, subnormal, largest)]
    for x in np.concatenate(ranges):
        yield (kind.rounded(float(x)),)


def powers(kind: Format, random: np.random.Generator) -> Iterator[tuple[float, float]]:
    """Bases and exponents as friction laws have them, and those whose powers fill the range."""
    smallest, largest = (-744.0, 709.0) if kind is DOUBLE else (-103.0, 88.0)
    lowest = 1e-300 if kind is DOUBLE else 1e-37
    yield from (
        (kind.rounded(float(x)), kind.rounded(float(p)))
        for x, p in zip(spread(random, 0, 20), spread(random, -3, 5), strict=True)
    )
    bases = [spread(random, 0.5, 2), spread(random, 0.99, 1.01)]
    bases.append(abs(sizes(random, lowest, 1 / lowest)))
    for base in np.concatenate(bases * 4):
        x = kind.rounded(float(base))
        yield x, kind.rounded(random.uniform(smallest, largest) / float(mp.log(x)))


def row(kind: Format, name: str, point: tuple[float, ...]) -> str:
    value = FUNCTIONS[name](*map(mp.mpf, point))
    exponent = max(int(mp.frexp(value)[1]) - kind.digits, kind.least)
    units = mp.ldexp(value, -exponent)
    nearest = mp.nint(units)
    bits = kind.bits(float(mp.ldexp(nearest, exponent)))
    arguments = " ".join(kind.bits(x) for x in point)
    return f"{kind.name},{name},{arguments},{bits},{float(mp.sign(units) * (units - nearest)):.4f}"


def main() -> None:
    rows = ["format,function,arguments,nearest,above"]
    for kind in (DOUBLE, SINGLE):
        for name in FUNCTIONS:
            random = np.random.default_rng(1)
            rows += [row(kind, name, point) for point in arguments(name, kind, random)]
    (Path(__file__).parent / "references.csv").write_text("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
