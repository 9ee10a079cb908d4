"""The figures of the UR5e review, for joint 1."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.benchmark.reproduce import ur5e_data as data
from stribeck.benchmark.reproduce.result import Picture
from stribeck.motion.generate.ur5e import JOINTS, UR5E
from stribeck.report.style import AFTER, BEFORE, COLOURS, MEASURED, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stribeck.benchmark.reproduce.ur5e_review import Fitted

Array = NDArray[np.float64]

SPEED, FRICTION = "velocity [rad/s]", "friction torque [N m]"
#: Low speed of the lower box plots, and of the magnified hysteresis, rad/s.
SLOW, VERY_SLOW = 0.1, 0.02


def motions(seed: int) -> Iterable[Picture]:
    """Figures 3, 4, 5, 8 and 9: the motions of the arm, its torques and its friction."""
    paths, others = [], []
    for test, number in ((1, 4), (2, 8)):
        planned = data.robot(test, seed).trajectory
        clock = np.linspace(0.0, planned.seconds, 1500)
        q, v, a = planned(clock)
        paths.append((test, _tool(q)))
        others.append(_trajectory(number, test, clock, (q, v, a, _rates(clock, _tool(q)))))
        others.append(_torques(number + 1, test, seed))
    figure = new_figure(9.0, 4.0)
    for k, (test, path) in enumerate(paths):
        axes = figure.add_subplot(1, 2, k + 1, projection="3d")
        axes.plot(*path.T, color=AFTER, linewidth=1.0)
        axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
        axes.set_title(f"Test {test}", loc="left", fontsize=10.5)
    yield Picture(
        "figure_3",
        "figure 3",
        "Path of the end effector in both tests: other way points than the review's, of the same "
        "kind.",
        figure,
    )
    yield from others


def _tool(q: Array) -> Array:
    """Positions of the end effector by the arm's Denavit-Hartenberg parameters, m, array [n, 3]."""
    pose = np.tile(np.eye(4), (q.shape[0], 1, 1))
    for k in range(q.shape[1]):
        c, s = np.cos(q[:, k]), np.sin(q[:, k])
        ca, sa = np.cos(UR5E.twist[k]), np.sin(UR5E.twist[k])
        step = np.zeros_like(pose)
        step[:, 0] = np.stack([c, -s * ca, s * sa, UR5E.length[k] * c], axis=1)
        step[:, 1] = np.stack([s, c * ca, -c * sa, UR5E.length[k] * s], axis=1)
        step[:, 2] = [0.0, sa, ca, UR5E.offset[k]]
        step[:, 3, 3] = 1.0
        pose = pose @ step
    return pose[:, :3, 3]


def _rates(clock: Array, path: Array) -> Array:
    return np.gradient(path, clock, axis=0)


def _trajectory(number: int, test: int, clock: Array, rows: Sequence[Array]) -> Picture:
    figure = new_figure(9.0, 6.4)
    labels = ("q [rad]", "dq/dt [rad/s]", "d2q/dt2 [rad/s2]", "end effector [m/s]")
    for axes, values, label in zip(figure.subplots(4, 1, sharex=True), rows, labels, strict=True):
        style(axes)
        names = (
            ("x", "y", "z") if values.shape[1] == 3 else tuple(f"joint {k}" for k in range(1, 7))
        )
        for column, name, colour in zip(values.T, names, COLOURS, strict=False):
            axes.plot(clock, column, color=colour, linewidth=0.9, label=name)
        axes.set_ylabel(label)
        axes.legend(frameon=False, fontsize=7.5, loc="center left", bbox_to_anchor=(1.0, 0.5))
    axes.set_xlabel("time [s]")
    return Picture(
        f"figure_{number}",
        f"figure {number}",
        f"Positions, velocities and accelerations of Test {test}, and the end effector's "
        "velocity: the same profiles and limits as in the review between other way points.",
        figure,
    )


def _torques(number: int, test: int, seed: int) -> Picture:
    """Figures 5 and 9: torque and friction of each joint; first and last cycle of Test 2."""
    arm = data.robot(test, seed)
    figure = new_figure(10.0, 4.6)
    grid = figure.subplots(2, 3, sharex=True)
    for k, (axes, joint) in enumerate(zip(grid.flat, JOINTS, strict=True)):
        style(axes)
        motor = arm.drives[k].motor
        frames = list(arm.cycles(joint))
        for frame, colour, name in zip(frames, (AFTER, BEFORE), ("first", "last"), strict=False):
            clock = frame["time"] - frame["time"][0]
            torque = frame["current"] * (motor.gear_ratio * motor.kt)
            if len(frames) == 1:
                axes.plot(clock, torque, color=MEASURED, linewidth=0.7, label="joint torque")
            label = "friction" if len(frames) == 1 else f"friction, {name} cycle"
            axes.plot(
                clock, torque - frame["load_torque"], color=colour, linewidth=0.7, label=label
            )
        axes.set_title(f"joint {k + 1}", loc="left", fontsize=10)
    for axes in grid[1]:
        axes.set_xlabel("time [s]")
    for axes in grid[:, 0]:
        axes.set_ylabel("torque [N m]")
    lines, names = grid[0, 2].get_legend_handles_labels()
    figure.legend(lines, names, loc="outside upper right", ncols=2, frameon=False, fontsize=9)
    said = (
        "Joint torque and friction over time, Test 1."
        if test == 1
        else "Friction in the first and the last of 90 cycles: it falls as joints warm up, as in "
        "the review."
    )
    return Picture(f"figure_{number}", f"figure {number}", said, figure)


