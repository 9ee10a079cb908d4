"""Inertia of a rotor, which a load torque holds but the teeth of a gear do not carry.

Friction that grows with the load grows with the torque at the teeth: gravity and the inertia behind
them. A load torque for which the rotor counts too shows another load while the joint accelerates.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause, load_of
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms
from stribeck.models.parts import friction_parts

#: The torque of the rotor, as a share of the load torque, for the derivative of friction.
SHARE = 0.1


def _columns(fit: Fit) -> list[Array]:
    r = fit.recording
    a = r.acceleration
    if a is None or "load" not in fit.model.effects or not (size := rms(a[r.moving])) > 0.0:
        return []
    load = load_of(fit)
    of_rotor = SHARE * rms(load[r.moving]) / size * a
    dry, without = (friction_parts(fit.model, r, known)["dry"] for known in (load, load - of_rotor))
    return [np.sign(r.velocity) * (dry - without)]


ROTOR = MeasurementCause("a rotor whose inertia does not load the gear", _columns)
