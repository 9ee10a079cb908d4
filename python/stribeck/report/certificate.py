"""A check of passivity as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from stribeck.passivity.certificate import MEANING
from stribeck.report.layout import paragraph
from stribeck.report.numbers import listed

if TYPE_CHECKING:
    from stribeck.passivity.certificate import Certificate, Counterexample, Margin

#: Units of a box's sides other than those of the joint.
UNITS = {"temperature": "degC", "time": "s"}

#: Smaller torques than this are those of viscous friction next to rest: zero.
REST = 1e-20


def certificate_text(certificate: Certificate) -> str:
    """The whole answer."""
    lines = [_verdict(certificate)]
    if certificate.counterexample is not None:
        lines += _motion(certificate.counterexample)
    unit = certificate.friction.torque_unit
    shown = [m for m in certificate.margins if m.lower is not None]
    if shown:
        lines.append("  Smallest margin of each condition over the whole box, as a proved bound:")
        lines += [f"    {_bound(m, unit):>12}  {MEANING[m.condition]}" for m in shown]
    if certificate.passive and certificate.condition in ("storage", "cycle", "elements"):
        lines.append(paragraph(f"The proof uses this condition: {MEANING[certificate.condition]}."))
    if certificate.left_out:
        are = "is" if len(certificate.left_out) == 1 else "are"
        checked = f"Only the friction {certificate.friction.spec} was checked"
        lines.append(paragraph(f"{checked}; {listed(certificate.left_out)} {are} not friction."))
    return "\n".join(lines)


def _verdict(certificate: Certificate) -> str:
    spec, where = certificate.model.spec, _box(certificate)
    if certificate.passive is None:
        undecided = paragraph(f"Cannot decide whether {spec} is passive for {where}:", 0, 2)
        return undecided + "\n" + paragraph(f"{certificate.why}.", 2)
    if certificate.passive:
        return paragraph(f"{spec} is passive for {where}: proved over the whole box.", 0, 2)
    return paragraph(f"{spec} is not passive for {where}.", 0, 2)


def _box(certificate: Certificate) -> str:
    return ", ".join(
        f"{name} {low:.4g} to {high:.4g} {_unit(certificate, name)}"
        for name, (low, high) in certificate.box.items()
    )


def _unit(certificate: Certificate, channel: str) -> str:
    position = certificate.friction.position_unit
    units = {
        "velocity": f"{position}/s",
        "position": position,
        "acceleration": f"{position}/s2",
        **UNITS,
    }
    return units.get(channel, certificate.friction.torque_unit)


def _motion(example: Counterexample) -> list[str]:
    unit = example.friction.position_unit
    start = f"This {example.kind} generates energy"
    if example.deflection is not None:
        start += f", from a bristle deflection of {example.deflection:.6g} {unit}"
    returned = ""
    if example.kind != "operating point":
        returned = "; the bristle returns to where it was"
    return [
        f"  {start}:",
        *(f"    {_step(step, unit)}" for step in example.steps),
        f"  Net work {example.net_work:.3g} J, by the model's exact step{returned}.",
    ]


def _step(step: Mapping[str, float], unit: str) -> str:
    others = [
        f"{name} {value:.6g}"
        for name, value in step.items()
        if name not in ("velocity", "duration")
    ]
    held = f"velocity {step['velocity']:.6g} {unit}/s for {step['duration']:.6g} s"
    return ", ".join([held, *others])


def _bound(margin: Margin, unit: str) -> str:
    """The smallest margin where the condition holds, else by how much it is violated."""
    lower = margin.lower or 0.0
    if lower < 0.0:
        return f"{lower:.3g} {unit}"
    # For viscous friction the smallest margin is that of the slowest motion.
    return f"≥ {0.0 if lower < REST else lower:.3g} {unit}"
