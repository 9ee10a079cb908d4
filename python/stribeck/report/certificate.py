"""A check of passivity as text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from stribeck.passivity.certificate import MEANING
from stribeck.report.layout import paragraph
from stribeck.report.numbers import listed

if TYPE_CHECKING:
    from stribeck.models.model import Model
    from stribeck.passivity.certificate import Certificate, Counterexample, Margin

#: Units of a box's sides other than those of the joint.
UNITS = {"temperature": "degC", "time": "s"}

#: Smaller torques than this are those of viscous friction next to rest: zero.
REST = 1e-20
#: A bound below zero by less than this share of the dry friction is rounded outwards from zero.
ROUNDING = 1e-12


@dataclass(frozen=True)
class Part:
    """A sentence, and what is listed below it: a bound, which may be empty, and what it is of."""

    sentence: str
    items: tuple[tuple[str, str], ...] = ()

    @property
    def rows(self) -> list[str]:
        """The list for a page: what each bound is of, then the bound."""
        return [f"{of}: {bound}" if bound else of for bound, of in self.items]


def certificate_text(certificate: Certificate) -> str:
    """The whole answer."""
    lines = []
    for k, part in enumerate(certificate_parts(certificate)):
        lines.append(paragraph(part.sentence, 2 if k else 0, 2))
        lines += [f"    {f'{bound:>12}  ' if bound else ''}{of}" for bound, of in part.items]
    return "\n".join(lines)


def certificate_parts(certificate: Certificate) -> list[Part]:
    """The sentences of the answer, each with what is listed below it."""
    parts = _verdict(certificate)
    if certificate.counterexample is not None:
        parts += _motion(certificate, certificate.counterexample)
    friction = certificate.friction
    shown = [m for m in certificate.margins if m.lower is not None]
    if shown:
        bounds = tuple((_bound(m, friction), MEANING[m.condition]) for m in shown)
        said = "Smallest margin of each condition over the whole box, as a proved bound:"
        parts.append(Part(said, bounds))
    if certificate.passive and certificate.condition in ("storage", "cycle", "elements"):
        parts.append(Part(f"The proof uses this condition: {MEANING[certificate.condition]}."))
    if certificate.left_out:
        are = "is" if len(certificate.left_out) == 1 else "are"
        checked = f"Only the friction {certificate.friction.spec} was checked"
        parts.append(Part(f"{checked}; {listed(certificate.left_out)} {are} not friction."))
    return parts


def _verdict(certificate: Certificate) -> list[Part]:
    spec, where = certificate.model.spec, _box(certificate)
    if certificate.passive is None:
        undecided = f"Cannot decide whether {spec} is passive for {where}:"
        return [Part(undecided), Part(f"{certificate.why}.")]
    if certificate.passive:
        return [Part(f"{spec} is passive for {where}: proved over the whole box.")]
    return [Part(f"{spec} is not passive for {where}.")]


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


def _motion(certificate: Certificate, example: Counterexample) -> list[Part]:
    unit = example.friction.position_unit
    start = f"This {example.kind} generates energy"
    if example.deflection is not None:
        start += f", from a bristle deflection of {example.deflection:.6g} {unit}"
    returned = ""
    if example.kind != "operating point":
        returned = "; the bristle returns to where it was"
    return [
        Part(f"{start}:", tuple(("", _step(certificate, step)) for step in example.steps)),
        Part(f"Net work {example.net_work:.3g} J, by the model's exact step{returned}."),
    ]


def _step(certificate: Certificate, step: Mapping[str, float]) -> str:
    others = [
        f"{name} {value:.6g} {_unit(certificate, name)}"
        for name, value in step.items()
        if name not in ("velocity", "duration")
    ]
    speed = _unit(certificate, "velocity")
    held = f"velocity {step['velocity']:.6g} {speed} for {step['duration']:.6g} s"
    return ", ".join([held, *others])


def _bound(margin: Margin, friction: Model) -> str:
    """The smallest margin where the condition holds, else by how much it is violated."""
    lower, unit = margin.lower or 0.0, friction.torque_unit
    if lower < -ROUNDING * _dry(friction):
        return f"{lower:.3g} {unit}"
    if lower < 0.0:
        return f"0 {unit} within rounding"
    # For viscous friction the smallest margin is that of the slowest motion.
    return f"≥ {0.0 if lower < REST else lower:.3g} {unit}"


def _dry(friction: Model) -> float:
    """Sum of the sizes of all dry friction, in the unit of torque."""
    rows = zip(friction.parameters, friction.values, strict=True)
    return sum(abs(float(value)) for row, value in rows if row.role == "dry")
