"""Presliding: after a reversal friction builds up over a distance, as bristles bend."""

from __future__ import annotations

import numpy as np

from stribeck.effect.base import (
    Array,
    Effect,
    Identified,
    JointSizes,
    Obstacle,
    ResidualView,
    number,
)
from stribeck.effect.columns import displacement_since_reversal, hats
from stribeck.effect.facts import RecordingFacts
from stribeck.recording.motion.moves import moves

#: Reversals needed to see what happens in them.
FEWEST_REVERSALS = 4
#: Scored samples within the distance over which friction builds up, after each of them.
INSIDE = 2

#: What to say of averaged points where reversals are needed.
NO_REVERSALS = Obstacle(
    "steady-state points contain no reversals", "record the motion through reversals"
)


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    if facts.recording.averaged:
        return NO_REVERSALS
    if facts.reversals >= FEWEST_REVERSALS:
        return None
    return Obstacle(
        f"there {'is 1 reversal' if facts.reversals == 1 else f'are {facts.reversals} reversals'}",
        "record small back-and-forth motions through zero speed",
    )


def _distance(after: Identified) -> float:
    """Distance over which friction builds up, rad or m; where the load changes it, at its RMS."""
    m = after.model
    slow = 1e-3 * max(abs(x) for x in m.box["velocity"])
    usual = {"load_torque": m.constants["reference_load"]} if "load" in m.effects else {}
    return float(m.split(slow, **usual)["dry"][0]) / m.value("presliding_stiffness")


def _where(before: Identified, after: Identified) -> str:
    return (
        f"after each reversal friction builds up over about {number(_distance(after))} "
        f"{after.model.position_unit} of motion instead of jumping"
    )


def _unresolved(after: Identified) -> str | None:
    r, distance = after.recording, _distance(after)
    inside = r.moving & (displacement_since_reversal(r) <= distance)
    seen = np.bincount(np.maximum(moves(r)[inside], 0)) >= INSIDE
    if int(seen.sum()) >= FEWEST_REVERSALS:
        return None
    return (
        f"friction would build up over {number(distance)} {after.model.position_unit}, which the "
        f"joint passes within a sample or slower than the sensor resolves"
    )


def _flexible_shape(fit: Identified) -> list[Array]:
    """Any function of the distance since the last reversal."""
    sign = np.sign(fit.recording.velocity[fit.rows])
    travel = displacement_since_reversal(fit.recording)[fit.rows]
    return [sign * h for h in hats(np.log(travel + 1e-9 * (travel.max() or 1.0)), 8)]


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {
        "presliding_stiffness": 150.0 * joint.coulomb / joint.stroke,
        "presliding_damping": 0.1 * joint.viscous,
    }


EFFECT = Effect(
    id="presliding",
    view=ResidualView("reversal", along="motion", log=True),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    flexible_shape=_flexible_shape,
    # The stiffer the bristles, the smaller the effect.
    size_range=(1.0, 1e4),
    unresolved=_unresolved,
    design_note=(
        "presliding ends after micrometres to millimetres: record at the highest rate and at the "
        "finest resolution of the encoder"
    ),
)
