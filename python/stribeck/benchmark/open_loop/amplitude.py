"""The amplitudes at which hidden effects have the sizes that were asked for."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping

from stribeck.benchmark.open_loop.effects import CAPS, SHORTEST_REACH

#: Bisections of the logarithm of an amplitude, and the relative error of the size that is enough.
ROUNDS = 22
CLOSE = 2e-3
#: Of an effect that the motion cannot show there is no size: it gets this share of the largest.
UNSEEN = 0.4


def find_amplitudes(
    wanted: Mapping[str, float],
    noise: float,
    size: Callable[[str, float], float],
    unseen: Collection[str],
) -> tuple[dict[str, float], float]:
    """An amplitude for each effect, and the noise, which gives way where no amplitude will do.

    Parameters
    ----------
    wanted
        Size of each effect over the noise.
    noise
        Level of the noise, in the unit of `size`.
    size
        RMS that an effect of an amplitude leaves beyond the base.
    unseen
        Effects that leave no trace in this motion.
    """
    amplitudes: dict[str, float] = {}
    for name, over_noise in wanted.items():
        if name in unseen:
            amplitudes[name] = UNSEEN * CAPS[name]
            continue
        noise = _reachable(name, over_noise, noise, size)
        amplitudes[name] = _bisect(name, over_noise, noise, size)
    return amplitudes, noise


def _reachable(
    name: str, over_noise: float, noise: float, size: Callable[[str, float], float]
) -> float:
    """The noise over which the effect has the size within its bounds of amplitude."""
    top = size(name, CAPS[name]) / noise
    if top < 1.02 * over_noise:
        noise *= top / (1.02 * over_noise)
    if name == "presliding":
        noise *= max(1.0, size(name, SHORTEST_REACH) / noise / (0.98 * over_noise))
    return noise


def _bisect(
    name: str, over_noise: float, noise: float, size: Callable[[str, float], float]
) -> float:
    shortest = SHORTEST_REACH if name == "presliding" else CAPS[name] * 1e-4
    low, high = math.log(shortest), math.log(CAPS[name])
    best, error = CAPS[name], math.inf
    for _ in range(ROUNDS):
        middle = (low + high) / 2
        reached = size(name, math.exp(middle)) / noise
        if abs(reached / over_noise - 1) < error:
            best, error = math.exp(middle), abs(reached / over_noise - 1)
        if error < CLOSE:
            break
        low, high = (middle, high) if reached < over_noise else (low, middle)
    return best
