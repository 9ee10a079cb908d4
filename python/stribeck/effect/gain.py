"""Gain: a wrong torque constant or gear ratio scales the whole motor torque."""

from __future__ import annotations

from functools import partial

import numpy as np

from stribeck.base.errors import option
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
from stribeck.effect.columns import odd_powers
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.load import PAYLOAD_NOTE, load_is_too_uniform
from stribeck.effect.load_parts import absorbed, alike
from stribeck.effect.registry import of_catalog
from stribeck.models.model import Model
from stribeck.recording.recording import Recording


def motor_torque_is_not_known(facts: RecordingFacts) -> Obstacle | None:
    """The motor torque was not recorded, or its load part is not known beforehand."""
    if (why := load_is_too_uniform(facts)) is not None:
        return why
    if facts.recording.load_torque is None:
        return Obstacle(
            "the load torque is identified together with the friction, and absorbs any error of "
            "the torque constant",
            "give the load torque, or inertia and gravity from a weighing or a CAD model",
        )
    if not facts.recording.torque_holds_load:
        return Obstacle(
            "the motor torque itself, load included, was not recorded",
            "record the motor torque, or the current with its torque constant",
        )
    return None


def needs_motor_torque(effect: str, recording: Recording) -> str | None:
    """Refuse a recording whose torque does not contain a load that is known beforehand."""
    if recording.torque_holds_load:
        return None
    return (
        f"{effect} distorts the whole motor torque, so {recording.path} must hold it and a "
        "load_torque that is known beforehand: map one with "
        f"{option('map', 'load_torque=COLUMN')}, or leave the effect out"
    )


def _refusal(model: Model, recording: Recording) -> str | None:
    return needs_motor_torque("gain", recording)


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    share = m.value("gain")
    most = max(abs(x) for x in m.box["load_torque"])
    error, other = ("too much", "small") if share > 0 else ("too little", "large")
    percent = number(100 * abs(share))
    return (
        f"the torque channel shows {percent} % {error} of all torque, "
        f"{number(abs(share) * most)} {m.load_unit} under {number(most)} "
        f"{m.load_unit} of load, at any speed; a load torque that is {percent} % too {other}, as "
        f"of a wrong mass, looks the same"
    )


def _functions_of_torque(fit: Identified) -> list[Array]:
    total = fit.prediction[fit.rows]
    return odd_powers(total, float(np.abs(total).max()))


def _alike(before: Identified, after: Identified) -> tuple[str, ...]:
    """Friction that differs between the quadrants by a share of the load, friction rescaled.

    Any friction may be larger by the gain; what remains of it is a share of the load torque in the
    direction of the load, whether the joint drives it or is driven. An inertia or a weight is
    another, where the load torque is no more than its torque.
    """
    rigid = alike("gain", before, after)
    if "quadrant" in after.model.effects:
        return rigid
    facts = RecordingFacts.of(after.recording, after.load)
    return rigid if of_catalog("quadrant").obstacle(facts) else (*rigid, "quadrant")


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"gain": 0.08}


EFFECT = Effect(
    id="gain",
    view=ResidualView("modelled"),
    obstacle=motor_torque_is_not_known,
    where=_where,
    plausible=_plausible,
    refusal=_refusal,
    fixed_form=FixedForm("load_torque", _functions_of_torque),
    design_note=PAYLOAD_NOTE,
    absorbed=partial(absorbed, "gain"),
    alike=_alike,
    in_motion="measurement",
)
