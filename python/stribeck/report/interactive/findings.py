"""The findings of a diagnosis, ranked, with the evidence for each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from bokeh.models import ColumnDataSource, Range1d, Span

from stribeck.report.interactive.base import (
    COLOURS,
    FLOOR,
    hover,
    legend_above,
    name_places,
    new_plot,
)
from stribeck.report.numbers import change_text, confidence_text, listed, percent, plain

if TYPE_CHECKING:
    from bokeh.models import GlyphRenderer
    from bokeh.plotting import figure

    from stribeck.diagnosis.result import Finding


def findings(found: Sequence[Finding], noise_floor: float | None = None) -> figure:
    """Held-out error with each effect added, best first, beside the error without it.

    The pointer on a bar shows the confidence, where the effect acts, and what it cannot be told
    from. A pale bar is a finding that is less likely than not.

    Parameters
    ----------
    found : sequence of Finding
        At least one; of `Diagnosis.findings`, or the findings of the steps of an improvement.
    noise_floor : float, optional
        In the unit of torque.
    """
    unit = found[0].fit.model.torque_unit
    plot = new_plot(
        f"held-out RMSE [{unit}]",
        "",
        tools="save",
        active=None,
        height=110 + 42 * len(found),
    )
    source = ColumnDataSource(_columns(found))
    before = plot.hbar(
        "place", right="before", height=0.72, source=source, color=COLOURS[0], alpha=0.25
    )
    after = plot.hbar(
        "place", right="after", height=0.72, source=source, color=COLOURS[1], alpha="alpha"
    )
    hover(
        plot,
        [before],
        [
            ("effect", "@effect"),
            ("confidence", "@confidence"),
            ("error", "@error"),
            ("explains", "@share"),
            ("where", "@where"),
            ("cannot be told from", "@ties"),
        ],
    )
    name_places(plot, [f"{k}. {f.effect}" for k, f in enumerate(found, 1)])
    plot.y_range = Range1d(len(found) - 0.5, -0.5)
    largest = max(max(f.rmse_held_out_before, f.rmse_held_out_after) for f in found)
    plot.x_range = Range1d(0.0, 1.06 * largest)
    plot.ygrid.visible = False
    items = [("without the effect", [before]), ("with the effect", [after])]
    if noise_floor is not None:
        items.append((f"noise floor {plain(noise_floor)} {unit}", [floor_line(plot, noise_floor)]))
    legend_above(plot, items)
    return plot


def floor_line(plot: figure, floor: float) -> GlyphRenderer:
    """Mark the noise floor; returns what the legend names."""
    look = {"line_color": FLOOR, "line_dash": "dotted", "line_width": 2}
    plot.add_layout(Span(location=floor, dimension="height", **look))
    named: GlyphRenderer = plot.line([floor] * 2, [0, 0], **look)
    return named


def _columns(found: Sequence[Finding]) -> dict[str, list[object]]:
    unit = found[0].fit.model.torque_unit
    rows = [
        {
            "place": k,
            "effect": f.effect,
            "before": f.rmse_held_out_before,
            "after": f.rmse_held_out_after,
            "alpha": 0.95 if f.confidence >= 0.5 else 0.45,
            "confidence": confidence_text(f.confidence),
            "error": f"{plain(f.rmse_held_out_before)} → {plain(f.rmse_held_out_after)} {unit} "
            f"({change_text(f.rmse_held_out_before, f.rmse_held_out_after)})",
            "share": "unknown: no noise floor"
            if f.share_of_unexplained is None
            else f"{percent(f.share_of_unexplained)} of what is above the noise floor",
            "where": f.where,
            "ties": listed(f.indistinguishable_from) or "nothing",
        }
        for k, f in enumerate(found)
    ]
    return {name: [row[name] for row in rows] for name in rows[0]}
