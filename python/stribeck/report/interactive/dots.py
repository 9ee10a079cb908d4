"""Samples as dots that a selection in any figure marks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report.channels import torque_name

if TYPE_CHECKING:
    from bokeh.models import ColumnDataSource, GlyphRenderer
    from bokeh.plotting import figure

    from stribeck.report.interactive.samples import Samples

#: With fewer samples than this, dots are large and opaque.
FEW = 1500
#: Opacity of samples that are not in the selection.
UNSELECTED = 0.04


def sample_dots(plot: figure, samples: Samples, x: str, y: str, colour: str) -> GlyphRenderer:
    """Draw a column against another; with a selection, other samples fade."""
    few = len(samples.source.data["row"]) < FEW
    dots: GlyphRenderer = plot.scatter(
        x,
        y,
        source=samples.source,
        # Many squares are painted in two thirds of the time of circles.
        marker="circle" if few else "square",
        size=5 if few else 3,
        color=colour,
        alpha=0.7 if few else 0.2,
        line_color=None,
        selection_color=colour,
        selection_alpha=0.9,
        nonselection_color=colour,
        nonselection_alpha=UNSELECTED,
    )
    return dots


def selected_dots(
    plot: figure, source: ColumnDataSource, x: str, y: str, colour: str
) -> GlyphRenderer:
    """Draw the selected samples of a source, and no others."""
    dots: GlyphRenderer = plot.scatter(
        x,
        y,
        source=source,
        size=4,
        fill_color=None,
        line_color=None,
        selection_fill_color=colour,
        selection_fill_alpha=0.9,
        selection_line_color=None,
        nonselection_fill_color=None,
        nonselection_line_color=None,
    )
    return dots


def legend_dot(plot: figure, colour: str) -> GlyphRenderer:
    """A dot for the legend alone, large and opaque where those of the samples are not."""
    dot: GlyphRenderer = plot.scatter([float("nan")], [float("nan")], size=8, color=colour)
    return dot


def sample_rows(samples: Samples, *models: int) -> list[tuple[str, str]]:
    """What is said of the sample under the pointer."""
    unit, what = samples.unit, torque_name(samples.unit)
    rows = [
        ("time", "@time{0.000} s"),
        ("velocity", f"@velocity{{0.0000}} {samples.velocity_unit}"),
        (what, f"@torque{{0.0000}} {unit}"),
    ]
    if "temperature" in samples.labels:
        rows.append(("temperature", "@temperature{0.0} °C"))
    for k in models:
        rows.append((f"residual, {samples.names[k]}", f"@residual_{k}{{0.0000}} {unit}"))
    return rows if not samples.fits[0].recording.averaged else rows[1:]
