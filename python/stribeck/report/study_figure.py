"""Figures of a study: box plots of the torque error, and friction against velocity."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stribeck.base.errors import joint_called
from stribeck.report.channels import torque_name
from stribeck.report.numbers import MINUS, plain, thousands
from stribeck.report.style import AFTER, BEFORE, FLOOR, MEASURED, new_figure, style
from stribeck.scale.study.plan import DYNAMIC, STATIC, THERMAL

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    from stribeck.scale.study.assess import Entry, Spread
    from stribeck.scale.study.result import Study

COLOURS = {STATIC.id: AFTER, THERMAL.id: BEFORE, DYNAMIC.id: FLOOR}
NAMES = {
    STATIC.id: "static",
    THERMAL.id: "static, with temperature or load",
    DYNAMIC.id: "dynamic",
}
COLUMNS = 5


def _of_joint(study: Study, joint: str | None) -> list[tuple[str, str, Entry]]:
    """Group, law and results of each law fitted to a joint, table by table."""
    return [
        (table.group.id, row.law, row.entries[joint])
        for table in study.tables
        for row in table.rows
        if joint in row.entries
    ]


def _name(study: Study, joint: str | None) -> str:
    return "" if joint is None else f", {joint_called(joint)}"


def error_figure(study: Study, joint: str | None) -> Figure:
    """Box plots of the torque error of every law on one joint: all speeds, and low speed.

    As figures 7, 12 and 15 of the review: the line is the median, the box ends at the quartiles,
    whiskers reach to the last sample within 1.5 box lengths. Samples beyond are not drawn.
    """
    from matplotlib.patches import Patch

    rows = _of_joint(study, joint)
    data = study.joints[joint]
    quantity = torque_name(data.torque_unit)
    figure = new_figure(10.5, 2.2 + 0.27 * len(rows))
    both = figure.subplots(1, 2, sharey=True)
    slow = f"|v| < {plain(data.low_speed, 2)} {data.velocity_unit}"
    spreads = [
        ("all speeds", [entry.whole for _, _, entry in rows]),
        (slow, [entry.low_speed for _, _, entry in rows]),
    ]
    at = _places([group for group, _, _ in rows])
    for axes, (title, boxes) in zip(both, spreads, strict=True):
        style(axes)
        axes.axvline(0.0, color=MEASURED, linewidth=0.8)
        for place, (group, _, _), spread in zip(at, rows, boxes, strict=True):
            _box(axes, place, spread, COLOURS[group])
        axes.set_title(f"{title} ({thousands(boxes[0].rows)} samples)", loc="left", fontsize=10.5)
        axes.set_xlabel(f"{quantity} error, measured {MINUS} modelled [{data.torque_unit}]")
    both[0].set_yticks(at, [law for _, law, _ in rows])
    both[0].set_ylim(max(at) + 0.7, min(at) - 0.7)
    figure.supxlabel(
        "line: median; box: quartiles; whiskers: last sample within 1.5 box lengths",
        fontsize=8,
        color=MEASURED,
    )
    used = [group for group in COLOURS if any(group == g for g, _, _ in rows)]
    figure.legend(
        handles=[
            Patch(facecolor=_tint(COLOURS[group]), edgecolor=COLOURS[group], label=NAMES[group])
            for group in used
        ],
        loc="outside upper center",
        ncols=len(used),
        frameon=False,
        fontsize=9,
        title=f"{quantity.capitalize()} error of each law{_name(study, joint)}",
    )
    return figure


def _places(groups: list[str]) -> list[float]:
    """One unit a law, and half a unit between tables."""
    places, at = [], 0.0
    for k, group in enumerate(groups):
        at += 0.0 if k == 0 else 1.0 if group == groups[k - 1] else 1.6
        places.append(at)
    return places


def _box(axes: Axes, place: float, spread: Spread, colour: str) -> None:
    if spread.rows == 0:
        axes.text(0.0, place, " no samples", va="center", fontsize=8, color=MEASURED)
        return
    low, middle, high = spread.quartiles
    stats = {
        "q1": low,
        "med": middle,
        "q3": high,
        "whislo": spread.whiskers[0],
        "whishi": spread.whiskers[1],
    }
    line = {"color": colour, "linewidth": 1.2}
    axes.bxp(
        [stats],
        positions=[place],
        orientation="horizontal",
        widths=0.62,
        showfliers=False,
        patch_artist=True,
        manage_ticks=False,
        medianprops={"color": "black", "linewidth": 1.3},
        boxprops={"facecolor": _tint(colour), "edgecolor": colour, "linewidth": 1.2},
        whiskerprops=line,
        capprops=line,
    )


def _tint(colour: str) -> str:
    """A light shade of a colour."""
    parts = [int(colour[k : k + 2], 16) for k in (1, 3, 5)]
    return "#" + "".join(f"{round(255 - 0.45 * (255 - part)):02x}" for part in parts)


def friction_figure(study: Study, joint: str | None) -> Figure:
    """Friction against velocity on one joint, measured and modelled, one panel a law."""
    rows = _of_joint(study, joint)
    data = study.joints[joint]
    unit = data.torque_unit
    columns = min(COLUMNS, len(rows))
    lines = -(-len(rows) // columns)
    width, height = max(2.5 * columns, 5.0), 1.3 + 2.0 * lines
    figure = new_figure(width, height, layout=None)
    grid = figure.subplots(lines, columns, sharex=True, sharey=True, squeeze=False)
    # A layout engine would take longer than drawing with this many panels.
    figure.subplots_adjust(
        left=0.72 / width,
        right=1.0 - 0.1 / width,
        bottom=0.6 / height,
        top=1.0 - 0.85 / height,
        wspace=0.08,
        hspace=0.22,
    )
    dots = {"linestyle": "none", "marker": ".", "markeredgewidth": 0, "rasterized": True}
    for axes in grid.flat[len(rows) :]:
        axes.set_visible(False)
    for axes, (group, law, entry) in zip(grid.flat, rows, strict=False):
        style(axes)
        cloud = entry.cloud
        axes.plot(cloud.velocity, cloud.measured, color="#b0b0b0", markersize=3.0, **dots)
        axes.plot(cloud.velocity, cloud.modelled, color=COLOURS[group], markersize=2.2, **dots)
        axes.set_title(f"{law}: {plain(entry.whole.rms)} {unit}", loc="left", fontsize=9, pad=3.0)
        axes.tick_params(labelsize=8)
    low, high = np.quantile(np.concatenate([e.cloud.measured for _, _, e in rows]), [0.001, 0.999])
    grid[0, 0].set_ylim(low - 0.1 * (high - low), high + 0.1 * (high - low))
    for axes in grid.flat[max(len(rows) - columns, 0) : len(rows)]:
        axes.tick_params(labelbottom=True)
    figure.supxlabel(f"velocity [{data.velocity_unit}]", fontsize=10, y=0.08 / height)
    figure.supylabel(f"friction {torque_name(unit)} [{unit}]", fontsize=10, x=0.08 / width)
    used = [group for group in COLOURS if any(group == g for g, _, _ in rows)]
    handles = [_dot("#b0b0b0", "measured")]
    handles += [_dot(COLOURS[group], f"modelled, {NAMES[group]}") for group in used]
    figure.legend(
        handles=handles,
        loc="upper center",
        ncols=len(handles),
        frameon=False,
        fontsize=9,
        title=f"Friction against velocity{_name(study, joint)} (law: RMS error)",
    )
    return figure


def _dot(colour: str, label: str) -> Line2D:
    from matplotlib.lines import Line2D

    return Line2D([], [], linestyle="none", marker="o", markersize=6, color=colour, label=label)
