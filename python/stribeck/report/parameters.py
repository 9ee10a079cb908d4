"""The table of parameters."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from stribeck.identify.errors.estimates import poorly_determined
from stribeck.report.layout import paragraph, table
from stribeck.report.numbers import (
    MINUS,
    listed,
    minus_signs,
    percent,
    plain,
    thousands,
    unit_text,
    with_error,
)

if TYPE_CHECKING:
    from stribeck.identify.errors.confounded import Combination
    from stribeck.identify.errors.estimates import Estimate
    from stribeck.identify.errors.information import Information
    from stribeck.identify.errors.matrix import ParameterMatrix
    from stribeck.models.model import Model

#: Pairs of parameters with a correlation of at least this size are named.
STRONG = 0.95


def _flags(e: Estimate, poor: Collection[str]) -> str:
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
    elif e.name in poor:
        flags.append("poorly determined")
    return "; ".join(flags)


def parameter_rows(estimates: Iterable[Estimate]) -> list[list[str]]:
    """One row a parameter: name, symbol, value, error, unit, relative error, flags."""
    rows = []
    estimates = list(estimates)
    poor = poorly_determined(estimates)
    for e in estimates:
        value, error = with_error(e.value, e.stderr)
        known = e.stderr is not None and e.value != 0.0
        relative = percent((e.stderr or 0.0) / abs(e.value)) if known else ""
        error = f"± {error}" if error else ""
        rows.append([e.name, e.symbol, value, error, unit_text(e.unit), relative, _flags(e, poor)])
    return rows


def parameters_text(estimates: Mapping[str, Estimate], intervals: bool = False) -> str:
    """The table of parameters; 95 % intervals take the place of symbols and relative errors."""
    heading = ["parameter", "symbol", "value", "error", "unit", "relative", ""]
    rows = [heading, *parameter_rows(estimates.values())]
    if not intervals:
        return table(rows, right=(2, 5), whole=(0, 1, 3, 4))
    column = ["95 % interval", *(interval_text(e) for e in estimates.values())]
    return table(
        [
            [name, value, error, interval, unit, flags]
            for (name, _, value, error, unit, _, flags), interval in zip(rows, column, strict=True)
        ],
        right=(1,),
        whole=(0,),
    )


def per_run_text(per_run: Mapping[str, Mapping[str, Estimate]]) -> str:
    """The values of each run, one column a parameter; nothing where all runs share them."""
    if not per_run:
        return ""
    runs = list(next(iter(per_run.values())))
    rows = [["run", *(f"{name} [{_unit(es)}]" for name, es in per_run.items())]]
    for run in runs:
        cells = [_with_error(of_runs[run]) for of_runs in per_run.values()]
        rows.append([run, *cells])
    words = f"Values of each run; {listed(list(per_run))} above: the mean."
    return paragraph(words) + "\n\n" + table(rows)


def _unit(of_runs: Mapping[str, Estimate]) -> str:
    return unit_text(next(iter(of_runs.values())).unit)


def _with_error(e: Estimate) -> str:
    value, error = with_error(e.value, e.stderr)
    flags = _flags(e, poorly_determined([e]))
    shown = f"{value} ± {error}".removesuffix(" ± ")
    return shown + (f" ({flags})" if flags else "")


def interval_text(e: Estimate) -> str:
    """The interval, each end with two digits of half its distance from the value."""
    if e.ci95 is None:
        return ""

    def shown(end: float) -> str:
        if end == 0.0:
            return "0"
        text = "∞" if math.isinf(end) else with_error(abs(end), 0.5 * abs(end - e.value) or None)[0]
        return MINUS + text if end < 0.0 else text

    return f"{shown(e.ci95[0])} to {shown(e.ci95[1])}"


def temperature_text(model: Model) -> str:
    """At which temperature the parameters hold that change with it."""
    at = model.constants.get("reference_temperature")
    if at is None:
        return ""
    return paragraph(f"Friction that changes with the temperature is given at {at:.1f} degC.", 2, 2)


def open_text(estimates: Mapping[str, Estimate]) -> str:
    """Which parameters the data does not bound."""
    ends = [(name, e, side) for name, e in estimates.items() for side in e.open]
    zero = [name for name, e, side in ends if side == "lower" and e.lower == 0.0]
    below = [name for name, e, side in ends if side == "lower" and e.lower != 0.0]
    above = [name for name, e, side in ends if side == "upper"]
    groups = (
        ("Not bounded above by these data", above),
        ("Not bounded below by these data", below),
        ("Not distinguished from zero by these data", zero),
    )
    return "\n".join(
        paragraph(f"{words}: {listed(names)}.", 2, 2) for words, names in groups if names
    )


def not_identifiable_text(
    estimates: Mapping[str, Estimate], combinations: Sequence[Combination]
) -> str:
    """Why parameters are not identifiable, and what is determined instead."""
    lines = [
        paragraph(f"{name} is not identifiable: {e.why}.", 2, 2)
        for name, e in estimates.items()
        if e.why is not None
    ]
    if combinations:
        found = "; ".join(_combination(c) for c in combinations)
        what = "these combinations are" if len(combinations) > 1 else "this combination is"
        lines.append(paragraph(f"Only {what} determined: {found}.", 2, 2))
    return "\n".join(lines)


def poorly_determined_text(names: Sequence[str], combinations: Sequence[Combination]) -> str:
    """Which parameters are not determined, and which combinations of them are."""
    if not names:
        return ""
    said = f"Not determined, or only poorly: {listed(list(names))}."
    if combinations:
        said += f" Better known: {'; '.join(_combination(c) for c in combinations)}."
    return paragraph(said, 2, 2)


def _combination(c: Combination) -> str:
    value, error = with_error(c.factor * c.value, c.factor * c.stderr)
    unit = "" if c.unit == "1" else f" {c.unit}"
    near = " (near these values)" if c.local else ""
    return f"{c.text.replace(' - ', f' {MINUS} ')} = {value} ± {error}{unit}{near}"


def correlation_text(correlation: ParameterMatrix | None) -> str:
    """The pairs of parameters that are strongly correlated."""
    pairs = [] if correlation is None else correlation.pairs(STRONG)
    if not pairs:
        return ""
    named = [f"{one} and {other} ({minus_signs(f'{value:.3f}')})" for one, other, value in pairs]
    return paragraph(
        f"Strongly correlated estimates: {listed(named)}. An error of one is compensated by the "
        f"other."
    )


def effective_text(found: Information) -> str:
    """The effective number of samples, and what it follows from."""
    length = found.samples / found.effective
    return (
        f"{thousands(round(found.effective))} effective samples: {thousands(found.samples)} over "
        f"the correlation length {plain(length)}"
    )
