"""The figures of Tadese et al. 2021."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.benchmark.reproduce import tadese_data as data
from stribeck.benchmark.reproduce.result import Picture
from stribeck.report.style import (
    AFTER,
    BEFORE,
    COLOURS,
    FLOOR,
    MEASURED,
    legend_above,
    new_figure,
    strided,
    style,
)

if TYPE_CHECKING:
    from stribeck.benchmark.reproduce.tadese_robot import Identified
    from stribeck.motion.compensate.teaching import Teaching
    from stribeck.motion.compensate.tracking import Tracking
    from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

SPEED, FRICTION = "velocity [rad/s]", "friction torque [N m]"
#: Quadrants of eq 15: number, name in the law, signs of velocity and load.
QUADRANTS = (
    (1, "forward_motoring", 1, 1),
    (2, "backward_generating", -1, 1),
    (3, "backward_motoring", -1, -1),
    (4, "forward_generating", 1, -1),
)


def column(values: Array | None) -> Array:
    """A channel that the recording is known to have."""
    assert values is not None, "the stand-in has all channels"
    return values


@dataclass(frozen=True)
class Frictions:
    """Friction of the passes of figure 7, measured and by both models, arrays [n]."""

    measured: Array
    lugre: Array
    full: Array


def load_dependence(swings: Recording, friction: Frictions) -> Picture:
    """Figure 2(a): friction and gravity load of passes at several speeds."""
    figure = new_figure(9.0, 3.2)
    axes = figure.subplots()
    style(axes)
    load = column(swings.load_torque)
    time = np.arange(load.size) / 50.0
    axes.plot(time, friction.measured, color=BEFORE, linewidth=0.9, label="friction")
    axes.set(xlabel="time [s]", ylabel=FRICTION)
    other = axes.twinx()
    other.plot(time, load, color=AFTER, linewidth=0.9, label="gravity load (right)")
    other.set_ylabel("load torque [N m]", color=AFTER)
    motoring = load * swings.velocity > 0.0
    bottom, top = axes.get_ylim()
    axes.fill_between(time, bottom, top, where=motoring, color="#e8e8e8", step="mid", linewidth=0)
    axes.set_ylim(bottom, top)
    return Picture(
        "figure_2",
        "figure 2",
        "Friction (orange) under a changing gravity load (blue). As in the paper, friction "
        "depends strongly on the load where speed and load have the same sign (grey), and weakly "
        "elsewhere.",
        figure,
    )


def temperature(joint: Identified) -> Picture:
    """Figure 4(a): friction over velocity at several temperatures, without load."""
    figure = new_figure(6.5, 3.6)
    axes = figure.subplots()
    style(axes)
    v = np.concatenate([np.linspace(-1.85, -0.01, 150), [np.nan], np.linspace(0.01, 1.85, 150)])
    points = joint.no_load
    known = column(points.temperature)
    for T, colour in zip(data.TEMPERATURES, COLOURS, strict=False):
        rows = known == T
        axes.plot(points.velocity[rows], points.torque[rows], "o", color=colour, markersize=3)
        at = np.nan_to_num(v)
        line = data.steady(joint.full.model, at, np.full(v.size, T), np.zeros(v.size))
        axes.plot(v, np.where(np.isnan(v), np.nan, line), color=colour, label=f"{T:.0f} degC")
    axes.set(xlabel=SPEED, ylabel=FRICTION)
    legend_above(axes, 5)
    return Picture(
        "figure_4a",
        "figure 4 (a)",
        "Steady friction of joint 2 without load: points and eqs 13 and 16, fitted. As in the "
        "paper friction saturates with speed, falls with temperature, and differs by direction.",
        figure,
    )


def temperature_parameters(joint: Identified) -> Picture:
    """Figure 4(b, c): parameters identified at single temperatures, and the linear model."""
    from stribeck.fitting.fit import fit
    from stribeck.models.build import law
    from stribeck.recording.load import read

    figure = new_figure(9.0, 4.6)
    grid = figure.subplots(2, 3, sharex=True)
    points, model = joint.no_load, joint.full.model
    known = column(points.temperature)
    formula = law(
        "curve = Fc*sgn(v) + s2*(1-exp(-abs(v)/s3))*sgn(v)",
        parameters=["Fc: N m, 0..50", "s2: N m, 0..100", "s3: rad/s, 0.05..3"],
    )
    span = np.array([data.TEMPERATURES[0], data.TEMPERATURES[-1]])
    for row, way, word in zip(grid, (1, -1), ("forward", "backward"), strict=True):
        found = []
        for T in data.TEMPERATURES:
            rows = (known == T) & (np.sign(points.velocity) == way)
            table = {"velocity": points.velocity[rows], "friction_torque": points.torque[rows]}
            one = fit(formula, read(table, average="row", joint_kind="revolute"), starts=3)
            found.append([one.model.value(name) for name in ("Fc", "s2", "s3")])
        level = [model.value(f"viscous_{kind}_{word}") for kind in ("level", "level_slope")]
        speed = [model.value(f"viscous_{kind}_{word}") for kind in ("speed", "speed_slope")]
        lines = (
            ("Fc [N m]", [model.value(f"coulomb_friction_{word}"), 0.0]),
            ("sigma_2 [N m]", level),
            ("sigma_3 [rad/s]", speed),
        )
        for axes, values, (label, (start, slope)) in zip(
            row, zip(*found, strict=True), lines, strict=True
        ):
            style(axes)
            axes.plot(data.TEMPERATURES, values, "o", color=MEASURED, markersize=4)
            axes.plot(span, start + slope * span, color=AFTER)
            axes.set_ylabel(f"{label}, {word}")
            if label.startswith("Fc"):
                axes.set_ylim(0.0, 1.5 * start)
    for axes in grid[1]:
        axes.set_xlabel("temperature [degC]")
    return Picture(
        "figure_4bc",
        "figure 4 (b, c)",
        "Parameters of eq 20 at single temperatures (dots) and those of eq 13 (lines): as in the "
        "paper sigma_2 and sigma_3 are linear in the temperature, and Coulomb friction does not "
        "depend on it.",
        figure,
    )


def load_parameters(joint: Identified) -> Picture:
    """Figure 6: intercept and slope over the load, by speed and quadrant."""
    figure = new_figure(10.0, 4.8)
    grid = figure.subplots(2, 4, sharex="col")
    points, model = joint.loaded, joint.full.model
    load = column(points.load_torque)
    still = data.steady(
        model, points.velocity, column(points.temperature), np.zeros(points.velocity.size)
    )
    extra = points.torque - load - still
    for k, (number, name, way, side) in enumerate(QUADRANTS):
        rows = (np.sign(points.velocity) == way) & (np.sign(load) == side)
        speeds = np.unique(points.velocity[rows])
        fitted = np.array(
            [
                np.polyfit(load[at], extra[at], 1)
                for at in (rows & (points.velocity == s) for s in speeds)
            ]
        )
        rise, rate, jump, friction, viscous = (
            model.value(f"{part}_{name}") for part in data.LOAD_NAMES
        )
        v = np.linspace(0.0, way * 1.85, 100)
        lines = (rise * (1.0 - np.exp(-np.abs(rate * v))) + jump, friction + viscous * v)
        for axes, values, line in zip(grid[:, k], fitted[:, ::-1].T, lines, strict=True):
            style(axes)
            axes.plot(speeds, values, "o", color=AFTER, markersize=4)
            axes.plot(v, line, color=BEFORE)
        grid[0, k].set_title(f"quadrant {number}", loc="left", fontsize=10.5)
        grid[1, k].set_xlabel(SPEED)
    grid[0, 0].set_ylabel("beta [N m]")
    grid[1, 0].set_ylabel("alpha")
    return Picture(
        "figure_6",
        "figure 6",
        "Load terms of eq 15 by quadrant: lines through the points of each speed (dots), and the "
        "identified beta(v) and alpha(v) (lines). As in the paper, alpha is linear and beta "
        "saturates with speed.",
        figure,
    )


def quality(friction: Frictions) -> Picture:
    """Figure 7: measured friction, LuGre and the comprehensive model."""
    figure = new_figure(9.0, 4.4)
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    time = np.arange(friction.measured.size) / 50.0
    for axes in (top, bottom):
        style(axes)
    top.plot(time, friction.measured, color=MEASURED, linewidth=0.8, label="measured")
    top.plot(time, friction.lugre, color=BEFORE, linewidth=1.2, label="LuGre (22)")
    top.plot(time, friction.full, color=AFTER, linewidth=1.2, label="comprehensive model (18)")
    bottom.plot(time, friction.measured - friction.lugre, color=BEFORE, linewidth=0.8)
    bottom.plot(time, friction.measured - friction.full, color=AFTER, linewidth=0.8)
    top.set_ylabel(FRICTION)
    bottom.set(xlabel="time [s]", ylabel="error [N m]")
    legend_above(top, 3)
    return Picture(
        "figure_7",
        "figure 7",
        "Friction of joint 2 under gravity: LuGre misses what depends on the load, the "
        "comprehensive model follows it, as in the paper. The load terms of the stand-in are "
        "larger than the paper's.",
        figure,
    )


def presliding(joints: Sequence[Identified]) -> Picture:
    """Section V-A 3: torque over position below the Coulomb friction."""
    figure = new_figure(9.0, 1.0 + 2.5 * -(-len(joints) // 3))
    grid = figure.subplots(-(-len(joints) // 3), min(3, len(joints)), squeeze=False)
    for axes, joint in zip(grid.flat, joints, strict=False):
        style(axes)
        slow = joint.presliding
        rows = strided(slow.torque.size)
        place = 1e3 * column(slow.position)
        axes.plot(place[rows], slow.torque[rows], ".", color=MEASURED, markersize=1.5)
        stiffness = joint.full.model.value("bristle_stiffness")
        damping = joint.full.model.value("bristle_damping")
        axes.set_title(
            f"joint {joint.axis.number}: sigma_0 {stiffness:.0f}, sigma_1 {damping:.0f}",
            loc="left",
            fontsize=9.5,
        )
    for axes in grid[-1]:
        axes.set_xlabel("position [mrad]")
    for axes in grid[:, 0]:
        axes.set_ylabel("torque [N m]")
    return Picture(
        "presliding",
        "table 2",
        "Presliding loops from which stiffness [N m/rad] and damping [N m s/rad] are identified; "
        "the paper shows none.",
        figure,
    )


def tracking(joints: Sequence[Identified], tracked: Sequence[Tracking]) -> Picture:
    """Figure 10: distributions of the tracking error, joint by joint."""
    figure = new_figure(9.0, 3.4)
    axes = figure.subplots()
    style(axes)
    names = ("without compensation", "LuGre (22)", "comprehensive model (18)")
    for k, (name, colour) in enumerate(zip(names, (MEASURED, BEFORE, AFTER), strict=True)):
        boxes = axes.boxplot(
            [1e3 * t.motions[k].error for t in tracked],
            positions=[4.0 * j + k for j in range(len(joints))],
            widths=0.7,
            whis=(0.0, 100.0),
            patch_artist=True,
            medianprops={"color": "black"},
            boxprops={"facecolor": colour, "alpha": 0.5, "edgecolor": colour},
            whiskerprops={"color": colour},
            capprops={"color": colour},
        )
        boxes["boxes"][0].set_label(name)
    axes.set_xticks([4.0 * j + 1 for j in range(len(joints))])
    axes.set_xticklabels([f"joint {joint.axis.number}" for joint in joints])
    axes.set_ylabel("tracking error [mrad]")
    legend_above(axes, 3)
    return Picture(
        "figure_10",
        "figure 10",
        "Tracking errors, hot and with payload: median, quartiles, smallest and largest. As in the "
        "paper the errors shrink from left to right on every joint; simulated joints have no other "
        "error than friction, and shrink more.",
        figure,
    )


def teaching(taught: Teaching) -> Picture:
    """Figure 11: velocity and the torque of the hand over time."""
    figure = new_figure(9.0, 4.0)
    top, bottom = figure.subplots(2, 1, sharex=True)
    for motion, colour in zip(taught.motions, (FLOOR, BEFORE, AFTER), strict=True):
        time = taught.step * np.arange(motion.controller_torque.size)
        rows = strided(time.size)
        name = "without friction compensation" if motion.compensator is None else motion.name
        top.plot(time[rows], motion.velocity[rows], color=colour, linewidth=1.0)
        bottom.plot(
            time[rows], motion.controller_torque[rows], color=colour, linewidth=1.0, label=name
        )
    for axes in (top, bottom):
        style(axes)
    top.set_ylabel(SPEED)
    bottom.set(xlabel="time [s]", ylabel="torque of the hand [N m]")
    bottom.legend(frameon=False, fontsize=9)
    return Picture(
        "figure_11",
        "figure 11",
        "A hand moves joint 2 at 34 deg/s at 27 degC: with the comprehensive model and factor "
        "0.85 it needs a third of the torque that LuGre with 0.35 leaves, as in the paper.",
        figure,
    )
