"""Test-bench recordings of simulated joints with known friction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import polars as pl
import stribeck as sb
from numpy.typing import NDArray
from stribeck.motion.simulate.drive import Torque

Array = NDArray[np.float64]

RATE = 1000.0
#: Coulomb and static friction N m, Stribeck velocity rad/s, viscous friction N m s/rad.
COULOMB, STATIC, STRIBECK, VISCOUS = 4.0, 5.0, 0.02, 1.0
STIFFNESS = 5e4


def joint_friction(static: float = STATIC, *, bristle: bool = False) -> sb.Model:
    """A Stribeck curve, with or without the bristle of LuGre."""
    if bristle:
        return sb.model(
            "lugre",
            bristle_stiffness=STIFFNESS,
            bristle_damping=100.0,
            viscous_friction=VISCOUS,
            coulomb_friction=COULOMB,
            static_friction=static,
            stribeck_velocity=STRIBECK,
            stribeck_exponent=2.0,
        )
    return sb.model(
        "bittencourt_a",
        coulomb_friction=COULOMB,
        stribeck_height=static - COULOMB,
        stribeck_velocity=STRIBECK,
        stribeck_exponent=2.0,
        viscous_friction=VISCOUS,
    )


def driven(model: sb.Model, torque: Array, inertia: float, start: float = 0.0) -> pl.DataFrame:
    """The exact motion under a torque."""
    joint = sb.Joint.revolute(inertia)
    made = sb.simulate(model, joint, Torque(torque), step=1.0 / RATE, position=start)
    return made.to_frame().select("time", "position", "torque")


def measured(
    frame: pl.DataFrame, *, position: float = 1e-5, torque: float = 0.02, seed: int = 0
) -> pl.DataFrame:
    """What sensors with these RMS noises record."""
    rng = np.random.default_rng(seed)
    return frame.with_columns(
        pl.Series("position", frame["position"] + position * rng.standard_normal(frame.height)),
        pl.Series("torque", frame["torque"] + torque * rng.standard_normal(frame.height)),
    )


def ramps(
    rates: Sequence[float],
    *,
    rests: Sequence[float] | None = None,
    statics: Sequence[float] | None = None,
    bristle: bool = False,
) -> pl.DataFrame:
    """Torque ramps from rest in alternate directions, each until the joint slides.

    Parameters
    ----------
    rates
        Of the torque, N m/s.
    rests, statics
        Rest before each ramp, s, and its static friction, N m.
    """
    parts, at, place = [], 0.0, 0.0
    for k, rate in enumerate(rates):
        static = STATIC if statics is None else statics[k]
        rest = 0.5 if rests is None else rests[k]
        rise = rate * np.arange(round((static / rate + 0.15) * RATE)) / RATE
        sign = 1.0 if k % 2 == 0 else -1.0
        torque = np.concatenate([np.zeros(round(rest * RATE)), sign * rise, np.zeros(1000)])
        part = driven(joint_friction(static, bristle=bristle), torque, 0.1, place)
        parts.append(part.with_columns(pl.col("time") + at))
        at += torque.size / RATE
        place = float(part["position"][-1])
    return pl.concat(parts)


def releases(count: int, *, inertia: float = 0.3) -> pl.DataFrame:
    """A joint pushed to speed and released, in both directions."""
    push, free = np.ones(500), np.zeros(1500)
    torque = np.tile(np.concatenate([7.0 * push, free, -7.0 * push, free]), count)
    model = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.8)
    return driven(model, torque, inertia)


def small_loops(amplitude: float, *, count: int = 5) -> pl.DataFrame:
    """A slow alternating torque below the static friction."""
    time = np.arange(round(2.0 * count * RATE)) / RATE
    return driven(joint_friction(bristle=True), amplitude * np.sin(np.pi * time), 0.1)
