"""Samples as dots that a selection in any figure marks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report.channels import torque_name

if TYPE_CHECKING:
    from bokeh.models import GlyphRenderer
    from bokeh.plotting import figure

    from stribeck.report.interactive.samples import Samples

#: With fewer samples than this, dots are large and opaque.
FEW = 1500
#: Opacity of samples that are not in the selection.
UNSELECTED = 0.04


def sample_dots(
    plot: figure, samples: Samples, x: str, y: str, colour: str, *, alpha: float | None = None
) -> GlyphRenderer:
    """Draw a column against another; with a selection, other samples fade.

    Parameters
    ----------
    alpha
        Opacity without a selection; default: by the number of samples.
    """
    few = len(samples.source.data["row"]) < FEW
    shown = (0.7 if few else 0.2) if alpha is None else alpha
    dots: GlyphRenderer = plot.scatter(
        x,
        y,
        source=samples.source,
        size=5 if few else 3.5,
        color=colour,
        alpha=shown,
        line_color=None,
        selection_color=colour,
        selection_alpha=0.9,
        nonselection_color=colour,
        nonselection_alpha=min(UNSELECTED, shown),
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
