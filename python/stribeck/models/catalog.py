"""The catalog of friction laws and effects, as the compiled core states it."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import polars as pl

from stribeck import _core
from stribeck.base.errors import SpecError, nearest


@lru_cache(maxsize=1)
def catalog() -> dict[str, dict[str, dict[str, Any]]]:
    """The core's tables: ``{"laws": {id: row}, "effects": {id: row}}``, in catalog order."""
    tables = _core.catalog()
    return {kind: {row["id"]: row for row in tables[kind]} for kind in ("laws", "effects")}


def law_ids() -> tuple[str, ...]:
    """Every law of the catalog."""
    return tuple(catalog()["laws"])


def law_row(law: str) -> dict[str, Any]:
    """The catalog's row of a law, whatever its number of elements; empty for one by formula."""
    return catalog()["laws"].get(law.partition(":")[0], {})


def effect_ids() -> tuple[str, ...]:
    """Every effect of the catalog, in the order in which a model applies them."""
    return tuple(catalog()["effects"])


def check_effect(effect: str) -> str:
    """Return `effect` if the catalog has it, else raise `SpecError` with the nearest name."""
    if effect not in effect_ids():
        raise SpecError(
            f"effect {effect!r} is unknown{nearest(effect, effect_ids())}; "
            f"`stribeck effects` lists them"
        )
    return effect


def laws() -> pl.DataFrame:
    """The catalog of friction laws, one row per law.

    Examples
    --------
    >>> "coulomb" in laws()["id"]
    True
    """
    return _frame("laws")


def effects() -> pl.DataFrame:
    """The catalog of effects that can be missing, one row per effect.

    Examples
    --------
    >>> "load" in effects()["id"]
    True
    """
    return _frame("effects")


def _frame(kind: str) -> pl.DataFrame:
    rows = []
    for row in catalog()[kind].values():
        flat = {key: value for key, value in row.items() if key != "parameters"}
        flat["parameters"] = [p["name"] for p in row["parameters"]]
        rows.append(flat)
    return pl.DataFrame(rows)
