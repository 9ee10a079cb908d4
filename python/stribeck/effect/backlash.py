"""Backlash: play of the teeth, in which the motor does not carry the load."""

from __future__ import annotations

import numpy as np

from stribeck.effect.base import (
    Array,
    Effect,
    GeneratedRecording,
    Identified,
    JointSizes,
    Obstacle,
    ResidualView,
    number,
)
from stribeck.effect.columns import hats, time_since_sign_change
from stribeck.effect.facts import RecordingFacts, sign_changes
from stribeck.effect.load import UNKNOWN_LOAD
from stribeck.effect.presliding import FEWEST_REVERSALS, NO_REVERSALS
from stribeck.models.model import Model
from stribeck.recording.recording import Recording


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    if facts.recording.averaged:
        return NO_REVERSALS
    # Beside friction that was measured directly, zero stands for the load torque.
    if facts.load is None or "friction_torque" in facts.recording.columns:
        return UNKNOWN_LOAD
    changes = sign_changes(facts.recording, facts.load[facts.recording.moving])
    if changes >= FEWEST_REVERSALS:
        return None
    times = f"{changes} time{'s' * (changes != 1)}"
    return Obstacle(
        f"the load torque changes its sign {times} in motion, so that the teeth seldom cross the "
        f"gap",
        "move through the angle at which the load is balanced, back and forth",
    )


def _constants(recording: Recording) -> dict[str, float]:
    return {"reference_velocity": recording.scales()["speed"] or 1.0}


def _generated_constants(made: GeneratedRecording) -> dict[str, float]:
    return {"reference_velocity": made.joint.speed}


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    meanwhile = m.value("backlash_gap")
    seconds = meanwhile / m.constants["reference_velocity"]
    return (
        f"after the load torque changes its sign the motor does not carry it for about "
        f"{number(1e3 * seconds)} ms; the play is less than the {number(meanwhile)} "
        f"{m.position_unit} that the joint moves in that time"
    )


def _flexible_shape(fit: Identified) -> list[Array]:
    """The load and its change, as any function of the time since the load changed its sign."""
    r = fit.recording
    load = r.load_torque if r.load_torque is not None else fit.load
    if load is None:
        return []
    since = time_since_sign_change(r, load)
    speed = fit.model.constants["reference_velocity"]
    closing = 4.0 * fit.model.value("backlash_gap") / speed
    near = np.exp(-((since / closing) ** 2))[fit.rows]
    early = hats(np.minimum(since[fit.rows] / closing, 2.0), 6)
    change = np.gradient(load)[fit.rows]
    return [near * x for x in (load[fit.rows], change)] + [
        x * h * near for x in (load[fit.rows], change) for h in early
    ]


def _alike(_: Identified, after: Identified) -> tuple[str, ...]:
    """The torque of an elasticity is much like it, and needs a load torque known beforehand."""
    return () if after.recording.load_torque is not None else ("elasticity",)


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {
        "backlash_gap": 0.08 * joint.stroke,
        "backlash_exponent": 0.6,
        "backlash_return": 0.4,
    }


def _cannot_hide(model: Model, load: Array) -> str | None:
    if load.min() < 0.0 < load.max():
        return None
    return (
        "backlash shows where the load torque changes its sign, which it never does on this "
        "joint: give a revolute one, or more seconds"
    )


EFFECT = Effect(
    id="backlash",
    view=ResidualView("load_reversal", along="load", log=True),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    constants=_constants,
    generated_constants=_generated_constants,
    flexible_shape=_flexible_shape,
    alike=_alike,
    size_range=(5.0, 1e-2),
    design_note=(
        "teeth change flanks only where the load torque changes its sign: choose a payload or an "
        "orientation that balances the joint within its range"
    ),
    in_shocks=True,
    in_motion="drive train",
    cannot_hide=_cannot_hide,
)
