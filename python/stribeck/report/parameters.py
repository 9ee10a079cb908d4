"""The table of parameters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from stribeck.report.layout import table
from stribeck.report.numbers import percent, unit_text, with_error

if TYPE_CHECKING:
    from stribeck.identify.estimates import Estimate

#: A standard error above this share of the value makes a parameter poorly determined.
POOR = 0.5


def _flags(e: Estimate) -> str:
    if e.held:
        return "fixed"
    flags = []
    if not e.identifiable:
        flags.append("not identifiable")
    if e.at_bound:
        if e.value > e.lower + 0.5 * (e.upper - e.lower):
            flags.append("at its upper bound")
        else:
            flags.append("zero: not needed here" if e.value == 0.0 else "at its lower bound")
    elif e.stderr is not None and e.value != 0.0 and e.identifiable:
        if e.stderr > POOR * abs(e.value):
            flags.append("poorly determined")
    return "; ".join(flags)


def parameter_rows(estimates: Iterable[Estimate]) -> list[list[str]]:
    """One row a parameter: name, symbol, value, error, unit, relative error, flags."""
    rows = []
    for e in estimates:
        value, error = with_error(e.value, e.stderr)
        known = e.stderr is not None and e.value != 0.0
        relative = percent((e.stderr or 0.0) / abs(e.value)) if known else ""
        error = f"± {error}" if error else ""
        rows.append([e.name, e.symbol, value, error, unit_text(e.unit), relative, _flags(e)])
    return rows


def parameters_text(estimates: Mapping[str, Estimate]) -> str:
    """The table of parameters."""
    heading = ["parameter", "symbol", "value", "error", "unit", "relative", ""]
    return table([heading, *parameter_rows(estimates.values())], right=(2, 5))
