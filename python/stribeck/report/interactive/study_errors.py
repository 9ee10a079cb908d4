"""The torque error of every law of a study on one joint, as box plots."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bokeh.models import ColumnDataSource, Range1d, Span

from stribeck.report.channels import torque_name
from stribeck.report.interactive.base import (
    COLOURS,
    INK,
    hover,
    legend_above,
    name_places,
    new_plot,
)
from stribeck.report.numbers import plain
from stribeck.scale.study.plan import DYNAMIC, STATIC, THERMAL

if TYPE_CHECKING:
    from bokeh.plotting import figure

    from stribeck.scale.study.assess import Spread
    from stribeck.scale.study.result import Study

GROUPS = {
    STATIC.id: (COLOURS[1], "static"),
    THERMAL.id: (COLOURS[0], "static, with temperature or load"),
    DYNAMIC.id: (COLOURS[2], "dynamic"),
}


def study_errors(study: Study, joint: str | None, *, low_speed: bool = False) -> figure:
    """Median, quartiles and whiskers of the error of each law, the smallest RMS first.

    Whiskers reach to the last sample within 1.5 box lengths, as in the UR5e review.

    Parameters
    ----------
    joint : str or None
        A key of `Study.joints`.
    low_speed : bool
        Only the samples at low speed.
    """
    data = study.joints[joint]
    found = [
        (table.group.id, row.law, entry.low_speed if low_speed else entry.whole)
        for table, row, of, entry in study.entries()
        if of == joint
    ]
    found = sorted((row for row in found if row[2].rows > 0), key=lambda row: row[2].rms)
    unit = data.torque_unit
    plot = new_plot(
        f"{torque_name(unit)} error [{unit}]",
        "",
        tools="save",
        active=None,
        height=130 + 20 * max(len(found), 1),
    )
    plot.add_layout(Span(location=0.0, dimension="height", line_color=INK, line_alpha=0.7))
    items = []
    for group, (colour, name) in GROUPS.items():
        rows = [_row(k, law, s, unit) for k, (of, law, s) in enumerate(found) if of == group]
        if not rows:
            continue
        source = ColumnDataSource({key: [row[key] for row in rows] for key in rows[0]})
        whisker = plot.segment("wl", "place", "wh", "place", source=source, color=colour)
        box = plot.hbar(
            "place", left="q1", right="q3", height=0.62, source=source, color=colour, alpha=0.55
        )
        middle = plot.scatter(
            "median", "place", source=source, size=7, marker="dash", angle=1.5708, color=INK
        )
        hover(
            plot,
            [box],
            [("law", "@law"), ("RMS", "@rms"), ("median", "@median_said"), ("quartiles", "@box")],
        )
        items.append((name, [box, whisker, middle]))
    name_places(plot, [law for _, law, _ in found])
    plot.y_range = Range1d(max(len(found), 1) - 0.4, -0.6)
    plot.ygrid.visible = False
    legend_above(plot, items)
    return plot


def _row(place: int, law: str, spread: Spread, unit: str) -> dict[str, object]:
    low, middle, high = spread.quartiles
    return {
        "place": place,
        "law": law,
        "wl": spread.whiskers[0],
        "q1": low,
        "median": middle,
        "q3": high,
        "wh": spread.whiskers[1],
        "rms": f"{plain(spread.rms)} {unit}",
        "median_said": f"{plain(middle)} {unit}",
        "box": f"{plain(low)} to {plain(high)} {unit}",
    }
