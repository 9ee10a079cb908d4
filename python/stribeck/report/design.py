"""What `stribeck plan` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report.numbers import listed, plain
from stribeck.report.text import notes_text, paragraph, table, unit_text

if TYPE_CHECKING:
    from stribeck.motion.design.result import Plan, Prospect, Size


def plan_text(plan: Plan) -> str:
    """A plan at a glance: the motion, what it shows, what it cannot do."""
    limits, unit = plan.limits, plan.model.position_unit
    effects = [row.effect for row in plan.prospects]
    parts = [
        paragraph(
            f"A motion of {plain(plan.duration)} s that shows {listed(effects)} beside "
            f"{plan.model.spec}: {plan.kind}, within {plain(limits.low)} .. {plain(limits.high)} "
            f"{unit}, {plain(limits.speed)} {unit}/s and {plain(limits.acceleration)} {unit}/s2.",
            0,
        ),
        "The smallest effect that a diagnosis sees 19 times in 20, by size and by torque (RMS):",
        table(_rows(plan), right=(2, 3, 4)),
    ]
    parts += [_cosines(plan)] if plan.cosines else []
    advice: dict[str, list[str]] = {row.advice: [] for row in plan.prospects if row.advice}
    for row in plan.prospects:
        if row.advice:
            advice[row.advice].append(row.effect)
    if advice:
        lines = ["What this motion cannot do:"]
        lines += [paragraph(f"• {listed(names)}: {text}.", 2, 2) for text, names in advice.items()]
        parts.append("\n".join(lines))
    parts.append(notes_text(plan.notes))
    return "\n\n".join(part for part in parts if part)


def _rows(plan: Plan) -> list[list[str]]:
    head = ["effect", "parameter", "on this data", "planned", "gain"]
    rows = [_row(row, plan.model.torque_unit) for row in plan.prospects]
    if plan.source is None:
        return [[r[0], r[1], r[3]] for r in [head, *rows]]
    return [head, *rows]


def _row(row: Prospect, torque_unit: str) -> list[str]:
    gain = "" if row.gain is None else f"{plain(row.gain, 2)} times"
    unit = "" if row.unit == "1" else f" {unit_text(row.unit)}"
    name = f"{row.parameter}, {'up to' if row.inverse else 'from'}"
    before, after = (_size(size, unit, torque_unit) for size in (row.before, row.after))
    return [row.effect, name, before, after, gain]


def _size(size: Size | None, unit: str, torque_unit: str) -> str:
    if size is None:
        return ""
    if size.value is None or size.rms is None:
        return "at no size"
    return f"{plain(size.value, 2)}{unit} ({plain(size.rms, 2)} {torque_unit})"


def _cosines(plan: Plan) -> str:
    lines = ["How alike they look beside the model (0 not at all, 1 the same):"]
    for pair, (before, after) in plan.cosines.items():
        here = "" if before is None else f"{before:.3f} on this data, "
        lines.append(f"  • {listed(pair)}: {here}{after:.3f} planned.")
    return "\n".join(lines)
