"""The parts of a model's friction on a recording."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


def friction_parts(
    model: Model,
    recording: Recording,
    load: Array | None,
    rows: NDArray[np.intp] | NDArray[np.bool_] | slice = slice(None),
) -> dict[str, Array]:
    """Parts of the steady friction of some samples, as `Model.split` names them, arrays [m].

    Parameters
    ----------
    load : array [n]
        Load torque of every sample; without one it is at the middle of the operating box.
    rows
        The samples; default: all.
    """
    columns = {
        "position": recording.position,
        "acceleration": recording.acceleration,
        "temperature": recording.temperature,
        "load_torque": load,
        "external_torque": recording.external_torque,
        "time": recording.elapsed,
    }
    given = {name: column[rows] for name, column in columns.items() if column is not None}
    return model.split(recording.velocity[rows], **given)
