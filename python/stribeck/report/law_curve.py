"""The friction of a law over velocity, at plausible values: what its curve looks like."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.models.model import Model
from stribeck.motion.generate.motion import JOINTS
from stribeck.motion.generate.plausible import plausible_values

__all__ = ["Condition", "LawCurve", "law_curve"]

Array = NDArray[np.float64]

#: The joint whose friction is drawn.
JOINT = JOINTS["revolute"]
#: Samples of the sweep, and its time from one end to the other and back, s.
SAMPLES, SECONDS = 8000, 40.0
#: Temperatures, degC, and loads as shares of the joint's gravity torque.
COLD, WARM = 20.0, 45.0
UNLOADED, LOADED = 0.1, 1.0
#: Curves that differ by less, as a share of their height, are one.
SAME = 0.01


@dataclass(frozen=True)
class Condition:
    """What is held while the velocity is swept; `said` in words, empty where nothing matters."""

    said: str
    temperature: float
    load: float


@dataclass(frozen=True)
class LawCurve:
    """Friction over velocity.

    Attributes
    ----------
    model
        The law with plausible values.
    velocity : array [n]
        A slow sweep to both ends, from the third stroke on; rad/s.
    curves
        Friction [n], N m, under each condition.
    """

    model: Model
    velocity: Array
    curves: tuple[tuple[Condition, Array], ...]


def law_curve(law: str) -> LawCurve:
    """The friction of a law of the catalog over velocity.

    A law with a state shows a loop about zero velocity, where it slides only after a displacement.

    Parameters
    ----------
    law : str
        An id of the catalog.

    Examples
    --------
    >>> curve = law_curve("coulomb")
    >>> float(curve.curves[0][1].max().round(1))
    18.0
    """
    known = {"largest_velocity": JOINT.speed, "largest_acceleration": JOINT.speed**2 / JOINT.stroke}
    made = Model(law, (), known)
    values = plausible_values(made, JOINT, np.random.default_rng(0))
    model = made.with_values([values[name] for name in made.names])
    time = np.arange(2 * SAMPLES) * (SECONDS / SAMPLES)
    turn = 2.0 * np.pi / SECONDS
    # The cube is slow about zero velocity, where the curve is steep.
    velocity = JOINT.speed * np.sin(turn * time) ** 3
    acceleration = np.gradient(velocity, time)
    last = slice(SAMPLES, None)
    curves = []
    for one in _conditions(model):
        torque = model.torque(
            velocity,
            np.cumsum(velocity) * (SECONDS / SAMPLES),
            acceleration,
            np.full(time.size, one.temperature),
            np.full(time.size, one.load),
            motor_torque=np.full(time.size, one.load),
            dt=np.full(time.size, SECONDS / SAMPLES),
            external_torque=np.full(time.size, one.load),
        )
        curves.append((one, torque[last]))
    first = curves[0][1]
    if all(np.abs(friction - first).max() < SAME * np.abs(first).max() for _, friction in curves):
        # At these values the friction does not depend on the condition.
        curves = [(Condition("", WARM, 0.0), first)]
    return LawCurve(model, velocity[last], tuple(curves))


def _conditions(model: Model) -> list[Condition]:
    """Two conditions for a law that depends on temperature or load, else one."""
    needs = set(model.core.needs)
    load = JOINT.gravity
    if needs & {"load_torque", "external_torque"}:
        return [
            Condition(f"load {share * load:.3g} N m", WARM, share * load)
            for share in (UNLOADED, LOADED)
        ]
    if "temperature" in needs:
        return [Condition(f"{degrees:g} °C", degrees, 0.0) for degrees in (COLD, WARM)]
    return [Condition("", WARM, 0.0)]
