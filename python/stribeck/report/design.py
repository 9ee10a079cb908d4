"""A planned motion: text and figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stribeck.report.layout import bullets, joined, notes_text, paragraph, table
from stribeck.report.numbers import listed, plain, unit_text
from stribeck.report.style import AFTER, BEFORE, headline, new_figure, style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stribeck.motion.design.result import Plan, Prospect, Size


def plan_text(plan: Plan) -> str:
    """A plan at a glance: the motion, what it shows, what it cannot do."""
    limits, unit, made = plan.limits, plan.model.position_unit, plan.motion
    effects = [row.effect for row in plan.prospects]
    motion = (
        f"A motion of {plain(plan.duration)} s to test {listed(effects)} with the model "
        f"{plan.model.spec}: {plan.kind}, position {plain(float(made.position.min()))} to "
        f"{plain(float(made.position.max()))} {unit} (limits {plain(limits.low)} to "
        f"{plain(limits.high)}), speed up to {plain(float(np.abs(made.velocity).max()))} {unit}/s "
        f"(limit {plain(limits.speed)}), acceleration up to "
        f"{plain(float(np.abs(made.acceleration).max()))} {unit}/s2 (limit "
        f"{plain(limits.acceleration)})."
    )
    smallest = (
        "Smallest effect that is significant 19 times in 20, as the value of its parameter and "
        "as torque (RMS):"
    )
    return joined(
        paragraph(motion, 0),
        paragraph(smallest, 0),
        table(_rows(plan), right=(2, 3, 4), whole=(0, 1)),
        _cosines(plan),
        bullets("What this motion cannot do:", _advice(plan)),
        notes_text(plan.notes),
    )


def _advice(plan: Plan) -> list[str]:
    """What cannot be done, effects with the same advice together."""
    effects: dict[str, list[str]] = {}
    for row in plan.prospects:
        if row.advice:
            effects.setdefault(row.advice, []).append(row.effect)
    return [f"{listed(names)}: {text}." for text, names in effects.items()]


def _rows(plan: Plan) -> list[list[str]]:
    head = ["effect", "parameter", "on this data", "planned", "gain"]
    rows = [head, *(_row(row, plan.model.torque_unit) for row in plan.prospects)]
    return rows if plan.source is not None else [[r[0], r[1], r[3]] for r in rows]


def _row(row: Prospect, torque_unit: str) -> list[str]:
    gain = "" if row.gain is None else f"{plain(row.gain, 2)} times"
    unit = "" if row.unit == "1" else f" {unit_text(row.unit)}"
    name = f"{row.parameter} (at most)" if row.inverse else row.parameter
    before, after = (_size(size, unit, torque_unit) for size in (row.before, row.after))
    return [row.effect, name, before, after, gain]


def _size(size: Size | None, unit: str, torque_unit: str) -> str:
    if size is None:
        return ""
    if size.value is None or size.rms is None:
        return "cannot be tested"
    return f"{plain(size.value, 2)}{unit} ({plain(size.rms, 2)} {torque_unit})"


def _cosines(plan: Plan) -> str:
    return bullets(
        "Similarity of effects (0: none, 1: indistinguishable):",
        [
            f"{listed(pair)}: {'' if before is None else f'{before:.3f} on this data, '}"
            f"{after:.3f} planned."
            for pair, (before, after) in plan.cosines.items()
        ],
    )


def plan_figure(plan: Plan) -> Figure:
    """Position, velocity and acceleration over time, each with its limits."""
    m, limits, unit = plan.motion, plan.limits, plan.model.position_unit
    figure = new_figure(9.0, 6.5)
    panels = (
        (f"position [{unit}]", m.position, (limits.low, limits.high)),
        (f"velocity [{unit}/s]", m.velocity, (-limits.speed, limits.speed)),
        (f"acceleration [{unit}/s²]", m.acceleration, (-limits.acceleration, limits.acceleration)),
    )
    for axes, (label, values, ends) in zip(figure.subplots(3, 1, sharex=True), panels, strict=True):
        style(axes)
        axes.plot(m.time, values, color=AFTER, linewidth=1.0)
        for end in ends:
            axes.axhline(end, color=BEFORE, linewidth=0.9, linestyle="--")
        axes.set_ylabel(label)
    axes.set_xlabel("time [s]")
    effects = listed([row.effect for row in plan.prospects])
    headline(figure, f"{plan.kind} to test {effects}; limits dashed", 11)
    return figure
