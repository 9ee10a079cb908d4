"""Priors, constraints, ties and the loss of a fit, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report.numbers import plain

if TYPE_CHECKING:
    from stribeck.fitting.result import Fit


def stated_text(fit: Fit) -> str:
    """What was stated about the parameters, one statement a line; empty without any."""
    under = fit.under
    if under is None:
        return ""
    lines = [
        ("constraint", held.text, "active" if held.active else f"slack {plain(held.slack)}")
        for held in under.constraints
    ]
    lines += [("tie", f"{name} = {text}", "") for name, text in under.ties.items()]
    for name, (mean, deviation) in under.priors.items():
        lines.append(("prior", f"{name} = {plain(mean)} ± {plain(deviation)}", ""))
    loss = under.objective.loss
    if loss is not None:
        scale = f"scale {plain(loss.scale)} {fit.model.torque_unit}"
        lines.append(("loss", loss.name, scale))
    first, second = max(len(a) for a, _, _ in lines), max(len(b) for _, b, _ in lines)
    return "\n".join(f"  {a:<{first}}  {b:<{second}}  {c}".rstrip() for a, b, c in lines)
