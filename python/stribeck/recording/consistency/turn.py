"""Whether the torque varies with the position as a weight does in another unit of it."""

from __future__ import annotations

import math

import numpy as np

from stribeck.base import linear
from stribeck.base.errors import option
from stribeck.recording.arrays import Floats
from stribeck.recording.check import Check
from stribeck.recording.consistency.view import View
from stribeck.recording.recording import Recording

__all__ = ["check_turn"]

#: The units of an angle that a log may have without saying so, in rad.
UNITS = {"deg": math.pi / 180.0, "rev": 2.0 * math.pi}
#: Motion over less than this part of a turn says nothing of its unit.
LEAST_TURN = 0.1
#: A unit is told where a weight in it leaves less than this share of what one in rad leaves.
MOST_LEFT = 0.25
#: Most samples looked at.
ROWS = 20_000


def check_turn(view: View) -> Check | None:
    """Compare weights that hang on an angle in rad, degrees and turns.

    Returns
    -------
    Check or None
        None where the unit of the position is stated, or a weight in rad explains the torque best.
    """
    r = view.recording
    choice = view.prepared.choices.get("position")
    if choice is None or choice.unit is not None or r.position is None or r.averaged:
        return None
    if r.joint_kind != "revolute" or r.load_torque is not None:
        return None
    span = float(np.ptp(r.position))
    left = _sums_left(r, r.position)
    best = min(left, key=lambda unit: left[unit])
    if best == "rad" or span * UNITS[best] < LEAST_TURN * 2.0 * math.pi:
        return None
    if left[best] >= MOST_LEFT * left["rad"]:
        return None
    column = view.column("position")
    given = option("unit", f"{column}={best}")
    if (moves := view.prepared.choices.get("velocity")) is not None and moves.unit is None:
        given += " and " + option("unit", f"{moves.source}={best}/s")
    return Check(
        "turn",
        True,
        f"cannot check the unit of the position ('{column}'): a weight in {best} explains more of "
        f"the torque than one in rad; if it is in {best}, give {given}",
    )


def _sums_left(r: Recording, position: Floats) -> dict[str, float]:
    """Sums of squares that friction, an inertia and a weight leave, by the unit of the angle."""
    rows = np.flatnonzero(r.moving)
    rows = rows[:: max(1, rows.size // ROWS)]
    v, q = r.velocity[rows], position[rows]
    base = [np.sign(v), v, r.acceleration_smooth[rows], np.ones(rows.size)]
    target = r.torque[rows]
    made = {}
    for unit, factor in {"rad": 1.0, **UNITS}.items():
        columns = np.column_stack([*base, np.cos(factor * q), np.sin(factor * q)])
        size = np.linalg.norm(columns, axis=0)
        columns = columns / np.where(size > 0.0, size, 1.0)
        residual = target - columns @ linear.least_norm(columns, target)
        made[unit] = float(residual @ residual)
    return made