def _cloud(axes: Axes, fitted: Fitted, colour: str, label: str) -> None:
    recording = fitted.fit.recording
    load = recording.load_torque
    assert load is not None
    order = np.argsort(recording.velocity)
    v = recording.velocity[order]
    axes.plot(v, (recording.torque - load)[order], ".", color="#bbbbbb", markersize=2, zorder=1)
    axes.plot(
        v, (fitted.fit.prediction - load)[order], ".", color=colour, markersize=2, label=label
    )


def velocity_laws(fitted: Sequence[Fitted]) -> Picture:
    """Figure 6: friction over velocity, and three laws."""
    figure = new_figure(6.5, 4.0)
    axes = figure.subplots()
    style(axes)
    shown = [f for f in fitted if f.law in ("coulomb", "gaz_a", "indri_a")]
    for one, colour in zip(shown, (BEFORE, AFTER, COLOURS[2]), strict=False):
        _cloud(axes, one, colour, one.law)
    axes.set(xlabel=SPEED, ylabel=FRICTION)
    axes.legend(frameon=False, markerscale=5, fontsize=9)
    return Picture(
        "figure_6",
        "figure 6 (joint 1)",
        "Friction over velocity in Test 1 (grey) and three laws fitted to it: as in the review, "
        "about ±40 N m at the top speed, and the laws differ below 0.5 rad/s.",
        figure,
    )


def boxes(number: int, fitted: Sequence[Fitted]) -> Picture:
    """Figures 7, 12 and 15: torque errors of each law, over all speeds and at low speed."""
    figure = new_figure(9.0, 1.2 + 0.32 * len(fitted))
    whole, slow = figure.subplots(1, 2, sharey=True)
    for axes, title in ((whole, "all speeds"), (slow, f"|v| < {SLOW} rad/s")):
        style(axes)
        errors = [
            f.error[np.abs(f.fit.recording.velocity) < (SLOW if axes is slow else np.inf)]
            for f in fitted
        ]
        axes.boxplot(
            errors,
            orientation="horizontal",
            showfliers=False,
            widths=0.6,
            manage_ticks=False,
            medianprops={"color": BEFORE},
        )
        axes.set_title(title, loc="left", fontsize=10.5)
        axes.set_xlabel("torque error [N m]")
    whole.set_yticks(range(1, len(fitted) + 1), [f.law for f in fitted])
    whole.invert_yaxis()
    figure_of = {4: 7, 5: 12, 6: 15}[number]
    return Picture(
        f"figure_{figure_of}",
        f"figure {figure_of} (joint 1)",
        f"Torque errors of the laws of table {number}: medians, quartiles, whiskers at 1.5 box "
        "lengths. The same laws as in the review stand out by wider boxes.",
        figure,
    )


def warm_laws(motion: data.Motion, fitted: Sequence[Fitted]) -> Iterable[Picture]:
    """Figures 10 and 11: friction over velocity and temperature with two laws."""
    for number, law in ((10, "li"), (11, "iskandar")):
        for one in (f for f in fitted if f.law == law):
            figure = new_figure(9.0, 3.6)
            left, right = figure.subplots(1, 2, sharey=True)
            load = motion.load
            for axes, torque, title in (
                (left, one.fit.recording.torque, "simulated measurement"),
                (right, one.fit.prediction, f"{law}, fitted"),
            ):
                style(axes)
                dots = axes.scatter(
                    motion.velocity, torque - load, c=motion.temperature, s=3, cmap="viridis"
                )
                axes.set_title(title, loc="left", fontsize=10.5)
                axes.set_xlabel(SPEED)
            left.set_ylabel(FRICTION)
            figure.colorbar(dots, ax=(left, right), label="temperature [degC]")
            yield Picture(
                f"figure_{number}",
                f"figure {number} (joint 1)",
                "Friction over velocity, coloured by temperature: as in the review it falls as the "
                "joint warms up, with li's printed parameters by no more than 1.2 N m.",
                figure,
            )


def hysteresis(fitted: Sequence[Fitted]) -> Iterable[Picture]:
    """Figures 13 and 14: friction over velocity with a bristle, and magnified at very low speed."""
    for number, law in ((13, "lugre"), (14, "indri_b")):
        for one in (f for f in fitted if f.law == law):
            figure = new_figure(9.0, 3.6)
            left, right = figure.subplots(1, 2)
            for axes in (left, right):
                style(axes)
                _cloud(axes, one, AFTER, law)
                axes.set_xlabel(SPEED)
            right.set_xlim(-VERY_SLOW, VERY_SLOW)
            left.set_ylabel(FRICTION)
            right.set_title("very low speed", loc="left", fontsize=10.5)
            yield Picture(
                f"figure_{number}",
                f"figure {number} (joint 1)",
                f"{law} on the first cycle of Test 2: near zero speed one speed has several "
                "frictions, as in the review.",
                figure,
            )
