"""A reproduction as text for a terminal, and as a part of the documentation."""

from __future__ import annotations

from collections.abc import Iterable

from stribeck.benchmark.reproduce.result import Reproduction, Row
from stribeck.report.layout import bullets, joined, paragraph, table
from stribeck.report.numbers import plain

#: Digits of a number that a paper prints with at most five.
DIGITS = 4
#: Share of the tolerance below which a number is 0.
ROUNDING = 1e-9
_LIMITS = {"value": "", "at most": "≤ ", "at least": "≥ "}
HEADING = ("", "where", "quantity", "unit", "paper", "ours", "difference", "tolerance")


def cells(row: Row) -> tuple[str, ...]:
    """The cells of a row, as texts."""
    verdict = "ok" if row.within else "MISS"
    return (
        verdict,
        row.where,
        row.quantity,
        row.unit,
        f"{_LIMITS[row.meaning]}{plain(row.paper, DIGITS)}",
        _number(row.ours, row.tolerance, DIGITS),
        _number(row.difference, row.tolerance, 2),
        plain(row.tolerance, 2),
    )


def _number(value: float, tolerance: float, digits: int) -> str:
    """A number; rounding errors of the computer are shown as 0."""
    return "0" if abs(value) < ROUNDING * tolerance else plain(value, digits)


def verdict(made: Reproduction) -> str:
    """How many numbers are met."""
    total, missed = len(made.rows), len(made.missed)
    if not missed:
        return f"all {total} numbers are within their tolerances"
    return f"{total - missed} of {total} numbers are within their tolerances, {missed} are not"


def reasons(rows: Iterable[Row]) -> list[str]:
    """Each reason once, with the rows that it is for."""
    told: dict[str, list[str]] = {}
    for row in rows:
        places = told.setdefault(row.why, [])
        if row.where not in places:
            places.append(row.where)
    return [f"{', '.join(places)}: {why}" for why, places in told.items()]


def reproduction_text(made: Reproduction) -> str:
    """The rows, their tolerances with reasons, the data, and the figures."""
    return joined(
        paragraph(f"{made.title} ({made.source})", 0),
        bullets("Data", made.data),
        table([HEADING, *map(cells, made.rows)], right=(4, 5, 6, 7), indent=0),
        bullets("Why these tolerances", reasons(made.rows)),
        bullets("Without a counterpart", made.left_out),
        bullets("Figures", [f"{p.where}: {p.caption}" for p in made.pictures]),
        paragraph(f"{made.paper}: {verdict(made)}.", 0),
    )
