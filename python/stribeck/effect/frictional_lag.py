"""Frictional lag: the Stribeck curve follows a change of speed after a delay."""

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
from stribeck.effect.columns import delayed
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.free_form import OF_SPEED
from stribeck.effect.stribeck import SLOW, no_slow_motion
from stribeck.models.model import Model
from stribeck.recording.motion.derived_motion import cutoff_of
from stribeck.recording.motion.moves import move_seconds, moves
from stribeck.recording.recording import Recording

#: In so many moves the joint must speed up at slow speeds, and in as many slow down, so much that
#: it would pass these within this time (s): then a lag of some hundredths of a second shows.
FEWEST, SLOW_PASS = 5, 2.0
#: Part of the slow samples of a move in which it must: it speeds up in half of them at most.
PART = 0.25
#: A lag beyond this share of a typical move is none: friction would belong to another move.
LONGEST = 0.1
#: A lag below this part of a sample is none: the channels of a row are not sampled at one instant.
LEAST_PART = 0.25
#: A low-pass averages a derived channel over this part of a period of its cut-off to each side.
QUARTER = 0.25


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    if facts.recording.averaged:
        return Obstacle(
            "steady-state points contain no change of speed",
            "record slow passes that speed up and slow down",
        )
    if (why := no_slow_motion(facts)) is not None:
        return why
    up, down = _quick_moves(facts)
    if min(up, down) >= FEWEST:
        return None
    return Obstacle(
        f"in {'none' if min(up, down) == 0 else f'only {min(up, down)}'} of the moves the joint "
        f"{'speeds up' if up < down else 'slows down'} enough to pass its slow speeds in "
        f"{SLOW_PASS:.0f} s, so that no lag of friction shows",
        "add slow passes that speed up and slow down quickly",
    )


def _quick_moves(facts: RecordingFacts) -> tuple[int, int]:
    """Number of moves that speed up, and that slow down, quickly at slow speeds."""
    r = facts.recording
    slow = facts.speed < SLOW * facts.top_speed
    faster = (np.sign(facts.velocity) * r.acceleration_smooth[r.moving])[slow]
    move = moves(r)[r.moving][slow]
    order = np.lexsort((faster, move))
    _, start, count = np.unique(move[order], return_index=True, return_counts=True)
    part = (PART * (count - 1)).astype(np.intp)
    least, most = faster[order][start + part], faster[order][start + count - 1 - part]
    quick = SLOW * facts.top_speed / SLOW_PASS
    return int(np.count_nonzero(most >= quick)), int(np.count_nonzero(least <= -quick))


def _without_curve(model: Model, _: Recording | Array) -> str | None:
    # A lag of the Stribeck curve needs the curve, of the law or of the other effect.
    if model.has("stribeck"):
        return None
    return (
        f"frictional_lag delays a Stribeck curve, and {model.spec} has none: add stribeck, or "
        "leave the effect out"
    )


def _where(before: Identified, after: Identified) -> str:
    lag = after.model.value("frictional_lag")
    said = (
        f"the decrease of friction with speed is delayed by {number(1e3 * lag)} ms: at the same "
        "low speed friction is higher while the joint speeds up than while it slows down"
    )
    if _samples_late(after) >= 1.0:
        return said
    period = 1e3 * after.recording.scales()["sample_period"]
    return f"{said}; that is less than the {number(period)} ms between samples: record faster"


def _flexible_shape(fit: Identified) -> list[Array]:
    """Stribeck curves of the speed at several times before."""
    if not fit.model.has("stribeck"):
        return []
    r = fit.recording
    sign = np.sign(r.velocity[fit.rows])
    lag = fit.model.value("frictional_lag")
    speed = np.abs(r.denoised("velocity"))
    slow = _stribeck_velocity(fit)
    return [
        sign * np.exp(-delayed(r, speed, lag * k)[fit.rows] / (slow * width))
        for k in (0.3, 1.0, 2.0)
        for width in (0.5, 1.5)
    ]


def _stribeck_velocity(fit: Identified) -> float:
    """The Stribeck velocity, of the law or of the effect."""
    name = next((n for n in fit.model.names if n.endswith("stribeck_velocity")), None)
    return 0.1 * fit.recording.scales()["speed"] if name is None else abs(fit.model.value(name))


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"frictional_lag": 0.1 * joint.stroke / joint.speed}


def _out_of_reach(after: Identified) -> str | None:
    lag, longest = after.model.value("frictional_lag"), LONGEST * move_seconds(after.recording)
    if lag <= longest:
        return None
    return (
        f"friction would lag by {number(lag)} s, more than a tenth of a typical move, which lasts "
        f"{number(longest / LONGEST)} s"
    )


def _samples_late(after: Identified) -> float:
    # A delay before zero brings the curve forward: what is left of the lag counts.
    model = after.model
    forward = min(model.value("delay"), 0.0) if model.has("delay") else 0.0
    lag = model.value("frictional_lag") + forward
    return lag / after.recording.scales()["sample_period"]


def _unresolved(after: Identified) -> str | None:
    lag, r = after.model.value("frictional_lag"), after.recording
    if lag < LEAST_PART * r.scales()["sample_period"]:
        return f"friction would lag by {number(1e3 * lag)} ms, less than a quarter of a sample"
    if r.columns["velocity"].derived and r.cutoff_hz is not None and lag < QUARTER / r.cutoff_hz:
        return (
            f"friction would lag by {number(1e3 * lag)} ms, less than the time over which the "
            f"low-pass of the velocity at {number(r.cutoff_hz)} Hz averages to each side"
        )
    highest = _cutoff_of_inertia(after)
    if highest is not None and lag < QUARTER / highest:
        return (
            f"friction would lag by {number(1e3 * lag)} ms, less than the time over which the "
            f"low-pass of the acceleration at {number(highest)} Hz averages to each side: the "
            "error of the inertia's torque looks like such a lag"
        )
    return None


def _cutoff_of_inertia(after: Identified) -> float | None:
    """The cut-off of a derived acceleration from which a torque is known, Hz; None: no filter."""
    r, model = after.recording, after.model
    load = r.columns.get("load_torque")
    read = load is not None and load.derived
    has_inertia = "inertia" in (*model.rigid_body, *model.effects)
    if not r.columns["acceleration"].derived or not (read or has_inertia):
        return None
    return cutoff_of(r)


EFFECT = Effect(
    id="frictional_lag",
    view=ResidualView("acceleration_along", along="motion", regime="low_speed"),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    refusal=_without_curve,
    flexible_shape=_flexible_shape,
    free_form=OF_SPEED,
    size_range=(10.0, 1e-2),
    unresolved=_unresolved,
    samples_late=_samples_late,
    out_of_reach=_out_of_reach,
    cannot_hide=_without_curve,
)
