"""Groups of effects that are indistinguishable on a recording."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import StribeckError
from stribeck.diagnosis.visibility.model_space import ModelSpace
from stribeck.diagnosis.visibility.result import Group
from stribeck.diagnosis.visibility.smallest import VisibleEffect
from stribeck.diagnosis.visibility.subspace import orthonormal, sine_to_span
from stribeck.effect.registry import of_catalog
from stribeck.identify.problem import Problem
from stribeck.models.catalog import simpler_effect

Array = NDArray[np.float64]

#: Two effects are distinguishable if this many times the smallest visible size is enough for it.
DISTINGUISHED = 3.0
#: Sine of an angle below which no size is enough.
PARALLEL = 1e-8


def indistinguishable(
    visible: Sequence[VisibleEffect], problem: Problem, noise: float, unit: str
) -> tuple[Group, ...]:
    """Groups of effects in which each is indistinguishable from each other.

    Two effects are, if to distinguish them takes more than `DISTINGUISHED` times what it takes to
    see one, and more than the noise: the angle between their torques beside the model is too small.

    Parameters
    ----------
    noise
        RMS of the residual, in `unit`.
    """
    stride = ModelSpace(problem).stride
    model = ModelSpace(replace(problem, rows=problem.rows[::stride]))
    made: dict[str, tuple[VisibleEffect, Array, list[Array]]] = {}
    for one in visible:
        try:
            spaces = [orthonormal(model.outside(s)) for s in one.added.spaces(stride)]
        except StribeckError:
            continue
        made[one.effect] = (one, model.outside(one.torque[::stride, None])[:, 0], spaces)
    needed_for: dict[frozenset[str], float] = {}
    alike: dict[str, set[str]] = {effect: set() for effect in made}
    for effect, (one, left, _) in made.items():
        for other, (_, _, spaces) in made.items():
            if other == effect or _contains(effect, other) or _contains(other, effect):
                continue
            angle = min(sine_to_span(left, space) for space in spaces)
            needed = one.smallest / angle if angle > PARALLEL else np.inf
            if needed > max(DISTINGUISHED * one.smallest, noise):
                pair = frozenset((effect, other))
                needed_for[pair] = min(needed, needed_for.get(pair, np.inf))
                alike[effect].add(other)
                alike[other].add(effect)
    groups = [
        Group(
            tuple(e for e in made if e in members),
            max(needed_for[frozenset((a, b))] for a in members for b in members if a < b),
            unit,
        )
        for members in cliques(alike)
    ]
    return tuple(groups)


def _contains(effect: str, other: str) -> bool:
    """Whether an effect goes beyond another, or beyond what another contains as well."""
    simpler = simpler_effect(effect)
    return simpler is not None and other in (simpler, of_catalog(simpler).part_of)


def cliques(alike: dict[str, set[str]]) -> list[frozenset[str]]:
    """Largest sets of two or more in which each is alike each other (Bron and Kerbosch 1973).

    Examples
    --------
    >>> found = cliques({"a": {"b", "c"}, "b": {"a"}, "c": {"a"}})
    >>> sorted("".join(sorted(members)) for members in found)
    ['ab', 'ac']
    """
    found: list[frozenset[str]] = []

    def extend(members: frozenset[str], open_: set[str], closed: set[str]) -> None:
        if not open_ and not closed and len(members) > 1:
            found.append(members)
        for name in sorted(open_):
            extend(members | {name}, open_ & alike[name], closed & alike[name])
            open_ = open_ - {name}
            closed = closed | {name}

    extend(frozenset(), set(alike), set())
    return found
