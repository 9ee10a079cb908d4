"""Sums of harmonics: trajectories that excite all inertial terms of an arm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class HarmonicTrajectory:
    """Joint i follows q_i(t) = sum_j alpha_ji sin(omega_ji t) (Indri et al., eq 13).

    Attributes
    ----------
    amplitudes, frequencies : tuple of tuples [joints][harmonics]
        In rad and rad/s.
    seconds : float
        Duration of one repetition.

    Examples
    --------
    >>> position, velocity, acceleration = FOUR_HARMONICS(np.array([0.0]))
    >>> position
    array([[0., 0.]])
    """

    amplitudes: tuple[tuple[float, ...], ...]
    frequencies: tuple[tuple[float, ...], ...]
    seconds: float

    def __call__(self, time: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at `time` [s]; rad, rad/s, rad/s2, [n, joints]."""
        size, omega = np.array(self.amplitudes), np.array(self.frequencies)
        phase = time[:, None, None] * omega
        sine, cosine = np.sin(phase), np.cos(phase)
        return (
            (size * sine).sum(axis=2),
            (size * omega * cosine).sum(axis=2),
            -(size * omega**2 * sine).sum(axis=2),
        )


#: The trajectory of Indri et al., section 4.2.
FOUR_HARMONICS = HarmonicTrajectory(
    amplitudes=((-0.4355, -0.4032, -0.5, -0.371), (0.371, 0.2097, 0.4677, 0.3387)),
    frequencies=((0.7213, 0.8656, 1.082, 1.8754), (1.8754, 2.0918, 0.8656, 1.3705)),
    seconds=15.0,
)
