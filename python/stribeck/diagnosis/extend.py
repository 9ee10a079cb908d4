"""A model extended by an effect, and by the simpler effect that it contains."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.effect.constants import effect_constants
from stribeck.effect.registry import of_catalog
from stribeck.models.catalog import simpler_effect
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


def holds(model: Model, effect: str) -> bool:
    """Whether a model has an effect, or another one that contains it."""
    whole = of_catalog(effect).part_of
    return model.has(effect) or (whole is not None and model.has(whole))


def missing_simpler_effect(effect: str, model: Model) -> str | None:
    """The simpler effect that `effect` contains and `model` lacks, if there is one."""
    simpler = simpler_effect(effect)
    return None if simpler is None or holds(model, simpler) else simpler


def needs_simpler_effect(effect: str) -> bool:
    """Whether an effect has no meaning without the simpler one that it contains."""
    return simpler_effect(effect) is not None and not of_catalog(effect).acts_alone


def extended_models(
    model: Model, effect: str, recording: Recording, load: Array | None, residual: Array | None
) -> tuple[Model, ...]:
    """`model`, then with the simpler effect where it lacks one, then with `effect`.

    Parameters
    ----------
    effect : str
        An id, or ``"NAME = FORMULA"``.
    load : array [n]
        Load torque of every sample, where the recording gives none.
    residual : array [n]
        Residual of the model at every sample; some effects take a constant from it.

    Raises
    ------
    SpecError
        The effect is unknown, or in the model already.
    """
    models = [model]
    for one in (missing_simpler_effect(effect, model), effect):
        if one is not None:
            constants = effect_constants(one, recording, load, residual)
            models.append(models[-1].with_effect(one, constants))
    return tuple(models)
