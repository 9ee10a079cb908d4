"""The polynomials of src/math/double.rs and src/math/single.rs, as minimax approximations.

    .venv/bin/python tests/elementary/coefficients.py

prints for either format every polynomial with its coefficients, lowest power first, and the
largest weighted error that is left in exact arithmetic once they are rounded to the format.

Each polynomial is found by the exchange algorithm of Remez on a grid of Chebyshev points.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import mpmath as mp
import numpy as np

mp.mp.dps = 80

Function = Callable[[mp.mpf], mp.mpf]

GRID = 600
EXCHANGES = 12


@dataclass(frozen=True)
class Target:
    """What a polynomial approximates: `value(x)` on an interval, errors weighted by `weight(x)`.

    `sizes` is the number of coefficients in double and in single precision; 0 where it is not used.
    """

    name: str
    value: Function
    weight: Function
    interval: tuple[mp.mpf, mp.mpf]
    sizes: tuple[int, int]


def artanh_tail(z: mp.mpf, terms: int) -> mp.mpf:
    """What follows `terms` terms of `2 artanh(s) / s = 2 + 2 z/3 + 2 z^2/5 ...`, over `z^terms`."""
    s = mp.sqrt(z)
    head = sum(2 * z**i / (2 * i + 1) for i in range(terms))
    return (2 * mp.atanh(s) / s - head) / z**terms


HALF_LN2 = mp.log(2) / 2
# A product rounded to the nearest whole number may end a little beyond one half.
MARGIN = mp.mpf("1.0001")
LOG_END = (MARGIN * (mp.sqrt(2) - 1) / (mp.sqrt(2) + 1)) ** 2
ATAN_END = (MARGIN * (mp.sqrt(2) - 1)) ** 2
SINE_END = (MARGIN * mp.pi / 4) ** 2

TARGETS = (
    Target(
        "exp: (e^r - 1 - r) / r^2",
        lambda r: (mp.expm1(r) - r) / r**2,
        lambda r: r**2,
        (-MARGIN * HALF_LN2, MARGIN * HALF_LN2),
        (10, 5),
    ),
    Target(
        "expm1: the same, of a small relative error itself",
        lambda r: (mp.expm1(r) - r) / r**2,
        lambda r: mp.mpf(2),
        (-MARGIN * HALF_LN2, MARGIN * HALF_LN2),
        (11, 6),
    ),
    Target(
        "exp2: (2^f - 1) / f",
        lambda f: mp.expm1(f * mp.log(2)) / f,
        lambda f: f,
        (-MARGIN / 2, MARGIN / 2),
        (11, 6),
    ),
    Target(
        "log: (2 artanh(s) - 2 s) / s^3 in s^2",
        lambda z: artanh_tail(z, 1),
        lambda z: z,
        (mp.mpf(0), LOG_END),
        (7, 3),
    ),
    Target(
        "log_tail: 3/2 (2 artanh(s) - 2 s - 2/3 s^3) / s^5 in s^2",
        lambda z: mp.mpf(3) / 2 * artanh_tail(z, 2),
        lambda z: z**2 / 3,
        (mp.mpf(0), LOG_END),
        (8, 3),
    ),
    Target(
        "atan: (atan(t) - t) / t^3 in t^2",
        lambda z: (mp.atan(mp.sqrt(z)) / mp.sqrt(z) - 1) / z,
        lambda z: z,
        (mp.mpf(0), ATAN_END),
        (11, 5),
    ),
    Target(
        "sin: (sin(r) - r) / r^3 in r^2",
        lambda z: (mp.sin(mp.sqrt(z)) / mp.sqrt(z) - 1) / z,
        lambda z: z,
        (mp.mpf(0), SINE_END),
        (6, 3),
    ),
    Target(
        "cos: (cos(r) - 1 + r^2/2) / r^4 in r^2",
        lambda z: (mp.cos(mp.sqrt(z)) - 1 + z / 2) / z**2,
        lambda z: z**2,
        (mp.mpf(0), SINE_END),
        (6, 3),
    ),
    Target(
        "cbrt: the cube root, of a small relative error",
        mp.cbrt,
        lambda m: 1 / mp.cbrt(m),
        (mp.sqrt(mp.mpf(1) / 2), mp.sqrt(2)),
        (6, 0),
    ),
)


def chebyshev_points(interval: tuple[mp.mpf, mp.mpf], count: int) -> list[mp.mpf]:
    """`count` points, an even number, so that none of them is the middle."""
    low, high = interval
    angles = [mp.pi * (2 * i + 1) / (2 * count) for i in range(count)]
    return [(low + high) / 2 - (high - low) / 2 * mp.cos(angle) for angle in angles]


def extrema(errors: list[mp.mpf], count: int) -> list[int]:
    """Where a weighted error has its largest value between two changes of sign: `count` of them."""
    runs: list[int] = []
    for i, error in enumerate(errors):
        if runs and error * errors[runs[-1]] > 0:
            if abs(error) > abs(errors[runs[-1]]):
                runs[-1] = i
        else:
            runs.append(i)
    while len(runs) > count:
        runs.pop(0 if abs(errors[runs[0]]) < abs(errors[runs[-1]]) else -1)
    return runs


def remez(
    points: list[mp.mpf], values: list[mp.mpf], weights: list[mp.mpf], size: int
) -> list[mp.mpf]:
    """The `size` coefficients of the smallest largest error `weight (value - polynomial)`."""
    chosen = [round(i * (len(points) - 1) / size) for i in range(size + 1)]
    coefficients: list[mp.mpf] = []
    for _ in range(EXCHANGES):
        matrix = mp.matrix(size + 1, size + 1)
        right = mp.matrix(size + 1, 1)
        for row, i in enumerate(chosen):
            for power in range(size):
                matrix[row, power] = weights[i] * points[i] ** power
            matrix[row, size] = (-1) ** row
            right[row] = weights[i] * values[i]
        solution = mp.lu_solve(matrix, right)
        coefficients = [solution[power] for power in range(size)]
        errors = [
            w * (v - mp.polyval(coefficients[::-1], x))
            for x, v, w in zip(points, values, weights, strict=True)
        ]
        following = extrema(errors, size + 1)
        if len(following) <= size or following == chosen:
            break
        chosen = following
    return coefficients


def rounded(target: Target, size: int, kind: type[np.floating]) -> tuple[list[float], mp.mpf]:
    """Coefficients as numbers of `kind`, and the largest weighted error that they leave."""
    points = chebyshev_points(target.interval, GRID)
    values = [target.value(x) for x in points]
    weights = [abs(target.weight(x)) for x in points]
    fixed = [float(kind(float(c))) for c in remez(points, values, weights, size)]
    error = max(
        w * abs(v - mp.polyval([mp.mpf(c) for c in fixed[::-1]], x))
        for x, v, w in zip(points, values, weights, strict=True)
    )
    return fixed, error


def main() -> None:
    for position, kind in enumerate((np.float64, np.float32)):
        print(f"{kind.__name__}")
        for target in (one for one in TARGETS if one.sizes[position] > 0):
            coefficients, error = rounded(target, target.sizes[position], kind)
            print(f"  {target.name}: 2^{float(mp.log(error, 2)):.1f}")
            for coefficient in coefficients:
                print(f"    {kind(coefficient)!s},")


if __name__ == "__main__":
    main()
