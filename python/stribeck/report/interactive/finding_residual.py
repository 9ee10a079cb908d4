"""The evidence for one effect: the residual without and with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from bokeh.models import ColumnDataSource

from stribeck.report.finding_view import FindingView, finding_view
from stribeck.report.interactive.base import (
    COLOURS,
    begin_with,
    hover,
    legend_above,
    new_plot,
    shown_range,
    zero_line,
)
from stribeck.report.interactive.dots import selected_dots
from stribeck.report.style import thin

if TYPE_CHECKING:
    from collections.abc import Mapping

    from bokeh.models import GlyphRenderer
    from bokeh.plotting import figure
    from numpy.typing import NDArray

    from stribeck.fitting.result import Fit
    from stribeck.report.interactive.samples import Samples


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
    return evidence(effect, finding_view(effect, before, after), before.model.torque_unit)


def evidence_columns(
    views: Mapping[str, FindingView], count: int
) -> dict[str, NDArray[np.float64]]:
    """Columns for `Samples.with_columns`: the samples behind each view; NaN at all others.

    Parameters
    ----------
    views : mapping of FindingView
        By the names that `evidence` is given.
    count : int
        Number of samples of the recording.
    """
    columns = {}
    for name, view in views.items():
        x = np.where(view.x > 0, view.x, np.nan) if view.log else view.x
        rows = (("at", x), ("without", view.without.samples), ("with", view.with_it.samples))
        for what, values in rows:
            columns[f"{name} {what}"] = whole = np.full(count, np.nan)
            whole[view.rows] = values
    return columns


def evidence(
    effect: str, view: FindingView, unit: str, samples: Samples | None = None, name: str = ""
) -> figure:
    """The figure of `finding_residual`, in which a selection of samples is marked.

    Parameters
    ----------
    view : FindingView
        What it shows.
    unit : str
        Unit of torque.
    samples : Samples, optional
        With the columns of `evidence_columns`: those that are selected appear as dots.
    name : str
        The name of the view among these columns.
    """
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
    for curve, colour, what in (
        (view.without, COLOURS[0], "without"),
        (view.with_it, COLOURS[1], "with"),
    ):
        label = f"{what} {effect}"
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
        if samples is not None:
            shown.insert(
                0, selected_dots(plot, samples.source, f"{name} at", f"{name} {what}", colour)
            )
        hover(plot, shown[-1:], [(label, f"@mid{{0.0000}} {unit}"), (view.x_label, "@at{0.000}")])
        items.append((label, shown))
    begin_with(plot, y=shown_range(limited))
    legend_above(plot, items)
    return plot
