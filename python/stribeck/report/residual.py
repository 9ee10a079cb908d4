"""The residual of one or several models against each channel of a recording."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.report.channels import Channel, channel, clock
from stribeck.report.names import model_names
from stribeck.report.numbers import plain
from stribeck.report.style import (
    COLOURS,
    FEWEST_FOR_MEDIAN,
    MOST_POINTS,
    binned_median,
    dots,
    headline,
    limits,
    new_figure,
    style,
    thin,
    title,
    zero_line,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stribeck.fitting.result import Fit

CHANNELS = ("time", "velocity", "position", "load", "temperature", "acceleration")
#: Samples of more models than this would hide each other; medians remain.
MOST_WITH_DOTS = 3


def residual_figure(fits: Sequence[Fit]) -> Figure:
    """Residual of one or several models against each channel of the recording.

    Dots are single samples (thinned); lines are medians of bins, solid for forward and dashed for
    backward motion, since friction changes sign with the velocity.
    """
    found = [(name, made) for name in CHANNELS if (made := channel(fits[0], name)) is not None]
    columns = min(len(found), 2)
    rows = -(-len(found) // columns)
    figure = new_figure(12.0, 1.0 + 3.1 * max(rows, 1.3))
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, (name, made) in zip(grid, found, strict=False):
        _against(axes, fits, made, both_ways=name != "velocity")
    for axes in grid[len(found) :]:
        axes.set_visible(False)
    name = Path(fits[0].recording.path).name
    headline(figure, f"Residual (measured minus modelled) against each channel, {name}")
    _legend(figure, fits)
    return figure


def _against(axes: Axes, fits: Sequence[Fit], made: Channel, *, both_ways: bool) -> None:
    """One panel; forward and backward motion apart where the channel does not part them."""
    style(axes)
    zero_line(axes)
    r = fits[0].recording
    moving = np.flatnonzero(r.moving)
    some = thin(moving, MOST_POINTS // min(len(fits), MOST_WITH_DOTS))
    ways: list[tuple[NDArray[np.intp], str]] = [(moving, "-")]
    if both_ways:
        ways = [(moving[r.velocity[moving] > 0], "-"), (moving[r.velocity[moving] < 0], "--")]
    for k, fit in enumerate(fits):
        colour = COLOURS[k % len(COLOURS)]
        if len(fits) <= MOST_WITH_DOTS:
            dots(axes, made.values[some], fit.residual[some], colour)
        for way, line in ways:
            at, median = binned_median(made.values[way], fit.residual[way])
            axes.plot(at, median, line, color=colour, linewidth=1.8)
    limits(axes, [fit.residual[moving] for fit in fits])
    axes.set_xlabel(made.label)
    axes.set_ylabel(f"residual [{fits[0].model.torque_unit}]")


def _legend(figure: Figure, fits: Sequence[Fit]) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D(
            [],
            [],
            color=COLOURS[k % len(COLOURS)],
            linewidth=2.5,
            label=f"{name}  (RMSE {plain(fit.rmse)} {fit.model.torque_unit})",
        )
        for k, (name, fit) in enumerate(zip(model_names(fits), fits, strict=True))
    ]
    if np.count_nonzero(fits[0].recording.moving) >= FEWEST_FOR_MEDIAN:
        grey = "#555555"
        handles += [
            Line2D([], [], color=grey, linewidth=1.8, label="median, moving forward"),
            Line2D(
                [], [], color=grey, linewidth=1.8, linestyle="--", label="median, moving backward"
            ),
        ]
    figure.legend(
        handles=handles,
        loc="outside lower left",
        ncols=2 if len(fits) > 1 else 3,
        frameon=False,
        fontsize=9,
    )


def velocity_panel(axes: Axes, fit: Fit, colour: str) -> None:
    """The residual of one model against velocity."""
    made = channel(fit, "velocity") or clock(fit.recording)
    moving = np.flatnonzero(fit.recording.moving)
    some = thin(moving, 2000)
    zero_line(axes)
    dots(axes, made.values[some], fit.residual[some], colour)
    at, median = binned_median(made.values[moving], fit.residual[moving])
    axes.plot(at, median, "-", color="white", linewidth=3.6)
    axes.plot(at, median, "-", color=colour, linewidth=2.0, label=fit.model.spec)
    limits(axes, [fit.residual[moving]])
    axes.set_xlabel(made.label)
    axes.set_ylabel(f"residual [{fit.model.torque_unit}]")
    title(axes, "Residual against velocity")
