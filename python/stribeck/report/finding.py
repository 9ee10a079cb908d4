"""The figure behind a finding: the residual against the channel that matters, before and after."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np

from stribeck.models.catalog import catalog
from stribeck.report.finding_view import finding_view, how_to_read
from stribeck.report.numbers import change_text, plain
from stribeck.report.style import (
    AFTER,
    BEFORE,
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
    legend_of_panel(figure, axes, effect)
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
    view = finding_view(effect, before, after)
    zero_line(axes)
    shown = []
    for curve, colour, label in (
        (view.without, BEFORE, "without"),
        (view.with_it, AFTER, "with"),
    ):
        if curve.at.size == 0:
            some = thin(np.arange(view.x.size))
            dots(axes, view.x[some], curve.samples[some], colour, label)
            shown.append(curve.samples)
            continue
        axes.fill_between(curve.at, curve.lower, curve.upper, color=colour, alpha=0.2, linewidth=0)
        axes.plot(
            curve.at, curve.median, "o-", color=colour, linewidth=1.8, markersize=3.5, label=label
        )
        shown += [curve.lower, curve.upper]
    limits(axes, shown)
    if view.log:
        axes.set_xscale("log")
    axes.set_xlabel(view.x_label)
    axes.set_ylabel(view.y_label)


def legend_of_panel(figure: Figure, axes: Axes, effect: str) -> None:
    """Put the legend of a panel below it, and how the panel is to be read."""
    figure.legend(
        *axes.get_legend_handles_labels(),
        loc="outside lower center",
        ncols=2,
        frameon=False,
        fontsize=9,
        title=panel_legend(effect),
        title_fontsize=8.5,
    )


def panel_legend(effect: str) -> str:
    """How a panel is to be read, in one or two lines."""
    return "\n".join(how_to_read(effect))
