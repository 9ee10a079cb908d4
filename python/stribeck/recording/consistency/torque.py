"""Whether the torque goes with the motion: friction takes energy, inertia and load are positive."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.stats import pearsonr

from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Floats
from stribeck.recording.check import Check
from stribeck.recording.consistency.dissipation import Dissipation, Estimate, dissipation
from stribeck.recording.consistency.view import View
from stribeck.recording.naming.names import parse_name, same_of_joint
from stribeck.recording.tables.cells import column_numbers

__all__ = ["check_torque"]

#: The motion explains the torque if the regression leaves at most this share of its variance.
_UNEXPLAINED = 0.5
#: Friction below this share of the torque (RMS) does not tell its sign: a small error of gravity or
#: of the time between the channels is as large.
_NEGLIGIBLE = 0.02
#: Another column is the joint's if it leaves at most this share of what the given one leaves.
_BETTER = 0.2
#: Joints whose motions are correlated by this move together: the torque of each goes with both.
_TOGETHER = 0.9


def check_torque(view: View) -> Check | None:
    """Compare the torque at (q, +v) with the torque at (q, -v), at like load and acceleration.

    The difference is twice the friction, which must be positive. An opposite sign is an error only
    if the inertia, or the recorded load, is seen with its sign; otherwise the joint may be pushed,
    or a part of the log may only regenerate, and nothing is concluded.

    Returns
    -------
    Check or None
        None where hardly anything moves.
    """
    found = view.dissipation
    if found is None:
        return None
    other = _other_joint(view, found)
    if other is not None:
        return Check(
            "torque",
            False,
            f"the torque ('{view.column('torque')}') goes with the motion by "
            f"{100.0 * max(found.explained, 0.0):.0f} % of its variance, '{other}' far more",
            f"give {_mapped(view, other)}, or the motion of the torque's joint",
        )
    friction = found.friction
    torque = view.recording.torque
    if np.ptp(torque) == 0.0:
        return Check(
            "torque",
            False,
            f"the torque ('{view.column('torque')}') is {torque[0]:.3g} "
            f"{view.recording.torque_unit} in every sample, whatever the motion, which is no "
            f"measurement",
            "log the torque or the current of the motor",
        )
    if friction is None:
        return Check(
            "torque",
            True,
            "cannot check the torque against the motion: both directions at like load are needed",
        )
    unit = view.recording.torque_unit
    said = f"friction at the RMS speed is {_interval(friction)} {unit}"
    if friction.sign > 0:
        return Check("torque", True, f"{said}: the torque is along the velocity, as it must be")
    if friction.sign == 0:
        return Check("torque", True, f"cannot check the torque against the motion: {said}")
    return _negative(view, found, said)


def _negative(view: View, found: Dissipation, said: str) -> Check:
    """The torque gives energy to the friction: which channel is reversed, if that can be told."""
    if _is_negligible(view, found):
        return Check(
            "torque",
            True,
            f"cannot check the torque against the motion: {said}, less than "
            f"{100.0 * _NEGLIGIBLE:g} % of the torque",
        )
    explains = 1.0 - found.explained < _UNEXPLAINED
    witness = found.load or found.inertia
    if witness is None or witness.sign == 0 or not explains:
        return Check(
            "torque",
            True,
            f"cannot check the torque against the motion: {said}; the joint may have been pushed",
        )
    if witness.sign < 0:
        what = "load torque" if found.load is not None else "inertia"
        return Check(
            "torque",
            False,
            f"{said} and the {what} is negative too: the torque is reversed",
            f"give {view.derived(_effort(view), '-{}')}",
        )
    if found.load is None:
        return Check(
            "torque",
            True,
            f"cannot check the torque against the motion: {said}, but the inertia is positive",
        )
    motion = [c for c in ("position", "velocity") if c in view.prepared.choices]
    turned = " and ".join(view.derived(c, "-{}") for c in motion)
    return Check(
        "torque",
        False,
        f"{said}, but the load torque has the sign of the torque: the motion is reversed",
        f"give {turned}",
    )


def _is_negligible(view: View, found: Dissipation) -> bool:
    """Whether friction is hardly any of the torque."""
    torque = view.recording.torque[view.recording.moving]
    friction = found.friction
    return friction is not None and -friction.interval[0] < _NEGLIGIBLE * float(
        np.sqrt(np.mean(torque**2))
    )


def _effort(view: View) -> str:
    choices = view.prepared.choices
    direct = "friction_torque" in view.recording.columns
    return "friction_torque" if direct and "friction_torque" in choices else "torque"


def _interval(estimate: Estimate) -> str:
    ends = [f"{end:.3g}" for end in estimate.interval]
    return " to ".join(dict.fromkeys(ends))


def _other_joint(view: View, found: Dissipation) -> str | None:
    """The column of another joint whose torque this motion explains, if there is one."""
    best, least = None, _BETTER * (1.0 - found.explained)
    for name, values in _columns(view):
        other = dissipation(view.recording, torque=values)
        if other is None or other.friction is None or other.friction.sign <= 0:
            continue
        if 1.0 - other.explained < least:
            best, least = name, 1.0 - other.explained
    return best


def _mapped(view: View, other: str) -> str:
    """The option that reads the torque from the column of another joint."""
    for column in view.columns_of("torque"):
        if other in same_of_joint([other], column).values():
            return view.replaced("torque", column, other)
    return option("map", f"torque={other}")


def _columns(view: View) -> Iterator[tuple[str, Floats]]:
    """The columns of other joints that are named like the torque's, and their values."""
    prepared = view.prepared
    used = view.columns_of("torque")
    kinds = {parse_name(column).channel for column in used} - {None}
    of_others = {
        name: joint for column in used for joint, name in view.of_other_joints(column).items()
    }
    alike = [name for name, joint in of_others.items() if not _moves_along(view, joint)]
    apart = [*used, *of_others]
    named = [n for n in prepared.table.columns if parse_name(n).channel in kinds and n not in apart]
    names = dict.fromkeys([*alike, *named])
    for name in names:
        values = _numbers(view, name)
        if values is not None and np.isfinite(values).all() and np.ptp(values) > 0.0:
            yield name, values


def _moves_along(view: View, joint: str) -> bool:
    """Whether another joint of the file moves as this one does."""
    for channel in ("velocity", "position"):
        for column in view.columns_of(channel):
            other = view.of_other_joints(column).get(joint)
            mine = _numbers(view, column)
            theirs = None if other is None else _numbers(view, other)
            if mine is not None and theirs is not None:
                own = np.column_stack([mine, theirs])
                own = own[np.isfinite(own).all(axis=1)]
                still = own.shape[0] < 2 or bool(np.any(np.ptp(own, axis=0) == 0.0))
                return not still and abs(pearsonr(own[:, 0], own[:, 1]).statistic) >= _TOGETHER
    return False


def _numbers(view: View, column: str) -> Floats | None:
    """The values of a column; None where it holds something else."""
    prepared = view.prepared
    try:
        cells = column_numbers(prepared.source, prepared.table, prepared.row, column)
    except RecordingError:
        return None
    return cells[view.rows]
