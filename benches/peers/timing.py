"""Two ways to do the same work, timed in turns."""

from __future__ import annotations

from collections.abc import Callable
from statistics import median
from time import perf_counter

from stribeck.effect.base import number


def seconds(work: Callable[[], object]) -> float:
    """Wall-clock seconds of one call."""
    begin = perf_counter()
    work()
    return perf_counter() - begin


def medians(
    ours: Callable[[], object], theirs: Callable[[], object], repeats: int
) -> tuple[float, float]:
    """Median seconds of interleaved repeats, after one call of each that is not counted."""
    ours(), theirs()
    pairs = [(seconds(ours), seconds(theirs)) for _ in range(repeats)]
    mine, other = (median(times) for times in zip(*pairs, strict=True))
    return mine, other


def line(
    what: str, peer: str, ours: Callable[[], object], theirs: Callable[[], object], repeats: int
) -> tuple[float, float]:
    """Print the medians and their ratio as a row of the table; the medians, s."""
    mine, other = medians(ours, theirs, repeats)
    ratio = f"{other / mine:.0f}" if other >= 100.0 * mine else f"{other / mine:.2g}"
    print(f"| {what} | {number(1e3 * mine)} ms | {peer}: {number(1e3 * other)} ms | {ratio} x |")
    return mine, other
