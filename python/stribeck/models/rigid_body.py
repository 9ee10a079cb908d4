"""The load torque of a rigid body that is identified together with the friction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


def own_load(model: Model, recording: Recording) -> Array | None:
    """Load torque of the identified rigid body of `model`, [n]; None if it has none."""
    if not model.rigid_body:
        return None
    load = np.zeros_like(recording.torque)
    if "inertia" in model.rigid_body and recording.acceleration is not None:
        load += model.value("inertia") * recording.acceleration
    gravity = own_gravity(model, recording)
    return load if gravity is None else load + gravity


def load_torque(model: Model, recording: Recording) -> Array | None:
    """Load torque as recorded, else that of the identified rigid body, [n]; None without both."""
    return own_load(model, recording) if recording.load_torque is None else recording.load_torque


def own_gravity(model: Model, recording: Recording) -> Array | None:
    """Gravity torque identified by `model`, [n]; None if it has none."""
    if "gravity" not in model.rigid_body or recording.position is None:
        return None
    cosine = model.value("gravity_cos") * np.cos(recording.position)
    return cosine + model.value("gravity_sin") * np.sin(recording.position)


def needs_own_load(model: Model) -> bool:
    return bool(model.rigid_body) and "load_torque" in model.core.needs
