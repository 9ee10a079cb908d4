"""The catalog of friction laws and effects, as the compiled core states it."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import polars as pl

from stribeck import _core
from stribeck.base.errors import SpecError, nearest

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from stribeck.models.rows import Catalog, EffectRow, LawRow


@lru_cache(maxsize=1)
def catalog() -> Catalog:
    """The tables of the core: ``{"laws": {id: row}, "effects": {id: row}}``, in catalog order.

    Examples
    --------
    >>> import stribeck as sb
    >>> law = sb.catalog()["laws"]["coulomb"]
    >>> [row["name"] for row in law["parameters"]]
    ['viscous_friction', 'coulomb_friction']
    """
    tables = _core.catalog()
    return {
        "laws": {row["id"]: row for row in tables["laws"]},
        "effects": {row["id"]: row for row in tables["effects"]},
    }


def law_ids() -> tuple[str, ...]:
    """Every law of the catalog."""
    return tuple(catalog()["laws"])


def law_row(law: str) -> LawRow | None:
    """The catalog's row of a law, whatever its number of elements; None for a law by formula."""
    return catalog()["laws"].get(law.partition(":")[0])


def effect_ids() -> tuple[str, ...]:
    """Every effect of the catalog, in the order in which a model applies them."""
    return tuple(catalog()["effects"])


def effect_row(effect: str) -> EffectRow | None:
    """The catalog's row of an effect; None for an effect by formula."""
    return catalog()["effects"].get(effect)


def constants_of(law: str, effects: Iterable[str]) -> list[str]:
    """Names of the constants that a law and its effects read.

    Examples
    --------
    >>> constants_of("hao_b", ["load"])
    ['base_temperature', 'reference_load']
    """
    rows = [law_row(law), *(effect_row(effect) for effect in effects)]
    return [name for row in rows if row is not None for name in row["constants"]]


def constants_read(
    constants: Mapping[str, float], law: str, effects: Iterable[str]
) -> dict[str, float]:
    """The constants without those of the catalog that neither the law nor its effects read."""
    read = constants_of(law, effects)
    known = {row["name"] for row in _core.catalog()["constants"]}
    return {name: x for name, x in constants.items() if name in read or name not in known}


def simpler_effect(effect: str) -> str | None:
    """The simpler effect that `effect` contains; None where there is none."""
    row = effect_row(effect)
    return None if row is None else row["beyond"]


def check_effect(effect: str) -> str:
    """Return `effect` if the catalog has it, else raise `SpecError` with the nearest name."""
    if effect not in effect_ids():
        if law_row(effect) is not None:
            raise SpecError(f"{effect!r} is a law, and a model has one law; an effect is needed")
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
    return _frame(catalog()["laws"])


def effects() -> pl.DataFrame:
    """The catalog of effects that can be missing, one row per effect.

    Examples
    --------
    >>> "load" in effects()["id"]
    True
    """
    return _frame(catalog()["effects"])


def _frame(table: Mapping[str, LawRow] | Mapping[str, EffectRow]) -> pl.DataFrame:
    rows: list[dict[str, object]] = []
    for row in table.values():
        flat = {key: value for key, value in row.items() if key != "parameters"}
        flat["parameters"] = [parameter["name"] for parameter in row["parameters"]]
        rows.append(flat)
    return pl.DataFrame(rows)
