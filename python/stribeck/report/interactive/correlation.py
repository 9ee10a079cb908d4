"""Correlations of identified parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bokeh.models import ColorBar, ColumnDataSource, LinearColorMapper, Range1d

from stribeck.report.interactive.base import INK, hover, name_places, new_plot

if TYPE_CHECKING:
    from bokeh.plotting import figure

    from stribeck.identify.errors.matrix import ParameterMatrix

#: From minus one over zero to one; both ends stand out on a light and on a dark ground.
_BLUE = ("#0072B2", "#2f86bd", "#5b9bc8", "#88b1d2", "#b5c8dc")
_RED = ("#dec3b3", "#dfab8a", "#dd9362", "#da793a", "#D55E00")
PALETTE = (*_BLUE, "#c9cdd2", *_RED)


def correlation(matrix: ParameterMatrix) -> figure:
    """The matrix as coloured squares; the pointer names the pair and its correlation.

    Parameters
    ----------
    matrix : ParameterMatrix
        `Fit.correlation`.
    """
    names = [name.replace("_", " ") for name in matrix.names]
    count = len(names)
    pairs = [(i, j) for i in range(count) for j in range(count)]
    source = ColumnDataSource(
        {
            "x": [j for _, j in pairs],
            "y": [i for i, _ in pairs],
            "value": [float(matrix.values[i, j]) for i, j in pairs],
            "pair": [f"{names[i]}, {names[j]}" for i, j in pairs],
        }
    )
    plot = new_plot("", "", tools="save", active=None, height=150 + 28 * count)
    mapper = LinearColorMapper(palette=list(PALETTE), low=-1.0, high=1.0)
    squares = plot.rect(
        "x",
        "y",
        width=0.94,
        height=0.94,
        source=source,
        fill_color={"field": "value", "transform": mapper},
        line_color=None,
    )
    hover(plot, [squares], [("parameters", "@pair"), ("correlation", "@value{0.00}")])
    name_places(plot, names)
    name_places(plot, names, along="x")
    plot.xaxis[0].major_label_orientation = 0.9
    plot.y_range = Range1d(count - 0.5, -0.5)
    plot.x_range = Range1d(-0.5, count - 0.5)
    plot.xgrid.visible = plot.ygrid.visible = False
    plot.add_layout(
        ColorBar(
            color_mapper=mapper,
            title="correlation",
            title_text_color=INK,
            title_text_font_style="normal",
            title_text_font_size="12px",
            major_label_text_color=INK,
            background_fill_alpha=0.0,
            width=12,
        ),
        "right",
    )
    return plot
