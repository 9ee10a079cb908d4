"""Friction of identified models at common speeds and conditions, with standard errors.

Parameters of different models cannot be compared, and those of one model are correlated. The
friction torque at the same speed, load and temperature can be compared.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stribeck.models.model import Model
from stribeck.models.reader import parse_model_file
from stribeck.passivity.friction import friction_part

Array = NDArray[np.float64]

#: Speeds at which friction is compared, relative to the largest speed that all days reach.
SHARES = (0.1, 0.25, 0.5, 1.0)
#: Days that reach less than this share of the usual speed are ignored for the common speed.
LEAST_REACH = 0.5
#: Relative parameter step of the finite differences.
STEP = 1e-6


@dataclass(frozen=True)
class DayModel:
    """A model identified on one day, with the covariance [p, p] of its parameters."""

    model: Model
    covariance: Array

    @classmethod
    def of(cls, model_file: str, covariance: Sequence[float]) -> DayModel:
        """Create it from the stored text and covariance."""
        model = parse_model_file(model_file, Path("results")).model
        size = len(model.names)
        return cls(model, np.asarray(covariance, dtype=np.float64).reshape(size, size))

    def friction_at(self, velocity: Array, conditions: Mapping[str, float]) -> tuple[Array, Array]:
        """Torque of steady sliding [n] and its covariance [n, n].

        Parameters
        ----------
        velocity : array [n]
            rad/s or m/s, none of them zero.
        conditions
            Constant load, temperature and other channels by name. The motor torque is given by its
            magnitude; its sign is that of the velocity.

        Raises
        ------
        ValueError
            A channel that the model needs is missing, or the model has no value at these
            conditions.
        """
        friction, _ = friction_part(self.model)
        held = {name: x for name, x in conditions.items() if name in friction.core.needs}
        torque = _sliding(friction, velocity, held)
        gradient = np.zeros((velocity.size, len(self.model.names)))
        for k, name in enumerate(self.model.names):
            if self.covariance[k, k] <= 0.0 or name not in friction.names:
                continue
            at = friction.names.index(name)
            step = STEP * max(abs(friction.values[at]), float(np.sqrt(self.covariance[k, k])))
            ends = []
            for sign in (-1.0, 1.0):
                values = friction.values.copy()
                values[at] += sign * step
                ends.append(_sliding(friction.with_values(values), velocity, held))
            gradient[:, k] = (ends[1] - ends[0]) / (2.0 * step)
        return torque, gradient @ self.covariance @ gradient.T


def _sliding(friction: Model, velocity: Array, conditions: Mapping[str, float]) -> Array:
    along = np.sign(velocity)
    channels = {name: np.full_like(velocity, x) for name, x in conditions.items()}
    if "motor_torque" in channels:
        channels["motor_torque"] *= along
    parts = friction.split(velocity, **channels)
    return np.asarray(along * parts["dry"] + parts["rate"] + parts["additive"])


def common_speeds(models: Sequence[Model]) -> Array:
    """Return speeds in both directions that all days reach; empty if there are none.

    Returns
    -------
    array [n]
        rad/s or m/s, in the order of `SHARES`: positive speeds, then negative ones, each if all
        days have moved in that direction.
    """
    speeds = []
    for sign in (1.0, -1.0):
        ends = [max(0.0, *(sign * x for x in m.box.get("velocity", (0.0, 0.0)))) for m in models]
        usual = float(np.median(ends))
        reached = [end for end in ends if end >= LEAST_REACH * usual]
        if usual > 0.0:
            speeds += [sign * share * min(reached) for share in SHARES]
    return np.array(speeds)


def common_conditions(models: Sequence[Model]) -> dict[str, float]:
    """Return load, temperature and other channels for the comparison.

    The typical middle of the range. A load is zero if zero is in its range; the motor torque is
    half of its largest value.
    """
    middles: dict[str, list[float]] = {}
    for model in models:
        for name, (low, high) in model.box.items():
            if name != "velocity":
                middles.setdefault(name, []).append(_usual(name, low, high))
    return {name: float(np.median(values)) for name, values in middles.items()}


def _usual(name: str, low: float, high: float) -> float:
    if name == "motor_torque":
        return 0.5 * max(abs(low), abs(high))
    if name in ("load_torque", "external_torque") and low <= 0.0 <= high:
        return 0.0
    return 0.5 * (low + high)
