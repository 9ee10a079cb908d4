"""Parameters with their 95 % intervals."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from bokeh.models import ColumnDataSource, Range1d, Span, Whisker

from stribeck.report.interactive.base import COLOURS, INK, hover, name_places, new_plot
from stribeck.report.numbers import plain, unit_text, with_error

if TYPE_CHECKING:
    from bokeh.plotting import figure

    from stribeck.identify.errors.estimates import Estimate

#: Ends further from a value than this share of it are cut off, so that the others can be read.
WIDEST = 1.5


def intervals(estimates: Iterable[Estimate]) -> figure:
    """Intervals relative to each value, since parameters have different units.

    A parameter without an interval, or of value zero, is left out: it has no relative error.

    Parameters
    ----------
    estimates : iterable of Estimate
        The values of `Fit.estimates`.
    """
    shown = [e for e in estimates if e.ci95 is not None and e.value != 0.0]
    plot = new_plot(
        "relative 95 % interval [%]",
        "",
        tools="save",
        active=None,
        height=90 + 30 * max(len(shown), 1),
    )
    plot.add_layout(Span(location=0.0, dimension="height", line_color=INK, line_alpha=0.7))
    rows = [_row(k, e) for k, e in enumerate(shown)]
    names = ("place", "low", "high", "zero", "name", "said", "range", "colour")
    source = ColumnDataSource({name: [row[name] for row in rows] for name in names})
    whisker = Whisker(
        base="place",
        lower="low",
        upper="high",
        dimension="width",
        source=source,
        line_color=INK,
        line_width=2,
    )
    whisker.upper_head.line_color = whisker.lower_head.line_color = INK
    plot.add_layout(whisker)
    dots = plot.scatter("zero", "place", source=source, size=10, color="colour")
    hover(plot, [dots], [("parameter", "@name"), ("value", "@said"), ("95 % interval", "@range")])
    name_places(plot, [e.name.replace("_", " ") for e in shown])
    plot.y_range = Range1d(max(len(shown), 1) - 0.5, -0.5)
    ends = [abs(float(str(row[side]))) for row in rows for side in ("low", "high")]
    widest = max(ends, default=1.0)
    plot.x_range = Range1d(-1.1 * widest, 1.1 * widest)
    plot.ygrid.visible = False
    return plot


def _row(place: int, e: Estimate) -> dict[str, object]:
    assert e.ci95 is not None
    low, high = ((end - e.value) / abs(e.value) for end in e.ci95)
    value, error = with_error(e.value, e.stderr)
    unit = unit_text(e.unit)
    return {
        "place": place,
        "low": 100.0 * float(np.clip(low, -WIDEST, 0.0)),
        "high": 100.0 * float(np.clip(high, 0.0, WIDEST)),
        "zero": 0.0,
        "name": e.name,
        "said": f"{value} ± {error} {unit}" if error else f"{value} {unit}",
        "range": f"{plain(e.ci95[0])} to {plain(e.ci95[1])} {unit}",
        "colour": COLOURS[1] if max(-low, high) <= 1.0 else COLOURS[0],
    }
