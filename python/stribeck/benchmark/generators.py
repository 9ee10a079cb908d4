"""The generators by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from stribeck.benchmark import closed_loop, open_loop
from stribeck.benchmark.sample import Sample


@dataclass(frozen=True)
class Generator:
    """What the benchmark asks of a generator.

    Attributes
    ----------
    effects, outside
        What it can hide, of the library of effects and outside it.
    limits
        Restricted motions, and the effects that each cannot show.
    """

    name: str
    effects: Sequence[str]
    outside: Sequence[str]
    limits: Mapping[str, Sequence[str]]
    make: Callable[..., Sample]


GENERATORS = {
    "open_loop": Generator(
        "open_loop", open_loop.EFFECTS, open_loop.OUTSIDE, open_loop.LIMITS, open_loop.sample
    ),
    "closed_loop": Generator(
        "closed_loop",
        closed_loop.EFFECTS,
        closed_loop.OUTSIDE,
        closed_loop.LIMITS,
        closed_loop.sample,
    ),
}
