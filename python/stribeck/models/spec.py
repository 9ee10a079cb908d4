"""The spec of a model, ``law+effect+...``."""

from __future__ import annotations

from collections.abc import Sequence

from stribeck.base.errors import SpecError, nearest
from stribeck.models.catalog import catalog, check_effect, effect_ids, law_ids, law_row

#: Most elements of a law with elements.
MOST_ELEMENTS = 16
#: The law that is suggested where none is given: dry and viscous friction alone.
PLAIN = "coulomb"


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
        _refuse_law(law, effects)
    if elements or law.endswith(":"):
        _check_elements(law, name, elements)
    for effect in effects:
        _refuse_term(name, effect)
    return law, parse_effects(effects)


def parse_effects(effects: Sequence[str]) -> tuple[str, ...]:
    """Check the ids of effects and sort them in catalog order."""
    for effect in effects:
        check_effect(effect)
        if effects.count(effect) > 1:
            raise SpecError(f"effect {effect!r} is given twice: leave one out")
    return tuple(sorted(effects, key=effect_ids().index))


def _refuse_law(law: str, others: Sequence[str]) -> None:
    """Say what a first word is that is no law."""
    name = law.partition(":")[0]
    if name in effect_ids():
        first = next((other for other in others if law_row(other) is not None), PLAIN)
        words = [first, name, *(other for other in others if other != first)]
        raise SpecError(f"{name!r} is an effect, which is added to a law: write {'+'.join(words)}")
    part = _part_of(PLAIN, name)
    if part is None:
        hint = nearest(name, law_ids())
    else:
        hint = f"; law {PLAIN!r} includes {name} friction (parameter {part})"
    raise SpecError(f"law {law!r} is unknown{hint}; `stribeck models` lists them")


def _refuse_term(law: str, effect: str) -> None:
    """Say what a word after the law is that is no effect, where that is known."""
    if effect in effect_ids():
        return
    if effect.partition(":")[0] == law:
        raise SpecError(f"{effect!r} is the law of this model already: leave the second one out")
    part = _part_of(law, effect)
    if part is not None:
        raise SpecError(f"law {law!r} includes {effect} friction (parameter {part}): leave it out")


def _part_of(law: str, word: str) -> str | None:
    """The parameter of `law` named after a kind of friction, such as ``viscous_friction``."""
    names = (row["name"] for row in catalog()["laws"][law]["parameters"])
    return next((name for name in names if name == f"{word}_friction"), None)


def _check_elements(law: str, name: str, elements: str) -> None:
    """Refuse a number of elements that the law cannot have."""
    if "elements" not in catalog()["laws"][name]["constants"]:
        raise SpecError(f"law {name!r} has no elements: write {name}, not {law}")
    if not elements.isdecimal() or not 1 <= int(elements) <= MOST_ELEMENTS:
        raise SpecError(
            f"law {law!r} asks for {elements!r} elements: give a number from 1 to {MOST_ELEMENTS}, "
            f"as in {name}:4"
        )
