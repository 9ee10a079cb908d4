"""Whether the recorded load torque is part of the torque."""

from __future__ import annotations

import numpy as np

from stribeck.base.errors import option
from stribeck.base.units import find_unit, known_units
from stribeck.recording.check import Check
from stribeck.recording.consistency.readings import named_ratio
from stribeck.recording.consistency.view import View

__all__ = ["check_load"]

#: Correlation with the acceleration from which a load torque is hardly more than an inertia's.
_INERTIA = 0.9
#: The load's coefficient may be off by this factor: gravity models and gains of torque sensors
#: are worse than units are close to each other (1.36, foot-pounds against newton metres).
_SCALE = 1.3


def check_load(view: View) -> Check | None:
    """Regress the torque on the load torque: the coefficient must be one.

    Returns
    -------
    Check or None
        None where no load torque was recorded as part of the torque.
    """
    recording = view.recording
    recorded = view.recorded("load_torque") is not None and recording.torque_holds_load
    if not recorded:
        return None
    if view.dissipation is None:
        return Check("load_torque", True, "cannot check the load torque: too few samples move")
    load = view.dissipation.load
    if load is None:
        return Check("load_torque", True, "cannot check the load torque: it hardly varies")
    low, high = load.interval
    column = view.column("load_torque")
    if load.sign == 0 and high > 1.0 / _SCALE:
        return Check("load_torque", True, "cannot check the load torque: noise hides it")
    if high < 0.0 and low < -1.0 / _SCALE and high > -_SCALE:
        said = f"the torque holds the load torque ('{column}') with the opposite sign"
        friction = view.dissipation.friction
        wrong = "torque" if friction is not None and friction.sign < 0 else "load_torque"
        return Check("load_torque", False, said, f"give {view.derived(wrong, '-{}')}")
    if high < 1.0 / _SCALE or low > _SCALE:
        known = named_ratio(load.value)
        what = f" ({known})" if known else ""
        if not known and _follows_acceleration(view):
            what = ", or that lacks an inertia"
        return Check(
            "load_torque",
            False,
            f"the torque holds {load.value:.4g} times the load torque ('{column}'){what}",
            f"{_units(view, load.value)}; or leave the load out with "
            f"{option('map', 'load_torque=none')}",
        )
    return Check(
        "load_torque", True, f"the torque holds {low:.3g} to {high:.3g} times the load torque"
    )


def _follows_acceleration(view: View) -> bool:
    """Whether the load torque is so much that of an inertia that a missing one scales it."""
    r = view.recording
    if r.load_torque is None:
        return False
    load, a = r.load_torque[r.moving], r.acceleration_smooth[r.moving]
    varies = np.ptp(load) > 0.0 and np.ptp(a) > 0.0
    return bool(varies and np.atleast_2d(np.corrcoef(load, a))[0, 1] > _INERTIA)


def _units(view: View, ratio: float) -> str:
    """The unit of the torque, or of the load, that makes their ratio one."""
    dimension = "force" if view.recording.joint_kind == "prismatic" else "torque"
    units = [find_unit(name, (dimension,)) for name in known_units((dimension,))]
    for channel, wanted in (("torque", 1.0 / abs(ratio)), ("load_torque", abs(ratio))):
        factor = wanted * view.source(channel).factor
        for unit in units:
            if unit is not None and factor < 1.0 and abs(factor / unit.factor - 1.0) < 0.05:
                given = option("unit", f"{view.column(channel)}={unit.name}")
                gear = option("gear_ratio", float(f"{1.0 / abs(ratio):.3g}"))
                before = f"; if the torque was measured before a gear, give {gear} and "
                before += option("torque_at", "motor")
                return f"the likeliest unit is given by {given}{before if abs(ratio) < 1.0 else ''}"
    return f"give the units of both with {option('unit', 'COLUMN=UNIT')}"
