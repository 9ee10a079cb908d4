"""The picture of the curves."""

from __future__ import annotations

from curves import Curve
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter
from stribeck.report.style import COLOURS, new_figure, style, title

MARKERS = "osD^vP"


def drawn(samples: list[Curve], parameters: list[Curve], threads: list[Curve]) -> Figure:
    """Times over samples, parameters and threads, side by side; both axes logarithmic."""
    figure = new_figure(13.0, 5.0)
    left, middle, right = figure.subplots(1, 3)
    _lines(left, samples)
    _dots(middle, parameters)
    _lines(right, threads)
    title(left, "time a sample (ns) over samples")
    title(middle, "time a sample (ns) over parameters of the law")
    title(right, "time (s) over threads or processes")
    left.set_xlabel("samples")
    middle.set_xlabel("parameters (one dot a law)")
    right.set_xlabel("threads or processes")
    left.set_ylabel("ns a sample")
    middle.set_ylabel("ns a sample")
    right.set_ylabel("s")
    for axis in (middle.xaxis, right.xaxis, right.yaxis):
        axis.set_major_formatter(ScalarFormatter())
        axis.set_minor_formatter(NullFormatter())
    right.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    middle.set_xticks([2, 3, 5, 10, 20, 30])
    right.set_xticks(threads[0].at)
    for axes in (left, middle, right):
        style(axes)
        axes.legend(
            loc="upper center",
            bbox_to_anchor=(0.5, -0.14),
            frameon=False,
            fontsize=8,
            ncols=2 if axes is middle else 1,
        )
    return figure


def _lines(axes: Axes, curves: list[Curve]) -> None:
    for curve, colour, marker in zip(curves, COLOURS, MARKERS, strict=False):
        axes.loglog(
            curve.at, curve.time, color=colour, marker=marker, ms=4, lw=1.3, label=curve.name
        )


def _dots(axes: Axes, curves: list[Curve]) -> None:
    for curve, colour, marker in zip(curves, COLOURS, MARKERS, strict=False):
        axes.loglog(
            curve.at,
            curve.time,
            color=colour,
            marker=marker,
            ms=4,
            ls="",
            alpha=0.8,
            label=curve.name,
        )
