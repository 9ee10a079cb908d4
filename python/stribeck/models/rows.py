"""Rows of the compiled core's catalog, as types."""

from __future__ import annotations

from typing import TypedDict

__all__ = ["Catalog", "ConstantRow", "CoreCatalog", "EffectRow", "LawRow", "ParameterRow"]


class _StatedParameter(TypedDict):
    name: str
    symbol: str
    unit: str
    lower: float
    upper: float
    start: float
    scale: str
    role: str
    description: str


class ParameterRow(_StatedParameter, total=False):
    """One parameter of a law or an effect.

    ``unit`` is written with T for torque or force and X for position; ``lower``, ``upper`` and
    ``start`` are multiples of ``scale``, and so is ``drawn``, the range of random starts
    (default: the bounds). ``linear`` is stated of a compiled model's parameters.
    """

    linear: bool
    drawn: tuple[float, float]


class LawRow(TypedDict):
    """One friction law. ``pole`` names a temperature at which the law has no limit."""

    id: str
    title: str
    source: str
    formula: str
    parameters: list[ParameterRow]
    channels: list[str]
    constants: list[str]
    pole: str | None
    captures: list[str]


class EffectRow(TypedDict):
    """One effect. ``beyond`` names the simpler effect that it contains, if there is one."""

    id: str
    group: str
    title: str
    what: str
    formula: str
    needs: str
    beyond: str | None
    channels: list[str]
    constants: list[str]
    parameters: list[ParameterRow]


class ConstantRow(TypedDict):
    """One constant of laws or effects, with its default value."""

    name: str
    unit: str
    default: float
    description: str


class CoreCatalog(TypedDict):
    """The tables as the core lists them."""

    laws: list[LawRow]
    effects: list[EffectRow]
    constants: list[ConstantRow]


class Catalog(TypedDict):
    """The tables by id, in catalog order."""

    laws: dict[str, LawRow]
    effects: dict[str, EffectRow]
