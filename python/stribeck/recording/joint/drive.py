"""The torque of the environment, and motors driven by a voltage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Floats, bools, floats
from stribeck.recording.recording import Recording
from stribeck.recording.tables.prepared import Prepared

__all__ = ["with_drive"]


def with_drive(recording: Recording, prepared: Prepared, values: Mapping[str, Floats]) -> Recording:
    """The recording with the external torque and, if one was given, its drive.

    Parameters
    ----------
    values
        Channels of the file, arrays [n], in SI units.

    Raises
    ------
    RecordingError
        The effort of a voltage drive is not in V, or the load torque is not known.
    """
    recording = replace(recording, external_torque=_external_torque(recording, prepared, values))
    if prepared.settings.drive is None:
        return recording
    if recording.averaged:
        raise RecordingError(
            f"{recording.path}: {option('drive', prepared.settings.drive)} needs samples in time: "
            f"leave out {option('average')} or {option('drive')}"
        )
    unit = recording.torque_unit
    if unit != "V":
        raise RecordingError(
            f"{recording.path}: {option('drive', 'voltage')} needs an effort in V, the torque is "
            f"in {unit}: give {option('unit', 'torque=V')} if it is a voltage, or leave out "
            f"{option('drive')}"
        )
    if recording.load_torque is None:
        raise RecordingError(
            f"{recording.path}: {option('drive', 'voltage')} needs a known load torque to scale "
            "the motor constants: give inertia, gravity_cos and gravity_sin in the sidecar, or a "
            "column load_torque"
        )
    torque, enabled = recording.torque, None
    notes = [*recording.notes, "the effort is the voltage on a DC motor"]
    if "enabled" in values:
        enabled = bools(values["enabled"] != 0.0)
        source = prepared.choices["enabled"].source
        torque = floats(np.where(enabled, torque, 0.0))
        off = int(np.count_nonzero(~enabled))
        if off:
            notes.append(
                f"no current flows in the {off} samples where '{source}' is false: the motor "
                "torque is zero there, and the effort is set to zero"
            )
    return replace(
        recording,
        drive=prepared.settings.drive,
        torque=torque,
        enabled=enabled,
        notes=tuple(notes),
    )


def _external_torque(
    recording: Recording, prepared: Prepared, values: Mapping[str, Floats]
) -> Floats | None:
    """Torque that the environment exerts on the joint: the load torque without inertia, negated."""
    if "external_torque" in values:
        return floats(values["external_torque"])
    if recording.averaged and recording.load_torque is not None:
        return floats(-recording.load_torque)
    terms = prepared.settings.mechanics.terms
    if recording.load_torque is None or "load_torque" in values or not terms:
        return None
    external = np.full(recording.time.size, -terms.get("gravity", 0.0))
    if recording.position is not None:
        external -= terms.get("gravity_cos", 0.0) * np.cos(recording.position)
        external -= terms.get("gravity_sin", 0.0) * np.sin(recording.position)
    return floats(external)
