"""The sections of a page that is made of tables."""

from __future__ import annotations

import re
from dataclasses import dataclass

from stribeck.report.numbers import MINUS

#: A number as tables write it: a sign, digits, an exponent, per cent.
_NUMBER = re.compile(rf"[{MINUS}+-]?\d[\d .]*(e[{MINUS}+-]?\d+)?( %)?")


@dataclass(frozen=True)
class Section:
    """A title, what is said, and tables whose first row is the heading."""

    title: str
    sentences: list[str]
    tables: list[list[list[str]]]


def numbers(rows: list[list[str]]) -> set[int]:
    """The columns of a table with a heading that hold numbers alone, and not in the first place.

    Examples
    --------
    >>> numbers([["joint", "RMSE", "unit"], ["1", "0.19", "N m"], ["2", "", "N m"]])
    {1}
    """
    return {
        k
        for k in range(1, len(rows[0]))
        if all(_NUMBER.fullmatch(row[k]) for row in rows[1:] if row[k])
        and any(row[k] for row in rows[1:])
    }
