"""Conversion between the torque computed from the current and the torque that acts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Actuator:
    """A motor whose torque constant differs from the one assumed in the recording.

    Attributes
    ----------
    gain
        Relative excess of the true torque constant.
    saturation
        Share of the torque constant that is lost at the `largest` torque; the loss grows with the
        square of the current.
    """

    gain: float
    saturation: float
    largest: float

    def acting(self, shown: float) -> float:
        """Return the acting torque for the torque `shown` by the current."""
        lost = self.saturation * min((shown / self.largest) ** 2, 0.3)
        return shown * (1 + self.gain) * (1 - lost)

    def shown(self, acting: Array) -> Array:
        """Return the torque shown by the current for the `acting` torque."""
        if not self.saturation:
            return acting / (1 + self.gain)
        grid = np.linspace(-1.5, 1.5, 6001) * 2 * self.largest
        lost = self.saturation * np.minimum((grid / self.largest) ** 2, 0.3)
        return np.interp(acting, grid * (1 + self.gain) * (1 - lost), grid)
