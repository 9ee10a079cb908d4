"""The error after each step of an improvement, down to the noise floor."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from bokeh.models import ColumnDataSource, Range1d

from stribeck.report.interactive.base import (
    COLOURS,
    hover,
    legend_above,
    name_places,
    new_plot,
)
from stribeck.report.interactive.findings import floor_line
from stribeck.report.numbers import change_text, plain

if TYPE_CHECKING:
    from bokeh.plotting import figure


def falling_error(
    labels: Sequence[str],
    errors: Sequence[float],
    unit: str,
    *,
    noise_floor: float | None = None,
    held_out: bool = True,
) -> figure:
    """One bar a model, from the base to the last step.

    Parameters
    ----------
    labels : sequence of str
        The base model, and the effect that each step added or dropped.
    errors : sequence of float
        RMSE of each, in `unit`.
    noise_floor : float, optional
        In `unit`.
    held_out : bool
        Whether the errors are held-out errors.

    Examples
    --------
    >>> falling_error(["coulomb", "+ load"], [0.5, 0.2], "N m").xaxis[0].axis_label
    'held-out RMSE [N m]'
    """
    what = "held-out RMSE" if held_out else "RMSE"
    plot = new_plot(
        f"{what} [{unit}]", "", tools="save", active=None, height=110 + 34 * len(labels)
    )
    falls = ["", *(change_text(a, b) for a, b in pairwise(errors))]
    source = ColumnDataSource(
        {
            "place": list(range(len(labels))),
            "error": list(errors),
            "label": list(labels),
            "said": [f"{plain(e)} {unit}" for e in errors],
            "fall": falls,
            "colour": [COLOURS[0], *[COLOURS[1]] * (len(labels) - 1)],
        }
    )
    bars = plot.hbar("place", right="error", height=0.66, source=source, color="colour")
    hover(plot, [bars], [("model", "@label"), (what, "@said"), ("change", "@fall")])
    name_places(plot, list(labels))
    plot.y_range = Range1d(len(labels) - 0.5, -0.5)
    plot.x_range = Range1d(0.0, 1.06 * max(*errors, noise_floor or 0.0))
    plot.ygrid.visible = False
    if noise_floor is not None:
        named = floor_line(plot, noise_floor)
        legend_above(plot, [(f"noise floor {plain(noise_floor)} {unit}", [named])])
    return plot
