"""The change of the mean friction of every joint of a fleet."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from bokeh.models import ColumnDataSource, Range1d, Span, Whisker

from stribeck.report.fleet import joint_name, relative_text
from stribeck.report.fleet_figure import with_friction
from stribeck.report.interactive.base import (
    COLOURS,
    INK,
    MEASURED,
    hover,
    legend_above,
    name_places,
    new_plot,
    range_over,
)
from stribeck.report.numbers import plain, unit_text

if TYPE_CHECKING:
    from bokeh.plotting import figure

    from stribeck.scale.fleet.changes import Change, Changes, JointChange

#: Joints that are named on the axis; of more, the pointer names each.
MOST_NAMED = 40
TALLEST = 640
#: The ends of an interval.
SIDES = ("low", "high")


def fleet_changes(changes: Changes) -> figure:
    """Every joint by the change of its mean friction, with a 95 % interval.

    Parameters
    ----------
    changes : Changes
        `Fleet.changes`, of which at least one has a mean friction.
    """
    drawn = sorted(with_friction(changes), key=lambda pair: pair[1].relative)
    plot = new_plot(
        f"change since {changes.since} [%]",
        "" if len(drawn) <= MOST_NAMED else "joints, by their change",
        tools="pan,box_zoom,reset,save",
        active=None,
        height=min(110 + 26 * len(drawn), TALLEST),
    )
    plot.add_layout(Span(location=0.0, dimension="height", line_color=INK, line_alpha=0.7))
    items, every = [], [_row(k, *pair) for k, pair in enumerate(drawn)]
    for chosen, colour, label in (
        (False, MEASURED, "within the variation from day to day"),
        (True, COLOURS[0], "changed"),
    ):
        rows = [every[k] for k, (joint, _) in enumerate(drawn) if joint.changed == chosen]
        if not rows:
            continue
        source = ColumnDataSource({name: [row[name] for row in rows] for name in rows[0]})
        whisker = Whisker(
            base="place",
            lower="low",
            upper="high",
            dimension="width",
            source=source,
            line_color=colour,
        )
        whisker.upper_head.line_color = whisker.lower_head.line_color = colour
        plot.add_layout(whisker)
        dots = plot.scatter("change", "place", source=source, size=8, color=colour)
        hover(
            plot,
            [dots],
            [("joint", "@joint"), ("change", "@said"), ("mean friction", "@friction")],
        )
        items.append((label, [dots]))
    if len(drawn) <= MOST_NAMED:
        name_places(plot, [joint_name(joint.robot, joint.joint) for joint, _ in drawn])
    else:
        plot.yaxis[0].major_label_text_alpha = 0.0
    plot.x_range = range_over(np.array([0.0, *(row[side] for row in every for side in SIDES)]))
    plot.y_range = Range1d(-0.7, len(drawn) - 0.3)
    plot.ygrid.visible = False
    legend_above(plot, items)
    return plot


def _row(place: int, joint: JointChange, change: Change) -> dict[str, Any]:
    value, error = 100.0 * change.relative, 196.0 * change.stderr / abs(change.before)
    unit = unit_text(change.unit)
    return {
        "place": place,
        "change": value,
        "low": value - error,
        "high": value + error,
        "joint": joint_name(joint.robot, joint.joint),
        "said": relative_text(change.relative),
        "friction": f"{plain(change.before)} → {plain(change.after)} {unit}",
    }
