"""Which share of the joints of a fleet has each effect."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bokeh.models import ColumnDataSource, Range1d

from stribeck.report.interactive.base import COLOURS, INK, hover, name_places, new_plot
from stribeck.report.numbers import listed, percent

if TYPE_CHECKING:
    from bokeh.plotting import figure

    from stribeck.scale.fleet.effects import Effects


def fleet_effects(effects: Effects) -> figure:
    """A square for each name of a joint and effect, darker the more of these joints have it.

    The pointer names the robots that have an effect which their peers lack; these squares are
    framed.

    Parameters
    ----------
    effects : Effects
        `Fleet.effects`, with at least one share.
    """
    rows = list(dict.fromkeys(share.joint for share in effects.shares))
    columns = list(dict.fromkeys(share.effect for share in effects.shares))
    source = ColumnDataSource(_cells(effects, rows, columns))
    plot = new_plot("", "", tools="save", active=None, height=150 + 34 * len(rows))
    squares = plot.rect(
        "x",
        "y",
        width=0.94,
        height=0.9,
        source=source,
        fill_color=COLOURS[1],
        fill_alpha="alpha",
        line_color=COLOURS[0],
        line_width="frame",
    )
    plot.text(
        "x",
        "y",
        text="text",
        source=source,
        text_align="center",
        text_baseline="middle",
        text_font_size="12px",
        text_color=INK,
    )
    hover(
        plot,
        [squares],
        [("joint, effect", "@joint"), ("joints with it", "@said"), ("stand out", "@odd")],
    )
    name_places(plot, [row or "unnamed" for row in rows])
    name_places(plot, columns, along="x")
    plot.xaxis[0].major_label_orientation = 0.6
    plot.x_range = Range1d(-0.5, len(columns) - 0.5)
    plot.y_range = Range1d(len(rows) - 0.5, -0.5)
    plot.xgrid.visible = plot.ygrid.visible = False
    return plot


def _cells(effects: Effects, rows: list[str | None], columns: list[str]) -> dict[str, list[object]]:
    """What is drawn and said of each square, by column."""
    made: dict[str, list[object]] = {}
    for share in effects.shares:
        part = share.having / share.joints
        odd = [
            each.robot or "unnamed"
            for each in effects.odd
            if (each.joint, each.effect) == (share.joint, share.effect)
        ]
        cell = {
            "x": columns.index(share.effect),
            "y": rows.index(share.joint),
            "alpha": 0.65 * part,
            "frame": 2.5 if odd else 0.0,
            "text": percent(part) if share.having else "",
            "joint": f"{share.joint or 'unnamed'}, {share.effect}",
            "said": f"{share.having} of {share.joints}",
            "odd": listed(odd) or "none",
        }
        for name, value in cell.items():
            made.setdefault(name, []).append(value)
    return made
