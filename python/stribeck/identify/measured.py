"""Data and results of a search, in the form of the compiled core."""

from __future__ import annotations

from typing import TypeAlias, TypedDict

import numpy as np
from numpy.typing import NDArray

from stribeck.models.channels import ChannelArguments

__all__ = ["NOT_SUMMED", "Found", "Measured"]

Array = NDArray[np.float64]

#: The group of a sample whose residual is not summed.
NOT_SUMMED = np.uint32(2**32 - 1)

#: Values, sum of squares, whether it converged, outcome, evaluations, parameters without effect.
Found: TypeAlias = tuple[Array, float, bool, str, int, list[int]]


class Measured(TypedDict):
    """Contiguous samples with the torque to predict.

    ``target`` [n] is the measured torque without what is known, ``group`` [n] the group in which a
    sample's residual is summed, ``begins`` the samples at which a run starts in motion.
    """

    columns: ChannelArguments
    target: Array
    group: NDArray[np.uint32]
    begins: list[int]
    moving: NDArray[np.bool_]
    torque_norm: float
    threads: int
