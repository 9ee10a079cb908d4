"""Realistic friction of a strain-wave joint, different from every law of the catalog.

Each part follows a physical model that the catalog's laws only approximate:

- hysteresis before sliding: a Prandtl-Ishlinskii operator, several elastic elements that slip one
  after the other, with the memory of nested reversals (Krasnosel'skii and
  Pokrovskii 1989);
- dry friction that falls with the Hersey number, viscosity times speed, by a rational function;
- viscous friction of a lubricant that thins under shear: Eyring's inverse hyperbolic sine (1936);
- viscosity that falls with temperature by Vogel's equation (1921);
- dry friction that grows with the load torque, quadratically at first and then in proportion;
- dry and viscous friction that differ between the two directions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

REFERENCE_TEMPERATURE = 24.0
#: Vogel's temperature of a lubricating grease, in degC below zero.
VOGEL = 95.0


@dataclass(frozen=True)
class TrueFriction:
    """Sizes of a joint's friction, SI units, at `REFERENCE_TEMPERATURE` without load.

    Attributes
    ----------
    coulomb
        Dry friction in full sliding, N m.
    stribeck_rise
        Increase of dry friction towards rest, as a share of it.
    stribeck_velocity
        Speed at which half of the increase remains, rad/s.
    shear
        Torque scale of shear thinning, N m.
    shear_velocity
        Speed above which the lubricant thins, rad/s.
    thinning
        Vogel's activation temperature, K.
    dry_cooling
        Relative decrease of dry friction with temperature, 1/K.
    load_share
        Increase of dry friction per `load_scale` of load torque, as a share of it.
    load_scale
        Load torque at which the increase changes from quadratic to proportional, N m.
    asymmetry
        Relative difference between forward and the mean of both directions.
    slips
        Deflection at which each element slips, rad.
    shares
        Share of dry friction that each element carries; they sum to one.
    """

    coulomb: float
    stribeck_rise: float
    stribeck_velocity: float
    shear: float
    shear_velocity: float
    thinning: float
    dry_cooling: float
    load_share: float
    load_scale: float
    asymmetry: float
    slips: tuple[float, ...]
    shares: tuple[float, ...]

    def viscosity(self, temperature: Array) -> Array:
        """Viscosity relative to that at the reference temperature (Vogel)."""
        return np.exp(
            self.thinning / (temperature + VOGEL) - self.thinning / (REFERENCE_TEMPERATURE + VOGEL)
        )

    def dry(self, velocity: Array, temperature: Array, load: Array) -> Array:
        """Dry friction in full sliding, N m."""
        hersey = velocity * self.viscosity(temperature) / self.stribeck_velocity
        stribeck = 1.0 + self.stribeck_rise / (1.0 + hersey**2)
        warm = 1.0 - self.dry_cooling * (temperature - REFERENCE_TEMPERATURE)
        pressed = 1.0 + self.load_share * (np.hypot(1.0, load / self.load_scale) - 1.0)
        return self.coulomb * stribeck * warm * pressed

    def viscous(self, velocity: Array, temperature: Array) -> Array:
        """Friction of the sheared lubricant, N m, with the sign of `velocity` (Eyring)."""
        sheared = velocity * self.viscosity(temperature) / self.shear_velocity
        return self.shear * np.arcsinh(sheared)

    def torque(
        self,
        position: Array,
        velocity: Array,
        temperature: Array,
        load: Array,
        deflections: Sequence[float],
    ) -> tuple[Array, tuple[float, ...]]:
        """Friction torque along a motion.

        Parameters
        ----------
        position, velocity, temperature, load : array [n]
            rad, rad/s, degC, N m.
        deflections
            Deflections of the elements before the first sample, rad.

        Returns
        -------
        torque : array [n]
            N m, opposing the motion with the sign of `velocity`.
        deflections : tuple
            Deflections of the elements after the last sample, rad.
        """
        bent = [
            stop_operator(position, slip, start)
            for slip, start in zip(self.slips, deflections, strict=True)
        ]
        engaged = sum(
            share * z / slip for share, z, slip in zip(self.shares, bent, self.slips, strict=True)
        )
        dry = engaged * (1.0 + self.asymmetry * engaged) * self.dry(velocity, temperature, load)
        lopsided = 1.0 + 0.5 * self.asymmetry * np.sign(velocity)
        torque = dry + lopsided * self.viscous(velocity, temperature)
        return torque, tuple(float(z[-1]) for z in bent)


def stop_operator(position: Array, slip: float, start: float) -> Array:
    """Deflection of an elastic element that slips at `slip`, along `position`, array [n].

    Between reversals the element follows the motion until it slips, so each interval of one
    direction has an exact solution.

    Examples
    --------
    >>> stop_operator(np.array([0.0, 1.0, 2.0, 1.5, -1.0]), 1.0, 0.0)
    array([ 0. ,  1. ,  1. ,  0.5, -1. ])
    """
    deflection = np.empty_like(position)
    step = np.sign(np.diff(position, prepend=position[0]))
    moved = np.flatnonzero(step)
    turned = moved[1:][step[moved[1:]] != step[moved[:-1]]]
    last, at = start, position[0]
    for rows in np.split(np.arange(position.size), turned):
        deflection[rows] = np.clip(last + position[rows] - at, -slip, slip)
        last, at = deflection[rows[-1]], position[rows[-1]]
    return deflection
