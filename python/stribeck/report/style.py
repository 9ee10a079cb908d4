"""What all figures share: colours, axes, legends, thinning and binning.

Figures are made without pyplot, so that threads and callers share nothing. Matplotlib is imported
when a figure is made. The colours are those of Okabe and Ito, which remain distinct for
colour-blind readers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

MEASURED = "#4d4d4d"
BEFORE = "#D55E00"
AFTER = "#0072B2"
FLOOR = "#009E73"
COLOURS = (BEFORE, AFTER, FLOOR, "#CC79A7", "#E69F00", "#56B4E9")
GREY = "#999999"
DPI = 120
#: Points drawn of a scatter; more add nothing that can be seen.
MOST_POINTS = 3000
#: Points drawn of a line over time.
MOST_OF_A_LINE = 4000
BINS = 30
#: With fewer samples than this, medians of bins say less than the samples.
FEWEST_FOR_MEDIAN = 150


def new_figure(
    width: float,
    height: float,
    layout: Literal["constrained"] | None = "constrained",
    dpi: float = DPI,
) -> Figure:
    """An empty figure, inches."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), dpi=dpi, layout=layout)
    FigureCanvasAgg(figure)
    return figure


def style(axes: Axes) -> None:
    """A light grid, no box."""
    axes.grid(True, color="#e6e6e6", linewidth=0.6)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.title.set_fontsize(10.5)
    axes.tick_params(labelsize=9)


def title(axes: Axes, text: str) -> None:
    """A title at the left end of the axes."""
    axes.set_title(text, loc="left", fontsize=10.5)


def headline(figure: Figure, text: str, size: float = 12.0) -> None:
    """A title at the left end of the figure."""
    figure.suptitle(text, fontsize=size, x=0.01, ha="left")


def zero_line(axes: Axes) -> None:
    """Mark zero."""
    axes.axhline(0.0, color=GREY, linewidth=0.8)


def legend_above(axes: Axes, columns: int = 4) -> None:
    """A legend to the right above the axes, where it covers no data."""
    legend = axes.legend(
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0),
        ncols=columns,
        frameon=False,
        fontsize=9,
        borderaxespad=0.2,
        handlelength=1.6,
        columnspacing=1.2,
    )
    for line in legend.get_lines():
        line.set_linewidth(2.4)


def legend_below(axes: Axes, columns: int = 1, heading: str | None = None) -> None:
    """A legend below the label of the x axis."""
    axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, -0.2),
        ncols=columns,
        frameon=False,
        fontsize=9,
        title=heading,
        title_fontsize=8.5,
    )


def dots(axes: Axes, x: Array, y: Array, colour: str, label: str | None = None) -> None:
    """Draw single samples: few of them large, many of them faint."""
    size, alpha = (7.0, 0.9) if x.size < 300 else (4.0, 0.5) if x.size < 1500 else (3.0, 0.35)
    axes.plot(
        x,
        y,
        linestyle="none",
        marker=".",
        color=colour,
        label=label,
        markersize=size,
        alpha=alpha,
        markeredgewidth=0,
        rasterized=True,
    )


def thin(rows: NDArray[np.intp], most: int = MOST_POINTS) -> NDArray[np.intp]:
    """At most `most` of the rows, chosen at random, the same ones every time."""
    if rows.size <= most:
        return rows
    # A fixed stride could beat with a periodic motion.
    picked = np.random.default_rng(0).choice(rows, most, replace=False)
    return np.asarray(np.sort(picked))


def strided(count: int) -> NDArray[np.intp]:
    """Indices of the points that are drawn of a line of `count` points."""
    return np.unique(np.linspace(0, count - 1, MOST_OF_A_LINE).astype(np.intp))


def binned_quartiles(
    x: Array, y: Array, bins: int = BINS, *, log: bool = False
) -> tuple[Array, Array, Array, Array]:
    """Centres of bins of `x`, and the lower quartile, median and upper quartile of `y` in each.

    Parameters
    ----------
    log : bool
        Bins of equal ratio instead of equal width; only `x` above zero is used.

    Returns
    -------
    arrays [k]
        Of the bins that hold enough points.
    """
    none = (np.empty(0),) * 4
    if log:
        x, y = x[x > 0], y[x > 0]
    if x.size < FEWEST_FOR_MEDIAN or not np.ptp(x) > 0:
        return none
    along = np.log(x) if log else x
    low, high = np.quantile(along, [0.01 if log else 0.002, 0.998])
    if not high > low:
        return none
    index = np.clip(np.floor((along - low) / (high - low) * bins), -1, bins).astype(np.intp)
    least = max(5, x.size // 2000)
    inside = [index == k for k in range(bins)]
    rows = [
        [np.median(x[here]), *np.quantile(y[here], [0.25, 0.5, 0.75])]
        for here in inside
        if np.count_nonzero(here) >= least
    ]
    if not rows:
        return none
    at, lower, median, upper = np.array(rows, dtype=np.float64).T
    return at, lower, median, upper


def binned_median(x: Array, y: Array, bins: int = BINS) -> tuple[Array, Array]:
    """Median of `y` in bins of `x` of equal width, where there are enough points."""
    at, _, median, _ = binned_quartiles(x, y, bins)
    return at, median


def limits(axes: Axes, values: Sequence[Array]) -> None:
    """Show 99.8 % of the values: a single spike must not flatten the rest."""
    finite = np.concatenate([v[np.isfinite(v)] for v in values])
    if finite.size == 0:
        return
    low, high = np.quantile(finite, [0.001, 0.999])
    room = 0.1 * (high - low) or 1.0
    axes.set_ylim(float(low - room), float(high + room))


def broken(r: Recording, values: Array) -> Array:
    """`values` with NaN at rest and before each gap, so that a line breaks there."""
    drawn = np.where(r.moving, values, np.nan)
    if r.averaged:
        return drawn
    drawn[np.flatnonzero(np.diff(r.segment)) + 1] = np.nan
    return drawn


def over_time(
    axes: Axes,
    r: Recording,
    x: Array,
    y: Array,
    colour: str,
    size: tuple[float, float],
    label: str | None = None,
    alpha: float = 1.0,
) -> None:
    """Draw a line, or dots for steady-state points.

    Parameters
    ----------
    size
        Width of the line and size of the dots, points.
    """
    width, dot = size
    if r.averaged:
        axes.plot(x, y, "o", color=colour, markersize=dot, label=label, alpha=alpha)
    else:
        axes.plot(x, y, "-", color=colour, linewidth=width, label=label, alpha=alpha)
