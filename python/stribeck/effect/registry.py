"""Every effect of the catalog, each from its own file."""

from __future__ import annotations

import importlib
from functools import cache

from stribeck.effect.base import Effect
from stribeck.models.catalog import effect_ids


def effects() -> dict[str, Effect]:
    """Every effect by id, in catalog order."""
    return {name: of_catalog(name) for name in effect_ids()}


def find(effect: str) -> Effect | None:
    """The effect of this id; None for one by formula, which has no file."""
    return of_catalog(effect) if effect in effect_ids() else None


@cache
def of_catalog(effect: str) -> Effect:
    """The effect of an id of the catalog.

    The file is found by the id, so that a new effect needs no entry here.

    Raises
    ------
    ImportError
        The file is missing or does not define the effect.
    """
    name = f"stribeck.effect.{effect}"
    try:
        found: object = getattr(importlib.import_module(name), "EFFECT", None)
    except ModuleNotFoundError as error:
        if error.name != name:
            raise
        found = None
    if not isinstance(found, Effect) or found.id != effect:
        raise ImportError(
            f"effect {effect!r} is in the catalog of the core, so "
            f"python/stribeck/effect/{effect}.py must define EFFECT = Effect(id={effect!r}, ...)"
        )
    return found
