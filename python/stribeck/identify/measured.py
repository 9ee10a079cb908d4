"""Data and results of a search, in the form of the compiled core."""

from __future__ import annotations

from typing import TypeAlias, TypedDict

import numpy as np
from numpy.typing import NDArray

from stribeck.models.channels import ChannelArguments
from stribeck.models.model import Model

__all__ = ["NOT_SUMMED", "Found", "Measured", "search_options"]

Array = NDArray[np.float64]

#: The group of a sample whose residual is not summed.
NOT_SUMMED = np.uint32(2**32 - 1)

#: Values, sum of squares, whether it converged, outcome, evaluations, parameters without effect.
Found: TypeAlias = tuple[Array, float, bool, str, int, list[int]]


class Measured(TypedDict):
    """Contiguous samples with the torque to predict.

    ``target`` [n] is the measured torque without what is known, ``scale`` [n] the square root of
    the weights, where there are some, ``group`` [n] the group in which a sample's residual is
    summed, ``begins`` the samples at which a run starts in motion.
    """

    columns: ChannelArguments
    target: Array
    scale: Array | None
    group: NDArray[np.uint32]
    begins: list[int]
    moving: NDArray[np.bool_]
    torque_norm: float
    threads: int


def search_options(
    model: Model,
    lower: Array,
    upper: Array,
    *,
    logarithmic: NDArray[np.bool_] | None = None,
    tolerance: float = 0.0,
    most: int = 0,
    damping: float = 0.0,
) -> dict[str, object]:
    """Bounds [p], kinds of parameters and stopping rules; the defaults take no step.

    Parameters
    ----------
    logarithmic, tolerance, most, damping
        As of `stribeck.identify.search.separable.minimise`.
    """
    return {
        "lower": lower,
        "upper": upper,
        "linear": [bool(p.linear) for p in model.parameters],
        "logarithmic": np.zeros(lower.size, dtype=bool) if logarithmic is None else logarithmic,
        "tolerance": tolerance,
        "most": most,
        "damping": damping,
    }
