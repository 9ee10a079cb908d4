"""What the interactive figures share: an empty figure, colours, tools, legends, hover."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from bokeh.models import (
    BasicTickFormatter,
    FixedTicker,
    HoverTool,
    Legend,
    LegendItem,
    Range1d,
    Span,
    WheelZoomTool,
)
from bokeh.plotting import figure
from numpy.typing import NDArray

if TYPE_CHECKING:
    from bokeh.models import GlyphRenderer

    from stribeck.models.model import Model

Array = NDArray[np.float64]
#: Ends of an axis; None where no value is known.
Limits = tuple[float, float] | None

#: Readable on a light and on a dark ground: contrast of at least 3 with white and with #15171c.
MEASURED = "#808488"
COLOURS = ("#D55E00", "#0079BD", "#009E73", "#C2639A", "#B98300", "#3E93C4")
FLOOR = "#009E73"
#: Width of a line through many samples, pixels: without a graphics card Chromium paints a wider one
#: many times as slowly.
HAIRLINE = 1.0
#: Text and axes; pages set them by the CSS properties `--bk-...` for their own ground.
INK, FAINT = "#74777c", "#9a9da340"
#: Longest name of a model in a legend: a longer one is cut off on a phone.
LONGEST = 34


def colour_of(number: int) -> str:
    """The colour of a model by its place."""
    return COLOURS[number % len(COLOURS)]


def model_name(model: Model) -> str:
    """What a model is called in a legend."""
    if len(model.spec) <= LONGEST:
        return model.spec
    count = len(model.effects) + len(model.own_effects)
    return f"{model.law} with {count} effect{'s' * (count != 1)}"


def new_plot(
    x_label: str,
    y_label: str,
    *,
    tools: str = "pan,box_zoom,box_select,lasso_select,reset,save",
    active: str | None = "box_select",
    height: int = 340,
    x_range: object = None,
    y_range: object = None,
    x_axis_type: str = "auto",
) -> figure:
    """An empty figure as wide as its place.

    Parameters
    ----------
    x_label, y_label
        With units.
    active
        Tool that a drag uses; None: a drag scrolls the page.
    x_range, y_range
        Range of another figure, to share it; or the categories of an axis.
    """
    ranges = {k: r for k, r in (("x_range", x_range), ("y_range", y_range)) if r is not None}
    plot = figure(
        tools=tools,
        active_drag=active,
        active_scroll=None,
        height=height,
        sizing_mode="stretch_width",
        x_axis_label=x_label,
        y_axis_label=y_label,
        x_axis_type=x_axis_type,
        background_fill_color=None,
        border_fill_color=None,
        outline_line_color=None,
        min_border_left=66,
        min_border_right=12,
        toolbar_location="above",
        **ranges,
    )
    plot.toolbar.logo = None
    plot.toolbar.autohide = False
    if active is not None:
        # A wheel zooms after the figure was clicked on: before, it scrolls the page.
        plot.add_tools(WheelZoomTool(modifiers={"ctrl": True}))
    _style(plot)
    return plot


def range_over(values: Array) -> Range1d:
    """A range with some room around `values`, which keeps a zoom when samples are replaced."""
    known = values[np.isfinite(values)]
    first, last = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    room = 0.02 * (last - first) or 0.5
    return Range1d(first - room, last + room)


def _style(plot: figure) -> None:
    for axis in (*plot.xaxis, *plot.yaxis):
        if isinstance(axis.formatter, BasicTickFormatter):
            # 0.0005 instead of 5.000e-4, which is too long beside its neighbour.
            axis.formatter.power_limit_low = -4
        axis.axis_label_text_font_style = "normal"
        axis.axis_label_text_font_size = "13px"
        axis.major_label_text_font_size = "12px"
        axis.axis_label_text_color = axis.major_label_text_color = INK
        axis.axis_line_color = axis.major_tick_line_color = INK
        axis.minor_tick_line_color = None
    for grid in (*plot.xgrid, *plot.ygrid):
        grid.grid_line_color = FAINT


def zero_line(plot: figure) -> None:
    """Mark zero of the vertical axis."""
    plot.add_layout(
        Span(location=0.0, dimension="width", line_color=INK, line_width=1, line_alpha=0.7)
    )


def legend_above(plot: figure, items: list[tuple[str, list[GlyphRenderer]]]) -> None:
    """A legend above the axes, where it covers no data; a click hides an entry."""
    legend = Legend(
        items=[LegendItem(label=label, renderers=list(shown)) for label, shown in items],
        click_policy="hide",
        background_fill_alpha=0.0,
        border_line_color=None,
        label_text_color=INK,
        label_text_font_size="12px",
        padding=0,
        spacing=0,
        margin=2,
        glyph_height=14,
    )
    plot.add_layout(legend, "above")


def hover(plot: figure, shown: list[GlyphRenderer], rows: list[tuple[str, str]]) -> None:
    """Say what is under the pointer: pairs of a name and a field."""
    plot.add_tools(
        HoverTool(renderers=list(shown), tooltips=rows, point_policy="snap_to_data", limit=1)
    )


def name_places(plot: figure, names: list[str], *, along: str = "y") -> None:
    """Name the places 0, 1, ... of an axis."""
    axis = plot.yaxis[0] if along == "y" else plot.xaxis[0]
    axis.ticker = FixedTicker(ticks=list(range(len(names))))
    axis.major_label_overrides = dict(enumerate(names))


def begin_with(plot: figure, *, x: Limits = None, y: Limits = None) -> None:
    """Begin with axes that span `shown_range` of the data; zooming out shows the rest."""
    if x is not None:
        plot.x_range = Range1d(*x)
    if y is not None:
        plot.y_range = Range1d(*y)


#: What a page says of such axes.
AXES_SPAN = "Axes leave out spikes; zoom out to see them."


def shown_range(values: list[Array]) -> Limits:
    """The range of 99.8 % of the values, and at most twice that of 98 % of them.

    A single spike must not flatten the rest.
    """
    finite = np.concatenate([v[np.isfinite(v)] for v in values]) if values else np.empty(0)
    if finite.size == 0:
        return None
    low, first, last, high = np.quantile(finite, [0.001, 0.01, 0.99, 0.999])
    # In a short recording the outer quantiles follow a single spike.
    beyond = 0.5 * (last - first)
    low, high = max(low, first - beyond), min(high, last + beyond)
    room = 0.1 * float(high - low) or 1.0
    return float(low) - room, float(high) + room
