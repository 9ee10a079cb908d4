"""A planned motion over time, with its limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bokeh.models import ColumnDataSource, Range1d, Span

from stribeck.report.interactive.base import COLOURS, hover, new_plot

if TYPE_CHECKING:
    from bokeh.plotting import figure

    from stribeck.motion.design.result import Plan


def planned(plan: Plan) -> dict[str, figure]:
    """Position, velocity and acceleration over time, limits dashed; one range of time.

    Parameters
    ----------
    plan : Plan
        As `stribeck.plan` makes it.

    Returns
    -------
    dict of figures
        ``"planned position"``, ``"planned velocity"`` and ``"planned acceleration"``.
    """
    motion, limits, unit = plan.motion, plan.limits, plan.model.position_unit
    rows = (
        ("position", motion.position, unit, (limits.low, limits.high)),
        ("velocity", motion.velocity, f"{unit}/s", (-limits.speed, limits.speed)),
        (
            "acceleration",
            motion.acceleration,
            f"{unit}/s²",
            (-limits.acceleration, limits.acceleration),
        ),
    )
    source = ColumnDataSource({"time": motion.time, **{name: values for name, values, *_ in rows}})
    made: dict[str, figure] = {}
    for name, _, of, ends in rows:
        plot = new_plot(
            "time [s]",
            f"{name} [{of}]",
            tools="xpan,xbox_zoom,reset,save",
            active="xbox_zoom",
            height=230,
            x_range=next(iter(made.values())).x_range if made else None,
        )
        line = plot.line("time", name, source=source, color=COLOURS[1], line_width=1.4)
        room = 0.06 * (ends[1] - ends[0])
        plot.y_range = Range1d(ends[0] - room, ends[1] + room)
        for end in ends:
            plot.add_layout(
                Span(location=end, dimension="width", line_color=COLOURS[0], line_dash="dashed")
            )
        hover(plot, [line], [("time", "@time{0.00} s"), (name, f"@{name}{{0.000}} {of}")])
        made[f"planned {name}"] = plot
    return made
