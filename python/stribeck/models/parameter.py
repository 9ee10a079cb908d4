"""One parameter of a model, and how its unit is written for a joint."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from stribeck.base.dimensions import Powers
from stribeck.models.formula_law import FormulaTerms

if TYPE_CHECKING:
    from stribeck.models.rows import ParameterRow


@dataclass(frozen=True)
class Parameter:
    """What one parameter is: its name, symbol in the literature, unit and bounds.

    `lower`, `upper`, `start` and `drawn`, the range of random starts, are in `unit` once the model
    is scaled to a recording, and multiples of `scale` before. A formula's parameter has no bounds
    unless they are stated. Where no start is stated it follows from the parameter's `dimension`,
    and `start` is NaN.

    Examples
    --------
    >>> import stribeck as sb
    >>> first = sb.model("coulomb").parameters[0]
    >>> first.name, first.symbol
    ('viscous_friction', 'a1')
    """

    name: str
    symbol: str
    unit: str
    lower: float
    upper: float
    start: float
    scale: str
    linear: bool
    role: str
    description: str
    dimension: Powers | None = None
    drawn: tuple[float, float] = (-math.inf, math.inf)

    @classmethod
    def of(cls, row: ParameterRow, load_unit: str, position_unit: str) -> Parameter:
        """The parameter of a catalog row, in the units of a joint."""
        return cls(
            name=row["name"],
            symbol=row["symbol"],
            unit=joint_unit(row["unit"], load_unit, position_unit),
            lower=row["lower"],
            upper=row["upper"],
            start=row["start"],
            scale=row["scale"],
            linear=row["linear"],
            role=row["role"],
            description=row["description"],
            drawn=row.get("drawn", (row["lower"], row["upper"])),
        )


def declared(
    parameter: Parameter, terms: FormulaTerms | None, load_unit: str, position_unit: str
) -> Parameter:
    """A formula's parameter with what the formula and its user state about it.

    A parameter of the catalog, without `terms`, is unchanged.
    """
    if terms is None:
        return parameter
    k = terms.names.index(parameter.name)
    stated = terms.declarations[k]
    return replace(
        parameter,
        unit=terms.units(load_unit, position_unit)[k],
        lower=stated.lower,
        upper=stated.upper,
        start=math.nan if stated.start is None else stated.start,
        drawn=(stated.lower, stated.upper),
        dimension=terms.dimensions[k],
    )


def joint_unit(unit: str, load_unit: str, position_unit: str) -> str:
    """Write a unit of the catalog (T torque or force, X position) for a joint.

    Parameters
    ----------
    unit
        As the catalog writes it.
    load_unit
        Unit of loads and friction.
    position_unit
        ``"rad"`` or ``"m"``.

    Examples
    --------
    >>> joint_unit("T s/X", "N m", "rad"), joint_unit("1/T", "N m", "rad")
    ('N m s/rad', '1/(N m)')
    """
    if unit == "T s2/X" and load_unit in ("N m", "N"):
        return "kg m2" if position_unit == "rad" else "kg"
    written = {"T": load_unit, "X": position_unit}

    def replaced(found: re.Match[str]) -> str:
        before, letter, power = found.groups()
        word = written[letter]
        # A divisor or a power of two words needs brackets: 1/(N m), (N m)2.
        several = " " in word and (before or power)
        return f"{before}({word}){power}" if several else f"{before}{word}{power}"

    return re.sub(r"(/?)\b([TX])(\d*)\b", replaced, unit)
