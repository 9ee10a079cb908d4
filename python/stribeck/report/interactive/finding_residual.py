"""The evidence for one effect: the residual without and with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from bokeh.models import ColumnDataSource, Range1d

from stribeck.report.finding_view import finding_view
from stribeck.report.interactive.base import (
    COLOURS,
    hover,
    legend_above,
    new_plot,
    shown_range,
    zero_line,
)
from stribeck.report.style import thin

if TYPE_CHECKING:
    from bokeh.models import GlyphRenderer
    from bokeh.plotting import figure

    from stribeck.fitting.result import Fit


def finding_residual(effect: str, before: Fit, after: Fit) -> figure:
    """Residuals in bins of the channel in which an effect shows.

    Lines are medians and bands the middle half of the samples that were fitted to; where they are
    too few for bins, they are drawn one by one.

    Parameters
    ----------
    effect : str
        Id of an effect, or the name of one by formula.
    before, after : Fit
        The models without and with it.
    """
    view = finding_view(effect, before, after)
    plot = new_plot(
        view.x_label,
        view.y_label,
        tools="pan,box_zoom,reset,save",
        active=None,
        height=300,
        x_axis_type="log" if view.log else "auto",
    )
    zero_line(plot)
    items: list[tuple[str, list[GlyphRenderer]]] = []
    limited = []
    unit = before.model.torque_unit
    for curve, colour, label in (
        (view.without, COLOURS[0], f"without {effect}"),
        (view.with_it, COLOURS[1], f"with {effect}"),
    ):
        if curve.at.size == 0:
            some = thin(np.arange(view.x.size))
            points = ColumnDataSource({"at": view.x[some], "mid": curve.samples[some]})
            shown = [plot.scatter("at", "mid", source=points, color=colour, size=5, alpha=0.6)]
            limited.append(curve.samples)
        else:
            source = ColumnDataSource(
                {"at": curve.at, "lo": curve.lower, "mid": curve.median, "hi": curve.upper}
            )
            shown = [
                plot.varea("at", "lo", "hi", source=source, color=colour, alpha=0.22),
                plot.line("at", "mid", source=source, color=colour, line_width=2.2),
                plot.scatter("at", "mid", source=source, color=colour, size=5),
            ]
            limited += [curve.lower, curve.upper]
        hover(plot, shown[-1:], [(label, f"@mid{{0.0000}} {unit}"), (view.x_label, "@at{0.000}")])
        items.append((label, shown))
    limits = shown_range(limited)
    if limits is not None:
        plot.y_range = Range1d(*limits)
    legend_above(plot, items)
    return plot
