"""The picture of a planned motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from stribeck.report.figures import AFTER, BEFORE, DPI
from stribeck.report.numbers import listed

if TYPE_CHECKING:
    from stribeck.motion.design.result import Plan


def plan_figure(plan: Plan) -> Figure:
    """Position, speed and acceleration over time, each with its limits."""
    m, limits, unit = plan.motion, plan.limits, plan.model.position_unit
    figure = Figure(figsize=(9.0, 6.5), dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    panels = (
        (f"position [{unit}]", m.position, (limits.low, limits.high)),
        (f"speed [{unit}/s]", m.velocity, (-limits.speed, limits.speed)),
        (f"acceleration [{unit}/s²]", m.acceleration, (-limits.acceleration, limits.acceleration)),
    )
    for axes, (label, values, ends) in zip(figure.subplots(3, 1, sharex=True), panels, strict=True):
        axes.plot(m.time, values, color=AFTER, linewidth=1.0)
        for end in ends:
            axes.axhline(end, color=BEFORE, linewidth=0.9, linestyle="--")
        axes.set_ylabel(label)
        axes.spines[["top", "right"]].set_visible(False)
    axes.set_xlabel("time [s]")
    figure.suptitle(
        f"{plan.kind} to show {listed([row.effect for row in plan.prospects])}; limits dashed",
        fontsize=11, x=0.01, ha="left",
    )  # fmt: skip
    return figure
