"""The constants of an effect, taken from a recording."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.effect.registry import find
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


def effect_constants(
    effect: str,
    recording: Recording,
    load: Array | None = None,
    residual: Array | None = None,
) -> dict[str, float]:
    """The constants that an effect needs, taken from the recording; of an excerpt, from all of it.

    Parameters
    ----------
    effect : str
        An id of the catalog; an effect by formula has no constants.
    load : array [n]
        Load torque where the recording does not give it.
    residual : array [n]
        Residual of the model without the effect, in which the period of a ripple is searched.
    """
    stated = find(effect)
    if stated is None:
        return {}
    whole = recording if recording.excerpt_of is None else recording.excerpt_of
    name = f"constants of {effect}"
    if name not in whole.remembered:
        whole.remembered[name] = stated.constants(whole)
    beside = stated.constants_beside(recording, load, residual)
    return {**whole.remembered[name], **beside}
