"""Stiffness and damping of a bristle from presliding, by the simplex of Nelder and Mead.

Tadese et al. 2021, section V-A.3: a slow torque below the Coulomb friction moves the joint back and
forth by fractions of a degree. The paper simulates the motion under the measured torque; here the
torque is predicted from the measured motion, so that the target is a recorded quantity.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base.errors import FitError, option
from stribeck.identify.figures import rms
from stribeck.models.channels import ChannelArguments
from stribeck.models.model import Model
from stribeck.recording.recording import Recording
from stribeck.recording.rows import segment_slices

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Initial size of the simplex: decades of a parameter, and share of the torque range.
DECADES, SHARE = 0.3, 0.1
#: The search ends when the parameters agree to this many decades.
TOLERANCE = 1e-5
#: Initial damping, as a share of the stiffness divided by the frequency of the motion.
LOSS = 0.1


@dataclass(frozen=True)
class Presliding:
    """The torque of `model` over the longest segment of `recording` without a gap.

    Attributes
    ----------
    stiffness, damping
        Indices of the two parameters that are searched.
    """

    recording: Recording
    model: Model
    stiffness: int
    damping: int

    @property
    def searched(self) -> tuple[int, int]:
        """Indices of the parameters that are searched."""
        return self.stiffness, self.damping

    @cached_property
    def rows(self) -> slice:
        """The longest segment without a gap."""
        return max(segment_slices(self.recording.segment), key=lambda s: s.stop - s.start)

    @cached_property
    def target(self) -> Array:
        """Measured torque minus its known part, array [n]."""
        return (self.recording.torque - self.recording.known_torque)[self.rows]

    @cached_property
    def position(self) -> Array:
        """Smoothed position, array [n]: the stiffness would turn its noise into torque.

        Raises
        ------
        FitError
            No position was recorded.
        """
        r = self.recording
        if r.position_smooth is None or r.columns["position"].derived:
            raise FitError(
                f"{r.path} has no position column, which shows the presliding deflection: map one "
                f"with {option('map', 'position=COLUMN')}"
            )
        return r.position_smooth[self.rows]

    @cached_property
    def _channels(self) -> ChannelArguments:
        r, rows = self.recording, self.rows
        dt = r.dt[rows].copy()
        dt[0] = 0.0
        travelled = np.diff(self.position, prepend=self.position[0])
        velocity = np.divide(travelled, dt, out=np.zeros_like(dt), where=dt > 0)
        channels = {
            name: None if column is None else np.ascontiguousarray(column[rows])
            for name, column in (
                ("position", r.position_smooth),
                ("acceleration", r.acceleration_smooth),
                ("temperature", r.temperature),
                ("load_torque", r.load_torque),
            )
        }
        return {
            **channels,
            "dt": dt,
            "velocity": np.ascontiguousarray(r.velocity_smooth[rows]),
            "mean_velocity": velocity,
        }

    def predict(self, values: Array, first_torque: float) -> Array:
        """Friction torque of a bristle that starts with `first_torque`, array [n]."""
        deflection = first_torque / values[self.stiffness]
        return self.model.core.torque(values, **self._channels, state=deflection)

    def fit(self, values: Array) -> tuple[Array, float, int]:
        """Search stiffness and damping from the slope of torque over position.

        The initial deflection is not recorded: the initial torque of the bristle is searched too.

        Returns
        -------
        values : array [p]
        first_torque : float
            In the unit of torque.
        evaluations : int

        Raises
        ------
        FitError
            No position; a torque that does not rise with it; a search that does not converge.
        """
        values = values.copy()
        stiffness, damping = self._first_guess()
        torque_range = float(np.ptp(self.target))

        def place(x: Array) -> tuple[Array, float]:
            values[self.stiffness] = stiffness * 10.0 ** x[0]
            values[self.damping] = damping * 10.0 ** x[1]
            return values, float(self.target[0] + torque_range * x[2])

        def error(x: Array) -> float:
            miss = rms(self.target - self.predict(*place(x)))
            return miss / torque_range if np.isfinite(miss) else 1e30

        simplex = np.vstack([np.zeros(3), np.diag([DECADES, DECADES, SHARE])])
        found = scipy.optimize.minimize(
            error,
            np.zeros(3),
            method="Nelder-Mead",
            options={
                "initial_simplex": simplex,
                "xatol": TOLERANCE,
                "fatol": 1e-9,
                "maxfev": 2000,
            },
        )
        if not found.success:
            raise FitError(
                f"{self.recording.path}: the presliding search did not converge ({found.message}): "
                f"record a slower torque with an amplitude closer to the Coulomb friction"
            )
        return *place(found.x), int(found.nfev)

    def _first_guess(self) -> tuple[float, float]:
        """Stiffness and damping from the slope of the torque over position."""
        q = self.position - self.position.mean()
        power = float(q @ q)
        slope = float(q @ (self.target - self.target.mean())) / power if power > 0 else 0.0
        if slope <= 0.0:
            raise FitError(
                f"{self.recording.path}: the torque does not rise with the position, so this is "
                f"not presliding: apply a slow alternating torque below the Coulomb friction"
            )
        frequency = rms(self._channels["mean_velocity"]) / rms(q)
        return slope, LOSS * slope / frequency
