"""Recordings of one joint with chosen hidden effects, made from the package's own models.

The motion is analytic (slow and fast passes, dwells, swings with sharp reversals), the load
changes sign and size independently of speed, the joint warms up and cools down. Everything
random comes from one seed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import polars as pl
import scipy
from numpy.typing import NDArray

from stribeck.base.errors import SpecError
from stribeck.effect.base import GeneratedRecording
from stribeck.effect.registry import of_catalog
from stribeck.models.model import Model
from stribeck.models.spec import parse_spec
from stribeck.motion.generate.motion import JOINTS, plan_motion
from stribeck.motion.generate.plausible import plausible_values

Array = NDArray[np.float64]

#: Correlation of the torque noise from one sample to the next: drives filter their current.
NOISE_MEMORY = 0.5
#: Noise of the recorded velocity, as a share of the top speed.
VELOCITY_NOISE = 4e-4
#: Temperature at the start, degC.
COLD = 24.0
#: Steps a sample of laws with a state, whose bristle moves faster than a recording samples.
FINE_STEPS = 8
FEWEST_SECONDS = 20.0


def _temperature(t: Array, seconds: float, warming: float) -> Array:
    """Warm up for the first 60 % of the time, then cool down, degC."""
    turn, slow = 0.6 * seconds, 0.25 * seconds
    full = -math.expm1(-turn / slow)
    rise = -np.expm1(-np.minimum(t, turn) / slow) / full
    return COLD + warming * rise * np.exp(-np.maximum(t - turn, 0.0) / slow)


def generate(
    effects: Sequence[str] = (),
    *,
    law: str = "coulomb",
    seed: int = 0,
    seconds: float = 120.0,
    rate: float = 200.0,
    noise: float = 0.02,
    joint_kind: str = "revolute",
    warming: float = 20.0,
) -> tuple[pl.DataFrame, dict[str, Any]]:
    """Make a recording whose friction is `law` with `effects`.

    Parameters
    ----------
    effects : sequence of str
        Ids of the catalog: what a base model of `law` alone lacks.
    seconds, rate : float
        Duration in s and samples a second in Hz.
    noise : float
        RMS of the torque noise as a share of Coulomb friction; correlated in time.
    joint_kind : {"revolute", "prismatic"}
    warming : float
        How far the joint warms up before it cools down again, K.

    Returns
    -------
    frame : polars.DataFrame
        ``time``, ``position``, ``velocity``, ``acceleration``, ``torque``, ``load_torque``,
        ``temperature``, and ``external_torque`` where the law reads it.
    truth : dict
        What is hidden: effects, parameters with units, noise in the unit of torque, the seed.

    Raises
    ------
    SpecError
        An unknown law or effect, or sizes that make no recording.

    Examples
    --------
    >>> frame, truth = generate(["load"], seconds=30.0, rate=100.0)
    >>> truth["spec"], frame.height
    ('coulomb+load', 3000)
    """
    if joint_kind not in JOINTS:
        raise SpecError(f"joint kind {joint_kind!r} is unknown: revolute or prismatic")
    _check_sizes(seconds, rate, noise, warming)
    law, hidden = parse_spec("+".join([law, *effects]))
    joint = JOINTS[joint_kind]
    rng = np.random.default_rng([seed, 20])
    torque_unit, position_unit = joint.units

    constants = {
        "largest_velocity": joint.speed,
        "largest_acceleration": joint.speed**2 / joint.stroke,
    }
    made = GeneratedRecording(joint, seconds, COLD + 0.5 * warming)
    for effect in hidden:
        constants.update(of_catalog(effect).generated_constants(made))
    # A delay is made by sampling the joint at another time, so that nothing is interpolated.
    inner = tuple(e for e in hidden if e != "delay")
    model = Model(law, inner, constants, torque_unit=torque_unit, position_unit=position_unit)
    values = plausible_values(model, joint, rng)
    model = model.with_values([values[name] for name in model.names])
    delay = 1.6 / rate if "delay" in hidden else 0.0

    motion = plan_motion(rng, joint, seconds + 1.0)
    # Four payloads against three speeds: every speed meets every payload in turn.
    payload = np.resize(rng.permutation([0.3, 1.0, 1.7, 0.6]), len(motion.swaps) + 1)
    n = round(seconds * rate)
    time = np.arange(n) / rate
    fine = FINE_STEPS if model.has_state else 1

    def load_at(t: Array, q: Array, a: Array, held_since: Array | None = None) -> Array:
        held = payload[np.searchsorted(motion.swaps, t if held_since is None else held_since)]
        weight = np.cos(q - 0.75 * joint.stroke) if joint.kind == "revolute" else np.ones_like(q)
        return joint.gravity * held * weight + joint.inertia * a

    def load_curvature_at(t: Array) -> Array:
        """Second derivative of the load torque by time, as samples of the same rate resolve it."""
        before, now, after = (
            load_at(t + k / rate, *motion(t + k / rate)[::2], held_since=t) for k in (-1, 0, 1)
        )
        return np.asarray((before - 2.0 * now + after) * rate**2)

    q, v, a = motion(time)
    load = load_at(time, q, a)
    for effect in hidden:
        why = of_catalog(effect).cannot_hide(load)
        if why is not None:
            raise SpecError(why)
    inside = np.arange(n * fine) / (rate * fine) - (fine - 1) / (rate * fine) - delay
    fq, fv, fa = motion(inside)
    fload = load_at(inside, fq, fa)
    step = np.full(n * fine, 1.0 / (rate * fine))
    friction = model.torque(
        fv, fq, fa, _temperature(inside, seconds, warming), fload, dt=step,
        external_torque=-load_at(inside, fq, np.zeros_like(fa)), time=inside,
        load_torque_curvature=load_curvature_at(inside),
    )  # fmt: skip
    torque = (fload + friction)[fine - 1 :: fine]

    level = noise * joint.coulomb
    drive = math.sqrt(1.0 - NOISE_MEMORY**2)
    torque_noise = level * drive * rng.standard_normal(n + 200)
    torque_noise = scipy.signal.lfilter([1.0], [1.0, -NOISE_MEMORY], torque_noise)[200:]
    sigma = VELOCITY_NOISE * joint.speed
    frame = pl.DataFrame(
        {
            "time": time,
            "position": q + 1e-5 * joint.stroke * rng.standard_normal(n),
            "velocity": v + sigma * rng.standard_normal(n),
            "acceleration": a,
            "torque": torque + torque_noise,
            "load_torque": load,
            "temperature": _temperature(time, seconds, warming) + 0.05 * rng.standard_normal(n),
        }
    )
    if "external_torque" in model.core.needs:
        external = -load_at(time, q, np.zeros_like(a))
        frame = frame.with_columns(external_torque=external)
    truth: dict[str, Any] = {
        "spec": "+".join((law, *hidden)),
        "law": law,
        "hidden": list(hidden),
        "parameters": {p.name: {"value": values[p.name], "unit": p.unit} for p in model.parameters},
        "constants": dict(model.core.constants),
        "noise_rms": level,
        "velocity_noise": sigma,
        "torque_unit": torque_unit,
        "position_unit": position_unit,
        "joint_kind": joint_kind,
        "seconds": float(seconds),
        "rate_hz": float(rate),
        "seed": seed,
    }
    if delay:
        truth["parameters"]["delay"] = {"value": delay, "unit": "s"}
    return frame, truth


def _check_sizes(seconds: float, rate: float, noise: float, warming: float) -> None:
    if not FEWEST_SECONDS <= seconds <= 1e5:
        raise SpecError(
            f"a recording of {seconds:g} s cannot hold slow and fast passes with dwells: give "
            f"{FEWEST_SECONDS:g} s to 100000 s"
        )
    if not 20.0 <= rate <= 1e4:
        raise SpecError(f"a rate of {rate:g} Hz is out of range: give 20 Hz to 10000 Hz")
    if not 0.0 <= noise <= 10.0:
        raise SpecError(f"noise {noise:g} is out of range: give a share of Coulomb friction, 0..10")
    if not 0.0 <= warming <= 200.0:
        raise SpecError(f"warming by {warming:g} K is out of range: give 0 K to 200 K")
