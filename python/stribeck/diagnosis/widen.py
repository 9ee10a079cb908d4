"""A model with an effect added, and the simpler effect that it contains."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.effect.constants import effect_constants
from stribeck.models.catalog import simpler_effect
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


def contained(effect: str, model: Model) -> str | None:
    """The simpler effect that `effect` contains and `model` lacks, if there is one."""
    simpler = simpler_effect(effect)
    return None if simpler is None or model.has(simpler) else simpler


def widening(
    model: Model, effect: str, recording: Recording, load: Array | None, residual: Array | None
) -> tuple[Model, ...]:
    """`model`, then with the simpler effect where it lacks one, then with `effect`.

    Parameters
    ----------
    effect : str
        An id, or ``"NAME = FORMULA"``.
    load : array [n]
        Load torque of every row.
    residual : array [n]
        What the model leaves of every row; a ripple's period is found in it.

    Raises
    ------
    SpecError
        The effect is unknown, or in the model already.
    """
    models = [model]
    for one in (contained(effect, model), effect):
        if one is not None:
            constants = effect_constants(one, recording, load, residual)
            models.append(models[-1].with_effect(one, constants))
    return tuple(models)
