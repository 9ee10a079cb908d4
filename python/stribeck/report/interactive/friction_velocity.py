"""Friction against velocity, measured and modelled."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from bokeh.models import ColumnDataSource

from stribeck.report.interactive.base import (
    MEASURED,
    begin_with,
    colour_of,
    hover,
    legend_above,
    new_plot,
    zero_line,
)
from stribeck.report.interactive.dots import legend_dot, sample_dots, sample_rows
from stribeck.report.interactive.samples import Samples, friction_label
from stribeck.report.style import binned_quartiles

if TYPE_CHECKING:
    from bokeh.models import GlyphRenderer
    from bokeh.plotting import figure


def friction_velocity(samples: Samples) -> figure:
    """Measured friction as dots; each model as its median in bins of velocity, with a band.

    The band holds the middle half of what the model says at a velocity: it is wide where friction
    depends on more than the velocity. Medians are those of all samples, drawn or not. The torque of
    a load is taken off.

    Parameters
    ----------
    samples : Samples
        As `samples_of` makes them; shared with the other figures.
    """
    velocity = samples.columns["velocity"]
    plot = new_plot(f"velocity [{samples.velocity_unit}]", friction_label(samples))
    zero_line(plot)
    dots = sample_dots(plot, samples, "velocity", "friction", MEASURED)
    items: list[tuple[str, list[GlyphRenderer]]] = [
        ("measured", [dots, legend_dot(plot, MEASURED)])
    ]
    for k, name in enumerate(samples.names):
        values, shown = samples.columns[f"friction_{k}"], []
        for way in (velocity > 0, velocity < 0):
            here = way & np.isfinite(values)
            at, lower, median, upper = binned_quartiles(velocity[here], values[here])
            if at.size == 0:
                continue
            source = ColumnDataSource({"at": at, "lo": lower, "mid": median, "hi": upper})
            band = plot.varea("at", "lo", "hi", source=source, color=colour_of(k), alpha=0.22)
            line = plot.line("at", "mid", source=source, color=colour_of(k), line_width=2.2)
            shown += [band, line]
        # Too few samples for bins: steady-state points.
        shown = shown or [sample_dots(plot, samples, "velocity", f"friction_{k}", colour_of(k))]
        items.append((name, shown))
    hover(plot, [dots], sample_rows(samples, *range(len(samples.fits))))
    begin_with(plot, x=samples.limits("velocity"), y=samples.limits("friction"))
    legend_above(plot, items)
    return plot
