"""The torque that was measured, and the load torque where it is known."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Floats
from stribeck.recording.joint.channels import Channels
from stribeck.recording.recording import Column

__all__ = ["Loads", "measured_torque", "rigid_body_load"]


@dataclass(frozen=True)
class Loads:
    """Torques of one joint, arrays [n]; a load of None is not known.

    Attributes
    ----------
    load_smooth
        The load without noise.
    """

    torque: Floats
    load: Floats | None
    load_smooth: Floats | None


def measured_torque(data: Channels) -> tuple[Floats, Floats | None]:
    """The measured torque and the recorded load; zeros where friction alone was measured."""
    if "friction_torque" not in data.values:
        return data.values["torque"], data.values.get("load_torque")
    friction = data.values["friction_torque"]
    load = data.values.get("load_torque")
    data.notes.append(_of_friction(data, load))
    data.columns["torque"] = replace(data.columns["friction_torque"], name="torque")
    return friction, np.zeros_like(friction) if load is None else load


def _of_friction(data: Channels, load: Floats | None) -> str:
    """What a reader has to know of friction that is read in place of the torque."""
    choices = data.prepared.choices
    source, torque = choices["friction_torque"].source, choices.get("torque")
    loaded = "and the load torque is zero" if load is None else "and the load is no part of it"
    if torque is None:
        return f"friction was measured directly ('{source}'): it is the torque, {loaded}"
    return (
        f"the friction '{source}' is read in place of the torque '{torque.source}', {loaded}: to "
        f"fit the torque give {option('map', f'torque={torque.source}')}"
    )


def rigid_body_load(
    data: Channels, position: Floats | None, acceleration: Floats, unit: str, *, smooth: bool
) -> Floats | None:
    """The load torque of the rigid-body terms, [n]; None where none were given.

    Parameters
    ----------
    smooth
        Whether motion without noise is given; then no note is made.

    Raises
    ------
    RecordingError
        Gravity depends on a position that is not there.
    """
    terms = data.prepared.settings.mechanics.terms
    if not terms:
        return None
    if position is None and ("gravity_cos" in terms or "gravity_sin" in terms):
        raise RecordingError(
            f"{data.path}: gravity_cos and gravity_sin need a position column: name it with "
            f"{option('map', 'position=COLUMN')}"
        )
    load = terms.get("inertia", 0.0) * acceleration + terms.get("gravity", 0.0)
    if position is not None:
        load = load + terms.get("gravity_cos", 0.0) * np.cos(position)
        load = load + terms.get("gravity_sin", 0.0) * np.sin(position)
    if not smooth:
        text = ", ".join(f"{key} {value:g}" for key, value in terms.items())
        data.notes.append(f"load torque computed from rigid-body terms: {text}")
        data.columns["load_torque"] = Column.of("load_torque", "rigid-body terms", unit, True, load)
    return load
