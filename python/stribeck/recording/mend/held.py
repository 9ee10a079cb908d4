"""Rows that repeat the row before: the logger had no new values.

A few are lost messages. Where many are, the logger writes rows faster than its channels change;
one row of each change is then all that was measured. Held values look like a joint that sticks and
jumps, as in presliding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.recording.arrays import Bools, Floats, Ints
from stribeck.recording.joint.channels import MEASURED, Channels
from stribeck.recording.naming.names import wide_groups
from stribeck.recording.rows import quantisation_step
from stribeck.recording.tables.cells import column_numbers

__all__ = ["Held"]

#: A joint at this many steps of its position per sample cannot stay where it is.
_STEPS = 3.0
#: With such a share of the rows in motion that repeat the row before, they are no exception.
_MANY = 0.05
#: A channel that keeps its value in such a share of the rows in which the others do holds it too.
_MOSTLY = 0.8
#: Channels that are updated one after the other are so in such a part of the rows that they hold.
_QUICK = 0.5


@dataclass(frozen=True)
class Held:
    """Repeated rows, bool array [n], and whether the logger writes faster than channels change."""

    rows: Bools
    always: bool = False

    @classmethod
    def of(cls, data: Channels) -> Held:
        """The rows that are equal to the row before although a joint was moving.

        With several joints in the columns of a file, a row repeats if it does for all of them, so
        that each joint has the same samples.
        """
        held = np.zeros(len(data.rows), dtype=bool)
        time, position = data.values.get("time"), data.values.get("position")
        if time is None or position is None or not np.any(np.diff(position) == 0.0):
            return cls(held)
        several = _of_all_joints(data)
        joints = several or [data.measured]
        if any("position" not in one or len(one) < 2 for one in joints):
            return cls(held)
        same = np.all([np.diff(v) == 0.0 for one in joints for v in one.values()], axis=0)
        if not same.any():
            return cls(held)
        if not several:
            same = _with_load(same, data)
        moved = np.any([_moved(one, same, np.diff(time)) for one in joints], axis=0)
        held[1:] = same & moved
        if held.sum() <= _MANY * moved.sum():
            return cls(held)
        # At rest the logger holds values no longer than in motion: what lasts longer is rest.
        length = _lengths(same)
        held[1:] = same & (length <= length[same & moved].max())
        held[1:-1] |= _not_complete(same, length, moved)
        return cls(held, always=True)


def _with_load(same: Bools, data: Channels) -> Bools:
    """Which rows repeat, [n - 1], with a load torque that holds its values as the others do."""
    load = data.values.get("load_torque")
    if load is None:
        return same
    holds = np.diff(load) == 0.0
    # One that changes while the others hold is read faster than they are.
    is_held = np.count_nonzero(holds & same) > _MOSTLY * np.count_nonzero(same)
    return same & holds if is_held else same


def _not_complete(same: Bools, length: Ints, moved: Bools) -> Bools:
    """Rows in which some channels are new and others follow in the next one, [n - 2].

    Channels that a logger updates one after the other change in few rows, and then hold for many.
    """
    usual = float(np.median(length[same & moved]))
    quick = ~same & (length <= _QUICK * usual)
    return np.asarray(quick[:-1] & quick[1:])


def _of_all_joints(data: Channels) -> list[dict[str, Floats]]:
    """The measured channels of all joints, as in the file; none where it has one joint."""
    prepared = data.prepared
    groups = {c: g for c, g in wide_groups(prepared.table.columns).items() if c in MEASURED}
    choice = prepared.choices.get("position")
    if choice is None or choice.source not in groups.get("position", {}).values():
        return []

    def values(joint: str) -> dict[str, Floats]:
        # A velocity in another unit than the position says nothing about its steps.
        named = {c: g[joint] for c, g in groups.items() if joint in g and c != "velocity"}
        return {
            c: column_numbers(prepared.source, prepared.table, prepared.row, name)[data.rows]
            for c, name in named.items()
            if prepared.table.schema[name].is_numeric()
        }

    # A joint without two channels of numbers says nothing.
    return [one for joint in groups["position"] if len(one := values(joint)) > 1]


def _moved(channels: dict[str, Floats], same: Bools, dt: Floats) -> Bools:
    """Whether the joint moved by several steps of its position since the row before, [n - 1]."""
    position, velocity = channels["position"], channels.get("velocity")
    if velocity is None:
        # The motion over the stretch that holds, seen from the samples around it.
        usual = np.where(same, np.nan, np.abs(np.diff(position)))
        moved = np.fmin(_before(usual), _before(usual[::-1])[::-1])
    else:
        moved = np.abs(velocity[1:]) * dt
    least = max(_STEPS * quantisation_step(position), 1e-9 * float(np.ptp(position)))
    return np.asarray(moved > least)


def _before(values: Floats) -> Floats:
    """Each value, or the last one before it that is not missing."""
    at = np.maximum.accumulate(np.where(np.isnan(values), -1, np.arange(len(values))))
    return np.where(at >= 0, values[np.maximum(at, 0)], 0.0)


def _lengths(same: Bools) -> Ints:
    """How many rows hold in a row around each that does, [n - 1]."""
    stretch = np.cumsum(np.diff(same, prepend=False))
    return np.bincount(stretch)[stretch]
