"""The residual of models against a channel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from bokeh.models import ColumnDataSource

from stribeck.report.interactive.base import (
    begin_with,
    colour_of,
    hover,
    legend_above,
    new_plot,
    zero_line,
)
from stribeck.report.interactive.dots import sample_dots, sample_rows
from stribeck.report.interactive.samples import Samples
from stribeck.report.style import binned_median

if TYPE_CHECKING:
    from bokeh.models import GlyphRenderer
    from bokeh.plotting import figure


def residual_channel(samples: Samples, channel: str) -> figure:
    """Measured minus modelled torque against a channel, as dots and medians in bins.

    Medians are those of all samples, drawn or not: solid for forward, dashed for backward motion,
    since friction changes sign with the velocity.

    Parameters
    ----------
    samples : Samples
        As `samples_of` makes them; shared with the other figures.
    channel : str
        A key of `samples.labels`.

    Raises
    ------
    KeyError
        The recording has no such channel, or it does not vary.
    """
    plot = new_plot(samples.labels[channel], f"residual [{samples.unit}]")
    zero_line(plot)
    velocity, x = samples.columns["velocity"], samples.columns[channel]
    ways = [(velocity > 0, "solid"), (velocity < 0, "dashed")]
    if channel == "velocity":
        ways = [(velocity > 0, "solid"), (velocity < 0, "solid")]
    items: list[tuple[str, list[GlyphRenderer]]] = []
    for k, name in enumerate(samples.names):
        y = samples.columns[f"residual_{k}"]
        shown = [sample_dots(plot, samples, channel, f"residual_{k}", colour_of(k))]
        for way, dash in ways:
            here = way & np.isfinite(y) & np.isfinite(x)
            at, median = binned_median(x[here], y[here])
            if at.size:
                source = ColumnDataSource({"at": at, "mid": median})
                shown.append(
                    plot.line(
                        "at",
                        "mid",
                        source=source,
                        color=colour_of(k),
                        line_width=3.0,
                        line_dash=dash,
                    )
                )
        items.append((name, shown))
    last = len(samples.fits) - 1
    hover(plot, [items[last][1][0]], sample_rows(samples, *range(len(samples.fits))))
    residuals = samples.limits(*(f"residual_{k}" for k in range(len(samples.fits))))
    begin_with(plot, x=samples.limits(channel), y=residuals)
    legend_above(plot, items)
    return plot
