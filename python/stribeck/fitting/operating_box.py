"""The operating box of a fit: the ranges over which the model has been compared with data."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.rigid_body import own_gravity
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


def operating_box(
    model: Model, recording: Recording, load: Array | None
) -> dict[str, tuple[float, float]]:
    """Range of each channel over the scored samples."""
    moving = recording.moving
    given = recording.load_torque is not None
    channels = {
        "velocity": recording.velocity,
        "position": recording.position,
        "acceleration": recording.acceleration,
        "temperature": recording.temperature,
        "load_torque": recording.load_torque if given else load,
    }
    if "motor_torque" in model.core.needs and recording.drive is None:
        beside = recording.load_torque if given and not recording.torque_holds_load else None
        channels["motor_torque"] = recording.torque if beside is None else recording.torque + beside
    if "external_torque" in model.core.needs:
        gravity = own_gravity(model, recording)
        channels["external_torque"] = recording.external_torque if gravity is None else -gravity
    return {
        name: (float(column[moving].min()), float(column[moving].max()))
        for name, column in channels.items()
        if column is not None and moving.any()
    }
