"""Stribeck effect: friction falls from its break-away level as the speed grows."""

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
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.free_form import OF_SPEED
from stribeck.models.model import Model

#: Slow motion: slower than this share of the top speed.
SLOW = 0.15
#: Slow samples needed in each direction: a number, and a share of all.
FEWEST_SLOW, SHARE_SLOW = 20, 0.002
#: The same of steady-state points, and the number that is always enough.
FEWEST_SLOW_POINTS, ENOUGH_SLOW_POINTS = 5, 2

#: Share of the height that must be left at the slowest speed that is scored, since otherwise the
#: curve is not seen, and that may be left at the top speed: with more, friction is never seen to
#: settle, and the curve imitates a bent viscous one.
LEFT = 0.1
#: Coulomb friction below this share of the height of the curve is none.
NO_COULOMB = 0.01


def no_slow_motion(facts: RecordingFacts) -> Obstacle | None:
    """Slow motion is missing in a direction in which the joint moves."""
    top = facts.top_speed
    slow = facts.speed < SLOW * top
    signs = (1.0, -1.0) if facts.both_directions else (np.sign(facts.forward - 0.5),)
    fewest = min(int(np.count_nonzero(slow & (sign * facts.velocity > 0))) for sign in signs)
    averaged = facts.recording.averaged
    needed = max(FEWEST_SLOW_POINTS if averaged else FEWEST_SLOW, SHARE_SLOW * facts.speed.size)
    if fewest >= needed or (averaged and fewest >= ENOUGH_SLOW_POINTS):
        return None
    both = " in both directions" if facts.both_directions else ""
    return Obstacle(
        f"almost no motion is slower than {SLOW * top:.3g} {facts.recording.position_unit}/s "
        f"({SLOW:.0%} of the top speed)",
        f"add slow passes{both}, down to a few per cent of the top speed",
    )


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    return (
        f"at low speed friction is {number(m.value('stribeck_height'))} {m.load_unit} higher than "
        f"the Coulomb level and falls to it around {number(m.value('stribeck_velocity'))} "
        f"{m.position_unit}/s{_under_load(after)}"
    )


def _under_load(after: Identified) -> str:
    """What a load, of the RMS recorded, adds to the height, where that is the larger part."""
    m = after.model
    if "load" not in m.effects:
        return ""
    usual = m.constants["reference_load"]
    part = m.value("load_stribeck") * usual
    if part <= m.value("stribeck_height"):
        return ""
    slow = m.value("stribeck_velocity") * m.value("load_stribeck_ratio")
    return (
        f", and under {number(usual)} {m.load_unit} of load {number(part)} {m.load_unit} more, "
        f"falling around {number(slow)} {m.position_unit}/s"
    )


def _flexible_shape(fit: Identified) -> list[Array]:
    """Curves that fall at smaller and larger speeds."""
    v = fit.recording.velocity[fit.rows]
    slow = fit.model.value("stribeck_velocity")
    return [np.sign(v) * np.exp(-np.abs(v) / (slow * k)) for k in (0.3, 1.0, 3.0)]


def _left(model: Model, speed: float) -> float:
    """Share of the height of the curve at a speed."""
    ratio = speed / model.value("stribeck_velocity")
    return float(np.exp(-(ratio ** model.value("stribeck_exponent"))))


def _falls_around(model: Model) -> str:
    slow = number(model.value("stribeck_velocity"))
    return f"friction would fall around {slow} {model.position_unit}/s"


def _unresolved(after: Identified) -> str | None:
    m, slowest = after.model, after.recording.velocity_threshold
    if _left(m, slowest) >= LEFT:
        return None
    least = f"{number(slowest)} {m.position_unit}/s"
    return f"{_falls_around(m)}, slower than what is scored, {least}"


def _out_of_reach(after: Identified) -> str | None:
    m, r = after.model, after.recording
    top = float(np.quantile(np.abs(r.velocity[after.rows]), 0.99))
    if _left(m, top) <= LEFT:
        return None
    return f"{_falls_around(m)}, and the joint reaches only {number(top)} {m.position_unit}/s"


def _alike(_: Identified, after: Identified) -> tuple[str, ...]:
    """Where no Coulomb friction is left below it, the curve may be one of viscous friction."""
    m = after.model
    # With a load the dry friction may be in proportion to that, without a constant part.
    if "load" in m.effects or not {"coulomb_friction", "stribeck_height"} <= set(m.names):
        return ()
    left, height = m.value("coulomb_friction"), m.value("stribeck_height")
    return () if left >= NO_COULOMB * height else ("nonlinear_viscous",)


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {
        "stribeck_height": 0.35 * joint.coulomb,
        "stribeck_velocity": 0.05 * joint.speed,
        "stribeck_exponent": 1.4,
    }


EFFECT = Effect(
    id="stribeck",
    view=ResidualView("speed", along="motion", log=True),
    obstacle=no_slow_motion,
    where=_where,
    plausible=_plausible,
    flexible_shape=_flexible_shape,
    alike=_alike,
    free_form=OF_SPEED,
    unresolved=_unresolved,
    out_of_reach=_out_of_reach,
)
