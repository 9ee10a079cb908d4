"""Amplitudes at which hidden effects have the wanted sizes."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping

from stribeck.benchmark.open_loop.effects import CAPS, SHORTEST_REACH

#: Number of bisections of the logarithm of an amplitude, and relative tolerance of the size.
ROUNDS = 22
CLOSE = 2e-3
#: Share of the largest amplitude, used for effects that the motion cannot show.
UNSEEN = 0.4


def find_amplitudes(
    wanted: Mapping[str, float],
    noise: float,
    size: Callable[[str, float], float],
    unseen: Collection[str],
) -> tuple[dict[str, float], float]:
    """Return an amplitude for each effect, and the noise, adjusted if no amplitude is suitable.

    Parameters
    ----------
    wanted
        Size of each effect relative to the noise.
    noise
        Level of the noise, in the unit of `size`.
    size
        Function that returns the RMS of an effect outside the base model, for an amplitude.
    unseen
        Effects that this motion cannot show.
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
    """Return the noise for which the effect has its size within its bounds of amplitude."""
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
