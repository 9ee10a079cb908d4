"""One joint of a robot: friction over velocity, and the residual over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bokeh.models import BoxSelectTool

from stribeck.report.interactive.base import (
    COLOURS,
    MEASURED,
    begin_with,
    hover,
    legend_above,
    new_plot,
    zero_line,
)
from stribeck.report.interactive.dots import UNSELECTED, legend_dot
from stribeck.report.interactive.robot_samples import RobotSamples

if TYPE_CHECKING:
    from bokeh.models import GlyphRenderer
    from bokeh.plotting import figure


def joint_friction(samples: RobotSamples, number: int) -> figure:
    """Torque minus that of the rigid bodies over velocity, and the friction of the model.

    Parameters
    ----------
    samples : RobotSamples
        As `robot_samples` makes them; a selection in one figure marks the samples in all.
    number : int
        Which joint, from 0.
    """
    labels = samples.joints[number]
    plot = new_plot(labels.velocity, labels.friction, height=300)
    zero_line(plot)
    items = []
    for name, column, colour in (
        ("torque minus rigid bodies", "friction", MEASURED),
        (labels.spec, "modelled", COLOURS[1]),
    ):
        dots = _dots(plot, samples, f"velocity_{number}", f"{column}_{number}", colour, 0.25)
        items.append((name, [dots, legend_dot(plot, colour)]))
    _said(plot, items[0][1][:1], samples, number)
    limits = samples.limits
    begin_with(plot, x=limits[f"velocity_{number}"], y=limits[f"friction_{number}"])
    legend_above(plot, items)
    return plot


def joint_residual(samples: RobotSamples, number: int, *, x_range: object = None) -> figure:
    """The residual of a joint over time; a drag selects a stretch of time.

    Parameters
    ----------
    number : int
        Which joint, from 0.
    x_range
        Range of time of another figure, to share it.
    """
    labels = samples.joints[number]
    plot = new_plot(
        samples.time_label,
        labels.residual,
        tools="pan,box_zoom,reset,save",
        active=None,
        x_range=x_range,
        height=300,
    )
    select = BoxSelectTool(dimensions="width")
    plot.add_tools(select)
    plot.toolbar.active_drag = select
    zero_line(plot)
    dots = _dots(plot, samples, "time", f"residual_{number}", COLOURS[1], 0.5)
    _said(plot, [dots], samples, number)
    begin_with(plot, y=samples.limits[f"residual_{number}"])
    return plot


def _dots(
    plot: figure, samples: RobotSamples, x: str, y: str, colour: str, alpha: float
) -> GlyphRenderer:
    dots: GlyphRenderer = plot.scatter(
        x,
        y,
        source=samples.source,
        marker="square",
        size=3,
        color=colour,
        alpha=alpha,
        line_color=None,
        selection_alpha=0.9,
        nonselection_alpha=UNSELECTED,
    )
    return dots


def _said(plot: figure, shown: list[GlyphRenderer], samples: RobotSamples, k: int) -> None:
    labels = samples.joints[k]
    unit = labels.friction[labels.friction.rindex("[") + 1 : -1]
    hover(
        plot,
        shown,
        [
            ("time", "@time{0.000} s"),
            ("friction", f"@friction_{k}{{0.000}} {unit}"),
            ("residual", f"@residual_{k}{{0.000}} {unit}"),
        ],
    )
