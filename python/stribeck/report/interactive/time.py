"""Torque over time, measured and modelled, and the residual below it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bokeh.models import BoxSelectTool

from stribeck.report.channels import clock, torque_name
from stribeck.report.interactive.base import (
    HAIRLINE,
    MEASURED,
    begin_with,
    colour_of,
    hover,
    legend_above,
    new_plot,
    range_over,
    zero_line,
)
from stribeck.report.interactive.dots import sample_dots, sample_rows, selected_dots
from stribeck.report.interactive.samples import Samples

if TYPE_CHECKING:
    from bokeh.models import GlyphRenderer
    from bokeh.plotting import figure

#: A drag along time selects; the wheel and the box zoom along both axes.
TOOLS = "pan,box_zoom,reset,save"


def time(samples: Samples, *, x_range: object = None) -> figure:
    """Measured torque and that of each model over time.

    A drag selects a stretch of time, which the other figures of `samples` mark. Steady-state
    points, which have no time, are drawn against velocity.

    Parameters
    ----------
    samples : Samples
        As `samples_of` makes them; shared with the other figures.
    x_range
        Range of time of another figure, to share it.
    """
    what, made = torque_name(samples.unit), clock(samples.fits[0].recording)
    plot = _over_time(samples, made.label, f"{what} [{samples.unit}]", x_range)
    measured = _drawn(plot, samples, "torque", MEASURED, 2.4)
    items = [("measured", measured)]
    for k, name in enumerate(samples.names):
        items.append((name, _drawn(plot, samples, f"modelled_{k}", colour_of(k), HAIRLINE)))
    hover(plot, measured[-1:], sample_rows(samples, *range(len(samples.fits))))
    legend_above(plot, items)
    return plot


def residual_time(samples: Samples, *, x_range: object = None) -> figure:
    """The residual of each model over time, with the tools of `time`."""
    made = clock(samples.fits[0].recording)
    plot = _over_time(samples, made.label, f"residual [{samples.unit}]", x_range)
    zero_line(plot)
    items = []
    for k, name in enumerate(samples.names):
        items.append((name, _drawn(plot, samples, f"residual_{k}", colour_of(k), HAIRLINE)))
    begin_with(plot, y=samples.limits(*(f"residual_{k}" for k in range(len(samples.fits)))))
    hover(plot, items[-1][1][-1:], sample_rows(samples, *range(len(samples.fits))))
    legend_above(plot, items)
    return plot


def _over_time(samples: Samples, x_label: str, y_label: str, x_range: object) -> figure:
    window = x_range or range_over(samples.columns["time"])
    plot = new_plot(x_label, y_label, tools=TOOLS, active=None, x_range=window, height=320)
    select = BoxSelectTool(dimensions="width")
    plot.add_tools(select)
    plot.toolbar.active_drag = select
    return plot


def _drawn(
    plot: figure, samples: Samples, y: str, colour: str, width: float
) -> list[GlyphRenderer]:
    """A line, and dots on it that appear where they are selected; dots alone for points."""
    if samples.fits[0].recording.averaged:
        return [sample_dots(plot, samples, "velocity", y, colour)]
    line = plot.line(
        "time",
        y,
        source=samples.source,
        color=colour,
        line_width=width,
        alpha=0.85,
        nonselection_color=colour,
        nonselection_alpha=0.35,
    )
    return [line, selected_dots(plot, samples.source, "time", y, colour)]
