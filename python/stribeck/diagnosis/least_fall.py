"""How much the held-out error must fall: the threshold that all rules of the diagnosis share."""

from __future__ import annotations

#: Relative fall of the held-out RMSE that a finding must bring, unless the caller asks for another.
LEAST_FALL = 0.01


def reduced(least_fall: float) -> float:
    """The fall that suffices where other evidence supports an effect: half of the least fall.

    So it is where the effect shows clearly in the band of the motion, and where effects or causes
    in the model already share its torque.

    Examples
    --------
    >>> reduced(0.01)
    0.005
    """
    return least_fall / 2.0
