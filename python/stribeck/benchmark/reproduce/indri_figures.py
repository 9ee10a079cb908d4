"""The figures of Indri et al."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.benchmark.reproduce.result import Picture
from stribeck.report.style import AFTER, BEFORE, MEASURED, legend_above, new_figure, strided, style

if TYPE_CHECKING:
    from stribeck.fitting.result import Fit

Array = NDArray[np.float64]


def static_friction(made: Fit) -> Iterable[Picture]:
    """Figures 3 and 4: friction of joint 1 over positive and negative velocity."""
    recording = made.recording
    for number, way, word in ((3, 1.0, "positive"), (4, -1.0, "negative")):
        figure = new_figure(6.2, 3.2)
        axes = figure.subplots()
        style(axes)
        rows = np.sign(recording.velocity) == way
        v = way * np.linspace(0.005, 3.0, 400)
        axes.plot(
            recording.velocity[rows],
            recording.torque[rows],
            "o",
            color=MEASURED,
            ms=4,
            label="tests",
        )
        axes.plot(v, made.model.torque(v), color=AFTER, label="static LuGre, identified")
        axes.set(xlabel="velocity [rad/s]", ylabel="friction torque [N m]")
        legend_above(axes, 2)
        yield Picture(
            f"figure_{number}",
            f"figure {number}",
            f"Friction of joint 1 at {word} velocity: 8.4 N m forward and -7.4 N m backward just "
            "above rest (the sums of table 1's levels), then the dip and the rise of eqs 6 and "
            "7.",
            figure,
        )


def trajectory(time: Array, position: Array) -> Picture:
    """Figure 5: the reference of both joints."""
    figure = new_figure(6.5, 3.0)
    axes = figure.subplots()
    style(axes)
    for k, colour in enumerate((AFTER, BEFORE)):
        axes.plot(time, position[:, k], color=colour, label=f"joint {k + 1}")
    axes.set(xlabel="time [s]", ylabel="angle [rad]")
    legend_above(axes, 2)
    return Picture(
        "figure_5",
        "figure 5",
        "The four-harmonic reference of eq 13 with the printed amplitudes and frequencies.",
        figure,
    )


def rebuilt(number: int, name: str, time: Array, torque: Array, made: Array) -> Picture:
    """Figures 6 to 8: measured and rebuilt torque, and the error."""
    figure = new_figure(10.0, 4.4)
    grid = figure.subplots(2, 2, sharex=True, height_ratios=(2, 1))
    rows = strided(time.size)
    for k, (top, bottom) in enumerate(grid.T):
        for axes in (top, bottom):
            style(axes)
        top.plot(time[rows], torque[rows, k], color=MEASURED, lw=0.8, label="simulated measurement")
        top.plot(time[rows], made[rows, k], color=AFTER, lw=1.3, label="rebuilt")
        bottom.plot(time[rows], (torque - made)[rows, k], color=BEFORE, lw=0.8)
        bottom.set_xlabel("time [s]")
        top.set_title(f"joint {k + 1}", loc="left", fontsize=10.5)
    grid[0, 0].set_ylabel("torque [N m]")
    grid[1, 0].set_ylabel("error [N m]")
    legend_above(grid[0, 1], 2)
    return Picture(
        f"figure_{number}",
        f"figure {number}",
        f"Torques of the {name}: what is rebuilt follows the measurement, and the error is a "
        "third of it. The paper's errors peak at reversals; the simulated ones do not.",
        figure,
    )
