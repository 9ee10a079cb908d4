"""Published parameter sets by id, as models."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from importlib import resources
from pathlib import Path
from typing import TypedDict, cast

import polars as pl

from stribeck.base.arguments import door
from stribeck.base.errors import ModelFileError, SpecError, nearest
from stribeck.base.toml import TomlText
from stribeck.models.build import with_values
from stribeck.models.model import Model
from stribeck.models.spec import parse_spec

#: Before an id where a model file could stand as well.
PREFIX = "published:"


class _Shared(TypedDict, total=False):
    """What a source states once, or each of its sets."""

    paper: str
    machine: str
    position_unit: str
    torque_unit: str
    rule: str
    note: str


class _Row(_Shared):
    """One set of a source; `by_size` lists symbols that the law reads by size alone."""

    id: str
    where: str
    law: str
    printed: Mapping[str, float]


class _Options(TypedDict, total=False):
    by_size: list[str]
    rigid_body: list[str]
    constants: Mapping[str, float]
    box: Mapping[str, tuple[float, float]]


class _Source(_Shared):
    set: list[_Row]


@dataclass(frozen=True)
class PublishedSet:
    """One parameter set as its source prints it.

    Attributes
    ----------
    id
        ``SOURCE/TABLE/.../LAW``.
    paper, where, machine
        The source, the place in it, and what was measured.
    printed
        The numbers as printed, by symbol of the law.
    model
        The law with these values; NaN where the source prints none.
    rule
        How printed names and signs became those of the law.
    note
        What the source does not print, or prints wrongly; empty if there is nothing.

    Examples
    --------
    >>> from stribeck.models.published.sets import published_set
    >>> one = published_set("ur5e_review/table_7/joint_1/coulomb")
    >>> one.where, dict(one.printed), one.missing
    ('table 7, Coulomb', {'a1': 12.35, 'a2': 10.3}, ())
    >>> one.model.value("coulomb_friction")
    10.3
    """

    id: str
    paper: str
    where: str
    machine: str
    printed: Mapping[str, float]
    model: Model = field(repr=False)
    rule: str
    note: str

    @property
    def missing(self) -> tuple[str, ...]:
        """Parameters that the source does not print."""
        values = zip(self.model.names, self.model.values, strict=True)
        return tuple(name for name, value in values if value != value)

    def to_dict(self) -> dict[str, object]:
        """The set as JSON, with the parameters in SI units."""
        symbols = {p.symbol: p for p in self.model.parameters}
        value = dict(zip(self.model.names, self.model.values.tolist(), strict=True))
        return {
            "id": self.id,
            "model": self.model.spec,
            "paper": self.paper,
            "where": self.where,
            "machine": self.machine,
            "parameters": {
                symbols[symbol].name: {
                    "symbol": symbol,
                    "value": value[symbols[symbol].name],
                    "printed": number,
                    "unit": symbols[symbol].unit,
                }
                for symbol, number in self.printed.items()
            },
            "missing": list(self.missing),
            "constants": dict(self.model.constants),
            "box": {name: list(ends) for name, ends in self.model.box.items()},
            "rule": self.rule,
            "note": self.note,
        }


@lru_cache(maxsize=1)
def every_set() -> Mapping[str, PublishedSet]:
    """All sets by id, source after source."""
    folder = resources.files(__package__)
    names = sorted(entry.name for entry in folder.iterdir() if entry.name.endswith(".toml"))
    made: dict[str, PublishedSet] = {}
    for name in names:
        path = Path(name)
        text = TomlText(path, (folder / name).read_text(encoding="utf-8"), ModelFileError)
        source = cast(_Source, text.parsed())
        for row in source["set"]:
            found = _made(path.stem, source, row)
            made[found.id] = found
    return made


def _made(stem: str, source: _Source, row: _Row) -> PublishedSet:
    options = cast(_Options, row)
    by_size = options.get("by_size", [])
    values = {
        symbol: abs(float(number)) if symbol in by_size else float(number)
        for symbol, number in row["printed"].items()
    }
    said = cast(_Shared, {**source, **row})
    law, effects = parse_spec(row["law"])
    bare = Model(
        law=law,
        effects=effects,
        constants=options.get("constants", {}),
        rigid_body=tuple(options.get("rigid_body", [])),
    )
    filled = replace(
        with_values(bare, values),
        torque_unit=said["torque_unit"],
        position_unit=said["position_unit"],
        box={name: (low, high) for name, (low, high) in options.get("box", {}).items()},
    )
    rules = [said.get("rule", "")]
    if by_size:
        rules.append(f"{', '.join(by_size)} enters the law by its size.")
    notes = [note for note in (source.get("note"), row.get("note")) if note]
    return PublishedSet(
        id=f"{stem}/{row['id']}",
        paper=said["paper"],
        where=row["where"],
        machine=said["machine"],
        printed=row["printed"],
        model=filled,
        rule=" ".join(rules),
        note=" ".join(notes),
    )


def published_set(id: str) -> PublishedSet:
    """A set by its id, with or without ``published:`` before it.

    Raises
    ------
    SpecError
        There is no such set.
    """
    name = id.removeprefix(PREFIX)
    found = every_set().get(name)
    if found is None:
        raise SpecError(
            f"published set {name!r} is unknown{nearest(name, every_set())}; "
            f"`stribeck published` lists them"
        )
    return found


@door(id=("the id of a published set", str))
def published(id: str) -> Model:
    """A law with the parameter values that a paper prints.

    Parameters
    ----------
    id : str
        As `published_sets` lists them.

    Returns
    -------
    Model
        Values in SI units and degC; NaN where the paper prints none.

    Raises
    ------
    SpecError
        There is no such set.

    Examples
    --------
    >>> published("ur5e_review/table_7/joint_1/coulomb").torque([-1.0, 1.0])
    array([-22.65,  22.65])
    """
    return published_set(id).model


def published_sets() -> pl.DataFrame:
    """The published parameter sets: id, law, paper and place in it.

    Examples
    --------
    >>> "gantry/table_1/gantry_map" in published_sets()["id"]
    True
    """
    return pl.DataFrame(
        [
            {
                "id": one.id,
                "law": one.model.spec,
                "paper": one.paper,
                "where": one.where,
                "machine": one.machine,
                "missing": list(one.missing),
            }
            for one in every_set().values()
        ],
        schema_overrides={"missing": pl.List(pl.String)},
    )
