"""Paths of the loop whose effects are chosen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import stribeck as sb
from stribeck.diagnosis.diagnose import diagnose
from stribeck.diagnosis.loop.path import ImprovementPath, ImprovementStep


def path_through(base: sb.Fit, effects: Sequence[str]) -> ImprovementPath:
    """The path from `base` that adds these effects in order, whatever the evidence."""
    said = diagnose(base, brief=True)
    steps: list[ImprovementStep] = []
    current = base
    for effect in effects:
        after = sb.add(current, effect, starts=1)
        finding = replace(said.findings[0], effect=effect, before=current, fit=after)
        steps.append(ImprovementStep(finding, current, after))
        current = after
    return ImprovementPath(base, said, tuple(steps))
