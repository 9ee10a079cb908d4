"""The operating box of a fit: the ranges over which the model has been compared with data."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from stribeck.models.model import Model
from stribeck.models.rigid_body import own_gravity
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


def box_of_all(model: Model, recordings: Iterable[Recording]) -> dict[str, tuple[float, float]]:
    """Range of each channel over the scored samples of all recordings that have it."""
    boxes = [operating_box(model, recording, None) for recording in recordings]
    names = dict.fromkeys(name for box in boxes for name in box)
    sides = {name: [box[name] for box in boxes if name in box] for name in names}
    return {
        name: (min(low for low, _ in some), max(high for _, high in some))
        for name, some in sides.items()
    }


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
