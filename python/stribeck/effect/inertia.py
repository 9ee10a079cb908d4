"""Inertia: the load torque assumes a wrong inertia."""

from __future__ import annotations

from functools import partial

import numpy as np

from stribeck.effect.base import (
    Array,
    Effect,
    FixedForm,
    Identified,
    JointSizes,
    Obstacle,
    ResidualView,
    number,
)
from stribeck.effect.columns import hats
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.load_parts import absorbed, alike

#: A joint that takes longer than this (s) to reach its top speed hardly accelerates.
SLOWEST_START = 60.0


def hardly_accelerates(facts: RecordingFacts) -> Obstacle | None:
    """The motion is steady, or nearly so."""
    a = facts.scored(facts.recording.acceleration)
    if a is None or facts.recording.averaged:
        return Obstacle("steady motion contains no acceleration", "record accelerated motion")
    if float(np.sqrt(np.mean(a**2))) < facts.top_speed / SLOWEST_START:
        return Obstacle("the joint accelerates too little", "record accelerated motion")
    return None


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    unit = next(p.unit for p in m.parameters if p.name == "inertia")
    value = m.value("inertia")
    error = "missing from" if value > 0 else "too much in"
    return (
        f"the residual grows with acceleration, as if {number(abs(value))} {unit} of inertia were "
        f"{error} the load torque"
    )


def _functions_of_acceleration(fit: Identified) -> list[Array]:
    a = fit.recording.acceleration
    return [] if a is None else [np.sign(a[fit.rows]), *hats(a[fit.rows], 9)]


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"inertia": 0.4 * joint.inertia}


EFFECT = Effect(
    id="inertia",
    view=ResidualView("acceleration"),
    obstacle=hardly_accelerates,
    where=_where,
    plausible=_plausible,
    fixed_form=FixedForm("acceleration", _functions_of_acceleration),
    absorbed=partial(absorbed, "inertia"),
    alike=partial(alike, "inertia"),
)
