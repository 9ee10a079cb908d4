"""The figure behind a finding: the residual against the channel that matters, before and after."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.residual.regimes import REVERSAL_WINDOW, regime_rows
from stribeck.models.catalog import catalog
from stribeck.report.channels import channel, clock, load_of, view_of
from stribeck.report.numbers import change_text, plain
from stribeck.report.style import (
    AFTER,
    BEFORE,
    binned_quartiles,
    dots,
    headline,
    limits,
    new_figure,
    style,
    thin,
    zero_line,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stribeck.diagnosis.result import Finding
    from stribeck.fitting.result import Fit

#: What the residual is multiplied by, as its label says.
ALONG = {None: "", "motion": " · sgn v", "load": " · sgn load"}
#: Which samples are drawn, where it is not all of them.
REGIMES = {
    "low_speed": "slowest quarter of the samples",
    "high_speed": "fastest quarter of the samples",
    "sliding": f"samples more than {REVERSAL_WINDOW} s from a reversal",
}


def finding_figure(finding: Finding, *, headed: bool = True) -> Figure:
    """The residual without and with the effect, in bins of the channel in which it shows.

    Lines are medians, bands hold the middle half of the samples. Only the samples that were fitted
    to are drawn, one by one where they are too few for bins.

    Parameters
    ----------
    headed : bool
        Whether the title of the effect and the sentence on where it shows stand above.
    """
    effect = finding.effect
    figure = new_figure(7.6, 5.0)
    axes = figure.add_subplot()
    style(axes)
    finding_panel(axes, effect, finding.before, finding.fit)
    if headed:
        headline(figure, _headline(finding), 10.5)
    _name_errors(axes, finding)
    figure.legend(
        *axes.get_legend_handles_labels(),
        loc="outside lower center",
        ncols=2,
        frameon=False,
        fontsize=9,
        title=panel_legend(effect),
        title_fontsize=8.5,
    )
    return figure


def _headline(finding: Finding) -> str:
    """The effect, and in one sentence where the data shows it."""
    known = catalog()["effects"].get(finding.effect)
    name = f"{finding.effect}: {known['title']}" if known else finding.effect
    sentence = f"{finding.where[:1].upper()}{finding.where[1:]}."
    return "\n".join([name, textwrap.fill(sentence, 92)])


def _name_errors(axes: Axes, finding: Finding) -> None:
    """Put the held-out errors without and with the effect into the legend."""
    before, after = finding.rmse_held_out_before, finding.rmse_held_out_after
    unit = finding.fit.model.torque_unit
    texts = {
        "without": f"without {finding.effect}: held-out error {plain(before)} {unit}",
        "with": f"with {finding.effect}: {plain(after)} {unit} ({change_text(before, after)})",
    }
    for line in axes.get_lines():
        label = str(line.get_label())
        line.set_label(texts.get(label, label))


def finding_panel(axes: Axes, effect: str, before: Fit, after: Fit) -> None:
    """Draw the residuals of two models against the channel in which an effect shows."""
    view = view_of(effect)
    made, along = channel(after, view.channel), view.along
    if made is None:
        made, along = channel(after, "velocity") or clock(after.recording), None
    rows = _rows(before, view.regime)
    sign = _sign(after, along)
    x = made.values[rows]
    zero_line(axes)
    shown = []
    for fit, colour, label in ((before, BEFORE, "without"), (after, AFTER, "with")):
        y = (fit.residual * sign)[rows]
        at, lower, median, upper = binned_quartiles(x, y, log=view.log)
        if at.size == 0:
            some = thin(np.arange(x.size))
            dots(axes, x[some], y[some], colour, label)
            shown.append(y)
            continue
        axes.fill_between(at, lower, upper, color=colour, alpha=0.2, linewidth=0)
        axes.plot(at, median, "o-", color=colour, linewidth=1.8, markersize=3.5, label=label)
        shown += [lower, upper]
    limits(axes, shown)
    if view.log and np.all(x[x != 0] > 0):
        axes.set_xscale("log")
    axes.set_xlabel(made.label)
    axes.set_ylabel(f"residual{ALONG[along]} [{before.model.torque_unit}]")


def panel_legend(effect: str) -> str:
    """How a panel is to be read, in one or two lines."""
    view = view_of(effect)
    notes = ["above 0: the model has too little friction"] if view.along == "motion" else []
    if view.regime is not None:
        notes.append(REGIMES[view.regime])
    return "\n".join(["line: median, band: middle half", *(["; ".join(notes)] if notes else [])])


def _sign(fit: Fit, along: str | None) -> NDArray[np.float64]:
    """What the residual is multiplied by, [n]."""
    if along is None:
        return np.ones_like(fit.residual)
    load = load_of(fit) if along == "load" else None
    return np.sign(fit.recording.velocity if load is None else load)


def _rows(fit: Fit, regime: str | None) -> NDArray[np.intp]:
    """The samples that were fitted to, or those of them in a regime."""
    if regime is None:
        return fit.rows
    regimes = regime_rows(fit)
    inside = ~regimes["reversal"] if regime == "sliding" else regimes[regime]
    return np.flatnonzero(inside & fit.recording.moving & ~fit.transient)
