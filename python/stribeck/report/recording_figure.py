"""The channels of a recording over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stribeck.report.channels import clock, torque_name
from stribeck.report.recording import file_name
from stribeck.report.style import (
    AFTER,
    BEFORE,
    MEASURED,
    broken,
    headline,
    legend_above,
    new_figure,
    over_time,
    style,
    zero_line,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from stribeck.recording.recording import Recording

#: At most so many runs are named.
_NAMED = 12


def recording_figure(r: Recording) -> Figure:
    """Position, velocity, torque and temperature, with a line where a run begins."""
    what = torque_name(r.torque_unit)
    rows: list[tuple[str, list[tuple[NDArray[np.float64] | None, str, str | None]]]] = [
        (f"position [{r.position_unit}]", [(r.position, MEASURED, None)]),
        (f"velocity [{r.position_unit}/s]", [(r.velocity, MEASURED, None)]),
        (
            f"{what} [{r.torque_unit}]",
            [
                (r.torque, MEASURED, "measured" if r.load_torque is not None else None),
                (r.load_torque, AFTER, "load"),
            ],
        ),
        ("temperature [°C]", [(r.temperature, BEFORE, None)]),
    ]
    shown = [(label, [line for line in lines if line[0] is not None]) for label, lines in rows]
    shown = [(label, lines) for label, lines in shown if lines]
    figure = new_figure(12.0, 1.2 + 2.2 * len(shown))
    panels = figure.subplots(len(shown), 1, sharex=True, squeeze=False)[:, 0]
    time = clock(r)
    for axes, (label, lines) in zip(panels, shown, strict=True):
        style(axes)
        if not label.startswith("temperature"):
            zero_line(axes)
        for values, colour, name in lines:
            assert values is not None
            over_time(axes, r, time.values, broken(r, values), colour, (0.9, 3.0), name)
        axes.set_ylabel(label)
        axes.margins(x=0.01)
        if len(lines) > 1:
            legend_above(axes)
        _runs(axes, r, time.values, named=axes is panels[0])
    panels[-1].set_xlabel(time.label)
    headline(figure, file_name(r), 12.5)
    return figure


def _runs(axes: Axes, r: Recording, time: NDArray[np.float64], *, named: bool) -> None:
    """Where each run begins, and its name in the first panel."""
    if r.runs < 2 or r.averaged:
        return
    begins = np.flatnonzero(np.diff(r.run, prepend=-1))
    for at in begins:
        if at:
            axes.axvline(time[at], color="0.6", linewidth=0.8, linestyle=":")
        if named and begins.size <= _NAMED:
            axes.annotate(
                r.run_names[r.run[at]],
                (time[at], 1.0),
                xycoords=("data", "axes fraction"),
                xytext=(3, -3),
                textcoords="offset points",
                va="top",
                fontsize=8,
                color="0.35",
            )
