"""The generators by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from stribeck.benchmark import closed_loop, open_loop
from stribeck.benchmark.sample import Sample


@dataclass(frozen=True)
class Generator:
    """A generator of recordings.

    Attributes
    ----------
    effects, outside
        Effects that it can hide, inside and outside the library.
    limits
        Limited motions, and the effects that each cannot show.
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
