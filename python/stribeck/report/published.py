"""Published parameter sets as text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from stribeck.report.layout import joined, paragraph, table
from stribeck.report.numbers import listed, unit_text

if TYPE_CHECKING:
    from stribeck.models.published.sets import PublishedSet

#: Most parameters without a value that are named.
_MOST_NAMES = 6


def sets_text(found: Sequence[PublishedSet]) -> str:
    """The sets, one line each, and how one of them is used."""
    rows = [["id", "printed in", "parameters"]]
    for one in found:
        known, missing = len(one.printed), len(one.missing)
        rows.append([one.id, one.where, f"{known} of {known + missing}" if missing else str(known)])
    use = f"Show one with `stribeck published {found[0].id}`; use one as a model: published:ID."
    return joined(table(rows, right=(2,)), paragraph(use, 2))


def _missing(names: Sequence[str]) -> str:
    if len(names) > _MOST_NAMES:
        return f"{len(names)} other parameters of the law are not printed."
    return f"Not printed: {listed(list(names))}." if names else ""


def set_text(one: PublishedSet) -> str:
    """One set: its source, its values with units, and what was done to the print."""
    parameters = {p.symbol: p for p in one.model.parameters}
    rows = [["parameter", "symbol", "value", "unit"]]
    rows += [
        [
            parameters[symbol].name,
            symbol,
            f"{one.model.value(parameters[symbol].name):.10g}",
            unit_text(parameters[symbol].unit),
        ]
        for symbol in one.printed
    ]
    constants = [f"{name} = {value:g}" for name, value in one.model.constants.items()]
    said = [
        f"{one.paper}; {one.where}. {one.machine}.",
        one.rule,
        f"Constants: {listed(constants)}." if constants else "",
        _missing(one.missing),
        one.note,
    ]
    return joined(
        f"{one.id}: {one.model.spec}",
        table(rows, right=(2,)),
        "\n".join(paragraph(sentence, 2) for sentence in said if sentence),
    )
