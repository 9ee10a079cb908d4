"""Loads at the joint that no column gives, and motors that a voltage drives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError
from stribeck.recording.recording import Recording
from stribeck.recording.table import Prepared

__all__ = ["natural_unit", "with_drive"]

Floats = NDArray[np.float64]


def natural_unit(joint_kind: str) -> str:
    """Unit of all loads at a joint."""
    return "N" if joint_kind == "prismatic" else "N m"


def with_drive(recording: Recording, prepared: Prepared, values: Mapping[str, Floats]) -> Recording:
    """The recording with the torque of the environment and, where it has one, its drive.

    Parameters
    ----------
    values
        Channels of the file, arrays [n], in SI units.

    Raises
    ------
    RecordingError
        A voltage drive on an effort that is no voltage, or without a known load torque.
    """
    recording = replace(recording, external_torque=_external_torque(recording, prepared, values))
    if prepared.options.drive is None:
        return recording
    if recording.averaged:
        raise RecordingError(
            f"{recording.path}: --drive needs samples: leave --average out, or --drive"
        )
    unit = recording.torque_unit
    if unit != "V":
        raise RecordingError(
            f"{recording.path}: --drive voltage needs an effort in V, the torque is in {unit}: say "
            "--unit torque=V if it is a voltage, or leave --drive out"
        )
    if recording.load_torque is None:
        raise RecordingError(
            f"{recording.path}: --drive voltage needs a known load torque to scale the motor "
            "constants by: give inertia and gravity_cos, gravity_sin in the sidecar, or a column "
            "load_torque"
        )
    torque, enabled = recording.torque, None
    notes = [*recording.notes, "the effort is the voltage on a DC motor"]
    if "enabled" in values:
        enabled = _read_only(values["enabled"] != 0.0)
        source = prepared.choices["enabled"].source
        torque = _read_only(np.where(enabled, torque, 0.0))
        off = int(np.count_nonzero(~enabled))
        if off:
            notes.append(
                f"no current flows in the {off} rows where '{source}' is false: the motor torque "
                "is zero, and so is what it is measured against"
            )
    return replace(
        recording, drive=prepared.options.drive, torque=torque, enabled=enabled,
        notes=tuple(notes),
    )  # fmt: skip


def _external_torque(
    recording: Recording, prepared: Prepared, values: Mapping[str, Floats]
) -> Floats | None:
    """Torque that the environment exerts on the joint: minus the load torque without inertia."""
    if "external_torque" in values:
        return _read_only(values["external_torque"])
    if recording.averaged and recording.load_torque is not None:
        return _read_only(-recording.load_torque)
    terms = prepared.options.terms
    if recording.load_torque is None or "load_torque" in values or not terms:
        return None
    external = np.full(recording.time.size, -terms.get("gravity", 0.0))
    if recording.position is not None:
        external -= terms.get("gravity_cos", 0.0) * np.cos(recording.position)
        external -= terms.get("gravity_sin", 0.0) * np.sin(recording.position)
    return _read_only(external)


def _read_only(values: Any) -> Any:
    array = np.ascontiguousarray(values)
    array.flags.writeable = False
    return array
