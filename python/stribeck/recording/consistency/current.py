"""Whether a current beside the torque goes with it."""

from __future__ import annotations

import numpy as np

from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Floats
from stribeck.recording.check import Check
from stribeck.recording.consistency.view import View
from stribeck.recording.naming.names import any_index, parse_name
from stribeck.recording.tables.cells import column_numbers

__all__ = ["check_current"]

#: The torque is proportional to the current from this share of common variance on.
_COMMON = 0.8
#: A torque constant that was given may be off by this factor.
_SCALE = 1.5


def check_current(view: View) -> Check | None:
    """Compare the torque with a current of the same joint that is not read.

    Returns
    -------
    Check or None
        None where the file has no such current.
    """
    found = _current(view)
    if found is None:
        return None
    column, current = found
    torque = view.recording.torque
    i, tau = current - current.mean(), torque - torque.mean()
    power = float((i * i).sum() * (tau * tau).sum())
    if power == 0.0:
        return Check("current", True, "cannot check the current: it does not vary")
    product = float((i * tau).sum())
    common, gain = product**2 / power, product / float((i * i).sum())
    if common < _COMMON:
        share = f"{100.0 * common:.0f} % of variance in common"
        said = f"cannot check the torque against the current ('{column}'): they have {share}"
        return Check("current", True, said)
    unit = view.recording.torque_unit
    said = f"torque = {gain:.4g} {unit}/A times the current ('{column}')"
    mechanics = view.prepared.settings.mechanics
    if mechanics.torque_constant is not None:
        given = mechanics.torque_constant * mechanics.gear_ratio
        if not 1.0 / _SCALE < gain / given < _SCALE:
            said += f", and {given:.4g} {unit}/A was given"
            do = f"correct {option('torque_constant')} or the unit of the torque"
            return Check("current", False, said, do)
    return Check("current", True, said)


def _current(view: View) -> tuple[str, Floats] | None:
    """A current of the joint that is not read, and its values in A."""
    prepared = view.prepared
    if "torque" not in prepared.choices or prepared.choices["torque"].channel == "current":
        return None
    torque = view.columns_of("torque")
    index = any_index(torque[0]) if torque else None
    for name in prepared.table.columns:
        parsed = parse_name(name)
        if parsed.channel != "current" or name in torque or parsed.index not in (None, index):
            continue
        try:
            values = column_numbers(prepared.source, prepared.table, prepared.row, name)[view.rows]
        except RecordingError:
            continue
        if np.isfinite(values).all():
            return name, values * (1.0 if parsed.unit is None else parsed.unit.factor)
    return None
