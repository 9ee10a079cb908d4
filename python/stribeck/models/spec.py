"""The spec of a model, ``law+effect+...``."""

from __future__ import annotations

from collections.abc import Sequence

from stribeck.base.errors import SpecError, nearest
from stribeck.models.catalog import catalog, check_effect, effect_ids, law_ids

#: Most elements of a law with elements.
MOST_ELEMENTS = 16


def parse_spec(spec: str) -> tuple[str, tuple[str, ...]]:
    """Split ``"coulomb+load+stribeck"`` into the law and its effects, in catalog order.

    Examples
    --------
    >>> parse_spec("coulomb+load+stribeck")
    ('coulomb', ('stribeck', 'load'))
    """
    law, *effects = [word.strip() for word in spec.split("+")]
    name, _, elements = law.partition(":")
    if name not in law_ids():
        raise SpecError(
            f"law {law!r} is unknown{nearest(name, law_ids())}; `stribeck models` lists them"
        )
    if elements or law.endswith(":"):
        _check_elements(law, name, elements)
    return law, parse_effects(effects)


def parse_effects(effects: Sequence[str]) -> tuple[str, ...]:
    """Check the ids of effects and sort them in catalog order."""
    for effect in effects:
        check_effect(effect)
        if effects.count(effect) > 1:
            raise SpecError(f"effect {effect!r} is given twice: leave one out")
    return tuple(sorted(effects, key=effect_ids().index))


def _check_elements(law: str, name: str, elements: str) -> None:
    """Refuse a number of elements that the law cannot have."""
    if "elements" not in catalog()["laws"][name]["constants"]:
        raise SpecError(f"law {name!r} has no elements: write {name}, not {law}")
    if not elements.isdecimal() or not 1 <= int(elements) <= MOST_ELEMENTS:
        raise SpecError(
            f"law {law!r} asks for {elements!r} elements: give a number from 1 to {MOST_ELEMENTS}, "
            f"as in {name}:4"
        )
