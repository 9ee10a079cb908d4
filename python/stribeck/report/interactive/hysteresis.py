"""Friction loops: friction against position, or against the way since a reversal."""

from __future__ import annotations

from typing import TYPE_CHECKING

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

if TYPE_CHECKING:
    from bokeh.models import GlyphRenderer
    from bokeh.plotting import figure


def hysteresis(samples: Samples, channel: str = "position") -> figure:
    """Friction against position, measured and modelled: motion to and fro encloses a loop.

    Parameters
    ----------
    samples : Samples
        As `samples_of` makes them; shared with the other figures.
    channel : {"position", "reversal", "velocity"}
        ``"reversal"``: displacement since the last reversal, where a bristle shows;
        ``"velocity"``: a loop where friction lags behind the velocity.

    Raises
    ------
    KeyError
        The recording has no such channel, or it does not vary.
    """
    plot = new_plot(samples.labels[channel], friction_label(samples))
    zero_line(plot)
    items: list[tuple[str, list[GlyphRenderer]]] = []
    columns = [("measured", "friction", MEASURED)]
    columns += [(n, f"friction_{k}", colour_of(k)) for k, n in enumerate(samples.names)]
    for name, column, colour in columns:
        dots = sample_dots(plot, samples, channel, column, colour)
        items.append((name, [dots, legend_dot(plot, colour)]))
    hover(plot, items[0][1][:1], sample_rows(samples, *range(len(samples.fits))))
    begin_with(plot, x=samples.limits(channel), y=samples.limits("friction"))
    legend_above(plot, items)
    return plot
