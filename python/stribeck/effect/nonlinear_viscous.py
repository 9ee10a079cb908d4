"""Nonlinear viscous friction: the part that grows with speed is not proportional to it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
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
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.free_form import OF_SPEED
from stribeck.recording.recording import Recording

#: Ratio of fast to slow speeds from which the curve shows.
SPEED_RATIO = 2.5
#: Samples follow a curve from this share of it on, if it exceeds so many standard errors.
LEAST_SHARE, SURE = 0.5, 4.0
#: The slowest samples, as a share.
SLOWEST = 0.1
#: Shares of the curve in these samples: below the first it acts on the others too, below the second
#: it does where they follow it.
FEW, MOST = 0.5, 0.75


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    low, high = np.quantile(facts.speed, [0.05, 0.98])
    if high >= SPEED_RATIO * max(low, 1e-300):
        return None
    return Obstacle(
        f"the speeds lie between {low:.3g} and {high:.3g} {facts.recording.position_unit}/s, too "
        "narrow a range to show a curve",
        "move at speeds from a tenth of the top speed to the top speed",
    )


def _constants(recording: Recording) -> dict[str, float]:
    return {"reference_velocity": recording.scales()["speed"] or 1.0}


def _curve(after: Identified, speed: Array | float) -> Array:
    """The effect over its coefficient and the reference velocity, at speeds of any shape."""
    m = after.model
    reference, saturation = (
        m.constants["reference_velocity"],
        m.value("nonlinear_viscous_saturation"),
    )
    levelled = speed / reference * (1.0 + reference / saturation) / (1.0 + speed / saturation)
    return np.asarray(levelled ** m.value("nonlinear_viscous_exponent"))


def _out_of_reach(after: Identified) -> str | None:
    """Why it is no more than dry friction that is smaller at the slowest speeds."""
    speed = np.abs(after.recording.velocity[after.rows])
    slow = float(np.quantile(speed, SLOWEST))
    fast = speed > slow
    bend = _bend(after, speed)
    share = float(np.sum(bend[~fast] ** 2) / max(float(np.sum(bend**2)), np.finfo(float).tiny))
    if share < FEW or (share < MOST and _is_followed(after, after.rows[fast])):
        return None
    # A curve that bends by more than the error at the other speeds too shows there.
    error = (after.recording.torque - after.prediction)[after.rows][fast]
    if np.sum(_bend(after, speed[fast]) ** 2) > np.sum(error**2):
        return None
    return (
        f"it changes friction below {number(slow)} {after.model.position_unit}/s alone, the "
        f"slowest {100 * SLOWEST:.0f} % of the samples, and is dry friction above"
    )


def _is_followed(after: Identified, rows: NDArray[np.intp]) -> bool:
    """Whether the torque of these samples [m] bends as the effect says.

    A share of the bend is fitted beside dry and viscous friction; its error is that of blocks.
    """
    r = after.recording
    v, sign = r.velocity[rows], np.sign(r.velocity[rows])
    bend = sign * _bend(after, np.abs(v))
    columns = np.column_stack([bend, sign, v])
    target = (r.torque - after.prediction)[rows] + bend
    block = r.block[rows]
    shares = [
        linear.least_norm(columns[block != left], target[block != left])[0]
        for left in np.unique(block)
    ]
    share = float(linear.least_norm(columns, target)[0])
    error = math.sqrt((len(shares) - 1) * float(np.var(shares)))
    return share > max(LEAST_SHARE, SURE * error)


def _bend(after: Identified, speed: Array) -> Array:
    """The torque of the effect at speeds [m] that no dry and viscous friction has."""
    m = after.model
    torque = m.value("nonlinear_viscous_coefficient") * _curve(after, speed)
    torque *= m.constants["reference_velocity"]
    dry_and_viscous = np.column_stack([np.ones_like(speed), speed])
    return torque - dry_and_viscous @ linear.least_norm(dry_and_viscous, torque)


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    top = max(abs(x) for x in m.box["velocity"])
    reference = m.constants["reference_velocity"]

    def part(speed: float) -> float:
        return m.value("nonlinear_viscous_coefficient") * reference * float(_curve(after, speed))

    bends = "flattens" if part(0.5 * top) > 0.5 * part(top) else "steepens"
    return (
        f"the curve of friction against speed {bends}: the part that is not proportional to speed "
        f"is {number(part(0.5 * top))} {m.load_unit} at {number(0.5 * top)} and "
        f"{number(part(top))} {m.load_unit} at {number(top)} {m.position_unit}/s"
    )


def _flexible_shape(fit: Identified) -> list[Array]:
    """Powers of the speed."""
    v = fit.recording.velocity[fit.rows]
    speed = np.abs(v) / (fit.recording.scales()["speed"] or 1.0)
    return [np.sign(v) * speed**power for power in (0.5, 1.5, 2.0, 3.0)]


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {
        "nonlinear_viscous_coefficient": 0.6 * joint.viscous,
        "nonlinear_viscous_exponent": 2.0,
        "nonlinear_viscous_saturation": 100.0 * joint.speed,
    }


def _generated_constants(made: GeneratedRecording) -> dict[str, float]:
    return {"reference_velocity": made.joint.speed}


EFFECT = Effect(
    id="nonlinear_viscous",
    view=ResidualView("speed", along="motion"),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    constants=_constants,
    generated_constants=_generated_constants,
    flexible_shape=_flexible_shape,
    free_form=OF_SPEED,
    out_of_reach=_out_of_reach,
)
