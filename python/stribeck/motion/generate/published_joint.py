"""The generated joint that suits a published parameter set."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stribeck.base.errors import SpecError
from stribeck.models.model import Model
from stribeck.motion.generate.motion import JOINTS, GeneratedJoint

#: Share of the largest speed at which the size of the friction is taken.
_WORKING = 0.3


def joint_of(printed: Model) -> GeneratedJoint:
    """The usual joint of this kind, at the speeds and with the loads of a published set.

    The largest speed is that of the set's operating box, if it has one, and the stroke grows with
    it. Noise is a share of the set's own friction; loads shrink with friction that is smaller than
    usual, and do not grow with friction that is larger.

    Raises
    ------
    SpecError
        The paper does not print all values.
    """
    if printed.rigid_body:
        raise SpecError(f"{printed.spec} has an identified rigid body: give another published set")
    kind = "revolute" if printed.position_unit == "rad" else "prismatic"
    usual = JOINTS[kind]
    top = printed.box["velocity"][1] if "velocity" in printed.box else usual.speed
    faster = top / usual.speed
    friction = _size(printed, _WORKING * top)
    load = min(1.0, friction / usual.coulomb)
    return replace(
        usual,
        speed=top,
        stroke=usual.stroke * faster,
        coulomb=friction,
        viscous=friction / top,
        inertia=usual.inertia * load / faster,
        gravity=usual.gravity * load,
    )


def _size(printed: Model, speed: float) -> float:
    """Steady friction at a speed, without load, at 30 degC."""
    middle = np.mean(printed.box.get("temperature", (30.0, 30.0)))
    given = {name: 0.0 for name in printed.core.needs if name not in ("velocity", "time")}
    channels = {**given, "motor_torque": 1.0, "temperature": float(middle)}
    parts = printed.split(speed, **{k: x for k, x in channels.items() if k in given})
    return abs(float(sum(part[0] for part in parts.values())))
