"""The figures of Bittencourt et al. 2010."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.benchmark.reproduce.result import Picture
from stribeck.report.style import AFTER, BEFORE, MEASURED, legend_above, new_figure, strided, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stribeck.fitting.methods.steady import SteadyPoints
    from stribeck.fitting.methods.warming import Warming
    from stribeck.fitting.result import Fit
    from stribeck.models.model import Model
    from stribeck.recording.recording import Recording

Array = NDArray[np.float64]
Colour = tuple[float, float, float, float]

FRICTION = "friction torque [share]"
MOTOR_SPEED = "motor speed [rad/s]"
#: Curves drawn of fifty.
CUTS = 6


def excitation(log: Recording) -> Picture:
    """Figure 2: motor speed and torque over time."""
    figure = new_figure(9.0, 2.8)
    left, right = figure.subplots(1, 2)
    rows = strided(log.time.size)
    for axes, values, label in (
        (left, log.velocity, MOTOR_SPEED),
        (right, log.torque, "motor torque [share]"),
    ):
        style(axes)
        axes.plot(log.time[rows], values[rows], color=MEASURED, linewidth=0.8)
        axes.set(xlabel="time [s]", ylabel=label)
    return Picture(
        "figure_2",
        "figure 2",
        "Excitation: twelve speeds in both directions in 2:15 min, and the torque that drives "
        "them.",
        figure,
    )


def friction_curve(points: SteadyPoints, m0: Fit) -> Picture:
    """Figure 3: points by averaging, and M0."""
    figure = new_figure(6.2, 3.6)
    axes = figure.subplots()
    style(axes)
    v = np.linspace(0.5, 285.0, 400)
    axes.plot(v, m0.model.torque(v), color=AFTER, linewidth=1.6, label="M0, identified")
    axes.plot(
        points.velocity, points.friction_torque, "x", color=MEASURED, label="points by averaging"
    )
    axes.set(xlabel=MOTOR_SPEED, ylabel=FRICTION, ylim=(0.0, 0.17))
    legend_above(axes)
    return Picture(
        "figure_3",
        "figure 3",
        "Half the difference of forward and backward torque (eq 4), and the M0 fitted to it: as "
        "in the paper, a minimum of about 0.04 between 25 and 40 rad/s and 0.14 to 0.15 at 280 "
        "rad/s.",
        figure,
    )


def _coloured(axes: Axes, low: float, high: float, label: str) -> Callable[[float], Colour]:
    """A colour by value, and its bar beside the axes."""
    import matplotlib
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    scale = Normalize(low, high)
    colours = matplotlib.colormaps["viridis"]
    axes.figure.colorbar(ScalarMappable(scale, colours), ax=axes, label=label, pad=0.02)
    return lambda value: colours(scale(value))


def _cuts(
    axes: Axes,
    frame: pl.DataFrame,
    along: str,
    label: str,
    unit: str,
    values: Array,
    made: Sequence[Callable[[Array], Array]],
) -> None:
    """Friction over `along` at several speeds, measured (dots) and modelled (lines)."""
    style(axes)
    for k, speed in enumerate(values):
        rows = frame.filter(pl.col("velocity") == speed).sort(along)
        colour = f"C{k}"
        axes.plot(rows[along], rows["friction_torque"], ".", color=colour, markersize=3)
        x = np.linspace(rows[along].to_numpy()[0], rows[along].to_numpy()[-1], 200)
        axes.plot(x, made[k](x), color=colour, linewidth=1.3, label=f"{speed:g} rad/s")
    axes.set(xlabel=f"{label} [{unit}]", ylabel=FRICTION)
    axes.legend(frameon=False, fontsize=8, ncols=2)


def load_cuts(frame: pl.DataFrame, m1: Fit) -> Picture:
    """Figure 6: friction curves at several loads, and friction over load at several speeds."""
    figure = new_figure(10.0, 3.8)
    left, right = figure.subplots(1, 2)
    style(left)
    colour = _coloured(left, 0.0, 0.73, "absolute load torque [share]")
    v = np.geomspace(1.5, 285.0, 300)
    loads = frame["load_torque"].unique().sort().to_numpy()
    for load in loads[np.linspace(0, loads.size - 1, CUTS).astype(int)]:
        rows = frame.filter(pl.col("load_torque") == load)
        c = colour(abs(load))
        left.plot(rows["velocity"], rows["friction_torque"], ".", color=c, markersize=4)
        left.plot(v, m1.model.torque(v, load_torque=np.full(v.size, load)), color=c, linewidth=1.2)
    left.set(xlabel=MOTOR_SPEED, ylabel=FRICTION)
    speeds = np.array([8.7, 25.0, 90.0, 220.0])
    made = [lambda x, s=s: m1.model.torque(np.full(x.size, s), load_torque=x) for s in speeds]
    _cuts(right, frame, "load_torque", "load torque", "share", speeds, made)
    return Picture(
        "figure_6",
        "figure 6",
        "Friction rises with the absolute load, most at low speed; dots are the 50 curves at 34 "
        "degC, lines are M1. As in the paper the lines over load are V-shaped and those at high "
        "speed are nearly parallel.",
        figure,
    )


def temperature_cuts(frame: pl.DataFrame, m_star: Model) -> Picture:
    """Figure 7: friction curves at several temperatures, and over temperature, at load -0.02."""
    figure = new_figure(10.0, 3.8)
    left, right = figure.subplots(1, 2)
    style(left)
    light = frame.filter(pl.col("load_torque") == -0.02)
    colour = _coloured(left, 38.0, 81.2, "temperature [degC]")
    v = np.geomspace(1.5, 285.0, 300)
    warm = light["temperature"].unique().sort().to_numpy()

    def at(speed: Array, T: Array) -> Array:
        return m_star.torque(speed, temperature=T, load_torque=np.full(speed.size, -0.02))

    for T in warm[np.linspace(0, warm.size - 1, CUTS).astype(int)]:
        rows = light.filter(pl.col("temperature") == T)
        left.plot(rows["velocity"], rows["friction_torque"], ".", color=colour(T), markersize=4)
        left.plot(v, at(v, np.full(v.size, T)), color=colour(T), linewidth=1.2)
    left.set(xlabel=MOTOR_SPEED, ylabel=FRICTION)
    speeds = np.array([8.7, 25.0, 90.0, 220.0])
    made = [lambda x, s=s: at(np.full(x.size, s), x) for s in speeds]
    _cuts(right, light, "temperature", "temperature", "degC", speeds, made)
    return Picture(
        "figure_7",
        "figure 7",
        "Warm oil lowers viscous friction and raises friction at low speed; dots are the curves "
        "at load -0.02, lines are M*. As in the paper, the curves cross: at 25 rad/s friction "
        "grows with temperature, at 220 rad/s it falls.",
        figure,
    )


def without_load(frame: pl.DataFrame, rest: pl.DataFrame, fit: Fit) -> Picture:
    """Figure 8: the two loads of figure 7 before and after the terms of load are subtracted."""
    figure = new_figure(10.0, 3.6)
    both = figure.subplots(1, 2, sharey=True)
    heavy = (frame["load_torque"] < -0.5).to_numpy()
    for axes, table, title in (
        (both[0], frame, "measured"),
        (both[1], rest, "after subtraction of eq 7"),
    ):
        style(axes)
        v, f = table["velocity"].to_numpy(), table["friction_torque"].to_numpy()
        axes.semilogx(
            v[heavy] * 1.03, f[heavy], ".", color=BEFORE, markersize=3, label="load -0.72"
        )
        axes.semilogx(v[~heavy], f[~heavy], ".", color=AFTER, markersize=3, label="load -0.02")
        axes.set_title(title, loc="left", fontsize=10.5)
        axes.set(xlabel=MOTOR_SPEED)
    both[0].set_ylabel(FRICTION)
    both[1].legend(frameon=False, fontsize=9)
    return Picture(
        "figure_8",
        "figure 8",
        "Without the terms of load the curves of both loads coincide, as in the paper: the "
        f"effects of load and temperature add. Residual of the fit to them: {fit.rmse:.2g} (RMS).",
        figure,
    )


def conditions(frame: pl.DataFrame) -> Picture:
    """Figure 9(b): temperatures and loads of the validation."""
    figure = new_figure(6.5, 3.0)
    axes = figure.subplots()
    style(axes)
    each = frame.gather_every(frame.height // 250)
    number = np.arange(each.height)
    axes.plot(number, each["load_torque"], color=AFTER, linewidth=1.2)
    axes.set(xlabel="experiment", ylim=(-1.0, 1.0))
    axes.set_ylabel("load torque [share]", color=AFTER)
    other = axes.twinx()
    other.plot(number, each["temperature"], color=BEFORE, linewidth=1.2)
    other.set_ylabel("temperature [degC]", color=BEFORE)
    other.set_ylim(18.0, 42.0)
    return Picture(
        "figure_9",
        "figure 9",
        "Conditions of the 250 validation curves: the ranges are those of the paper's axes, the "
        "order of the loads is ours.",
        figure,
    )


def errors(judged: Sequence[tuple[str, Array]]) -> Picture:
    """Figure 10: absolute errors of both models over the validation."""
    figure = new_figure(7.0, 3.2)
    axes = figure.subplots()
    style(axes)
    for (name, error), colour in zip(reversed(judged), (BEFORE, AFTER), strict=True):
        label = f"{name}: mean {error.mean():.2e}, largest {error.max():.2e}"
        number = np.arange(error.size) * 250.0 / error.size
        axes.plot(number, error, ".", color=colour, markersize=2.5, label=label)
    axes.set(xlabel="experiment", ylabel="absolute error [share]")
    legend_above(axes, 2)
    return Picture(
        "figure_10",
        "figure 10",
        "Absolute errors of M* and of the single M0 on the validation curves. As in the paper, M* "
        "stays below 0.02 and M0 reaches several times as far.",
        figure,
    )


def warm_up(hours: Array, temperature: Array, found: Warming) -> Picture:
    """Section II-B: the oil's temperature, and the curves that are used."""
    figure = new_figure(6.5, 3.2)
    axes = figure.subplots()
    style(axes)
    settled = found.in_equilibrium(hours)
    axes.plot(hours[~settled], temperature[~settled], ".", color=BEFORE, label="not settled")
    axes.plot(hours[settled], temperature[settled], ".", color=AFTER, label="used (later than 2κ)")
    curve = found.settled + (found.start - found.settled) * np.exp(-hours / found.constant)
    axes.plot(hours, curve, color="black", linewidth=1.2, label=f"κ = {found.constant:.2f} h")
    axes.set(xlabel="time [h]", ylabel="oil temperature [degC]")
    legend_above(axes, 3)
    return Picture(
        "warm_up",
        "section II-B",
        "The decay constant of the joint's temperature, and the friction curves that count as "
        "measured in equilibrium.",
        figure,
    )
