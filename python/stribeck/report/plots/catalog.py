"""Figures of one law and of one effect of the catalog."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report.effect_example import EffectExample
from stribeck.report.finding import finding_panel, legend_of_panel
from stribeck.report.law_curve import LawCurve
from stribeck.report.style import COLOURS, headline, new_figure, style, zero_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["effect_figure", "law_figure"]

#: Line styles, so that conditions differ without colour too.
_STYLES = ("-", "--")


def law_figure(curve: LawCurve, title: str) -> Figure:
    """Friction over velocity, a line for each condition."""
    figure = new_figure(6.4, 4.2)
    axes = figure.add_subplot()
    style(axes)
    zero_line(axes)
    for (condition, friction), colour, line in zip(curve.curves, COLOURS, _STYLES, strict=False):
        axes.plot(curve.velocity, friction, line, color=colour, linewidth=1.6, label=condition.said)
    axes.set_xlabel(f"velocity [{curve.model.position_unit}/s]")
    axes.set_ylabel(f"friction [{curve.model.torque_unit}]")
    headline(figure, title, 10.5)
    if len(curve.curves) > 1:
        axes.legend(frameon=False, fontsize=9)
    return figure


def effect_figure(example: EffectExample, title: str) -> Figure:
    """The residual without and with the effect, where the effect shows."""
    figure = new_figure(6.4, 4.6)
    axes = figure.add_subplot()
    style(axes)
    finding_panel(axes, example.effect, example.without, example.with_it)
    headline(figure, title, 10.5)
    legend_of_panel(figure, axes, example.effect)
    return figure
