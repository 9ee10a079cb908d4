"""A paper's numbers beside ours, and the counterparts of its figures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import polars as pl

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: How a printed number is meant: a value, or a limit that ours must keep.
Meaning = Literal["value", "at most", "at least"]


@dataclass(frozen=True)
class Row:
    """A printed number and its counterpart.

    Attributes
    ----------
    where, quantity, unit
        Place in the paper, what is printed there, and its unit.
    paper, ours
        The printed and the reproduced number.
    tolerance
        Largest difference that the rounding of the print and the data allow.
    why
        The reason for the tolerance.
    meaning
        Whether the paper prints a value or a limit.

    Examples
    --------
    >>> row = Row("table 1", "equivalent mass", "kg", 23.053, 23.0530, 5e-5, "last digit")
    >>> row.within
    True
    """

    where: str
    quantity: str
    unit: str
    paper: float
    ours: float
    tolerance: float
    why: str
    meaning: Meaning = "value"

    @property
    def difference(self) -> float:
        """Ours minus the paper's."""
        return self.ours - self.paper

    @property
    def within(self) -> bool:
        """Whether the difference is within the tolerance, or the limit is kept."""
        if not (math.isfinite(self.ours) and math.isfinite(self.tolerance)):
            return False
        if self.meaning == "at most":
            return self.difference <= self.tolerance
        if self.meaning == "at least":
            return self.difference >= -self.tolerance
        return abs(self.difference) <= self.tolerance

    def to_dict(self) -> dict[str, object]:
        """The row as JSON."""
        return {
            "where": self.where,
            "quantity": self.quantity,
            "unit": self.unit,
            "paper": self.paper,
            "ours": self.ours,
            "difference": self.difference,
            "tolerance": self.tolerance,
            "meaning": self.meaning,
            "within": self.within,
            "why": self.why,
        }


@dataclass(frozen=True)
class Picture:
    """The counterpart of one figure.

    Attributes
    ----------
    name
        Stem of the file.
    where
        The figure of the paper.
    caption
        What it shows, and how it compares with the paper's.
    figure
        The drawing.
    """

    name: str
    where: str
    caption: str
    figure: Figure


@dataclass(frozen=True)
class Reproduction:
    """Tables and figures of one paper.

    Attributes
    ----------
    paper, title, source
        Name on the command line; title and authors of the paper.
    data
        Which data the paper leaves out, and what stands in for them; one sentence each.
    left_out
        Tables and figures without a counterpart, with the reason.
    rows, pictures
        Numbers and figures, in the order of the paper.
    """

    paper: str
    title: str
    source: str
    data: tuple[str, ...]
    left_out: tuple[str, ...]
    rows: tuple[Row, ...]
    pictures: tuple[Picture, ...]

    @property
    def missed(self) -> tuple[Row, ...]:
        """The rows outside their tolerance."""
        return tuple(row for row in self.rows if not row.within)

    def to_dict(self, figures: Sequence[str] = ()) -> dict[str, object]:
        """The JSON of ``stribeck reproduce``.

        Parameters
        ----------
        figures
            Paths of the written figures.
        """
        return {
            "paper": self.paper,
            "title": self.title,
            "source": self.source,
            "data": list(self.data),
            "left_out": list(self.left_out),
            "within": len(self.rows) - len(self.missed),
            "rows": [row.to_dict() for row in self.rows],
            "figures": list(figures),
        }

    def to_frame(self) -> pl.DataFrame:
        """The rows as a table."""
        return pl.DataFrame([row.to_dict() for row in self.rows])


def last_digit(text: str) -> float:
    """Half a unit of the last printed digit.

    Examples
    --------
    >>> last_digit("23.0530"), last_digit("2.32e-2")
    (5e-05, 5e-05)
    """
    mantissa, _, exponent = text.lower().partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 0.5 * 10.0 ** (int(exponent or 0) - decimals)
