"""Recordings of one joint with chosen hidden effects, made from the package's own models.

The motion is analytic: slow and fast passes, dwells, oscillations with sharp reversals. The load
changes in sign and size independently of speed. The joint warms up and cools down. All random
numbers come from one seed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
import polars as pl
import scipy
from numpy.typing import NDArray

from stribeck.base.errors import SpecError
from stribeck.effect.base import GeneratedRecording
from stribeck.effect.registry import of_catalog
from stribeck.models.model import Model
from stribeck.models.published.sets import PREFIX, published
from stribeck.models.spec import parse_spec
from stribeck.motion.generate.motion import JOINTS, GeneratedJoint, Motion, plan_motion
from stribeck.motion.generate.payload import Payloads
from stribeck.motion.generate.plausible import plausible_values
from stribeck.motion.generate.published_joint import joint_of

Array = NDArray[np.float64]
#: What is hidden in a recording, as JSON.
Truth: TypeAlias = dict[str, Any]

#: Correlation of the torque noise between samples: drives filter their current.
NOISE_MEMORY = 0.5
#: Noise of the recorded velocity, as a share of the top speed.
VELOCITY_NOISE = 4e-4
#: Temperature at the start, degC.
COLD = 24.0
#: Steps per sample of laws with a state, whose bristle is faster than the sampling.
FINE_STEPS = 8
#: Shortest recording, s.
FEWEST_SECONDS = 20.0


def _temperature(t: Array, seconds: float, warming: float) -> Array:
    """Temperature in degC: rising for 60 % of the time, then falling, array [n]."""
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
) -> tuple[pl.DataFrame, Truth]:
    """Make a recording whose friction is `law` with `effects`.

    Parameters
    ----------
    law : str
        An id of the catalog, whose values are drawn, or ``"published:ID"``, which has its own.
    effects : sequence of str
        Ids of the catalog: the effects added to `law`.
    seconds, rate : float
        Duration in s and sample rate in Hz.
    noise : float
        RMS of the torque noise as a share of Coulomb friction; correlated in time.
    joint_kind : {"revolute", "prismatic"}
    warming : float
        Rise of the temperature before the joint cools down, K.

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
        An unknown law or effect, or a size out of range.

    Examples
    --------
    >>> frame, truth = generate(["load"], seconds=30.0, rate=100.0)
    >>> truth["spec"], frame.height
    ('coulomb+load', 3000)
    """
    if joint_kind not in JOINTS:
        raise SpecError(f"joint kind {joint_kind!r} is unknown: revolute or prismatic")
    _check_sizes(seconds, rate, noise, warming)
    printed = published(law) if law.startswith(PREFIX) else None
    joint = JOINTS[joint_kind] if printed is None else joint_of(printed)
    spec = law if printed is None else printed.spec
    law, hidden = parse_spec("+".join([spec, *effects]))
    rng = np.random.default_rng([seed, 20])
    made = _Hidden.drawn(law, hidden, joint, seconds, rate, warming, rng, printed)
    truth = made.truth(noise)
    return made.frame(noise, rng), {**truth, "seed": seed}


@dataclass(frozen=True)
class _Hidden:
    """A joint with chosen friction, its motion and its payloads."""

    effects: tuple[str, ...]
    joint: GeneratedJoint
    seconds: float
    rate: float
    warming: float
    model: Model
    delay: float
    motion: Motion
    payloads: Payloads

    @classmethod
    def drawn(
        cls,
        law: str,
        effects: tuple[str, ...],
        joint: GeneratedJoint,
        seconds: float,
        rate: float,
        warming: float,
        rng: np.random.Generator,
        printed: Model | None,
    ) -> _Hidden:
        constants = {
            "largest_velocity": joint.speed,
            "largest_acceleration": joint.speed**2 / joint.stroke,
        }
        described = GeneratedRecording(joint, seconds, COLD + 0.5 * warming)
        for effect in effects:
            constants.update(of_catalog(effect).generated_constants(described))
        # A delay evaluates the joint at another time, so no interpolation is needed.
        inner = tuple(effect for effect in effects if effect != "delay")
        torque_unit, position_unit = joint.units
        model = Model(law, inner, constants, torque_unit=torque_unit, position_unit=position_unit)
        values = plausible_values(model, joint, rng)
        if printed is not None:
            model = replace(model, constants={**model.constants, **printed.constants})
            values |= dict(zip(printed.names, printed.values.tolist(), strict=True))
        model = model.with_values([values[name] for name in model.names])
        motion = plan_motion(rng, joint, seconds + 1.0)
        # Four payloads and three speeds: every speed is combined with every payload in turn.
        masses = np.resize(rng.permutation([0.3, 1.0, 1.7, 0.6]), len(motion.swaps) + 1)
        delay = 1.6 / rate if "delay" in effects else 0.0
        payloads = Payloads(joint, motion, masses, rate)
        return cls(effects, joint, seconds, rate, warming, model, delay, motion, payloads)

    @property
    def samples(self) -> int:
        return round(self.seconds * self.rate)

    def friction_and_load(self) -> Array:
        """Motor torque [n] without noise, N m or N."""
        fine = FINE_STEPS if self.model.has_state else 1
        n, rate = self.samples * fine, self.rate * fine
        t = np.arange(n) / rate - (fine - 1) / rate - self.delay
        q, v, a = self.motion(t)
        load = self.payloads.torque(t, q, a)
        temperature = _temperature(t, self.seconds, self.warming)
        friction = self.model.torque(
            v,
            q,
            a,
            temperature,
            load,
            dt=np.full(n, 1.0 / rate),
            external_torque=self.payloads.external_torque(t, q),
            time=t,
            load_torque_curvature=self.payloads.curvature(t),
            temperature_rate=np.gradient(temperature, 1.0 / rate),
        )
        return (load + friction)[fine - 1 :: fine]

    def frame(self, noise: float, rng: np.random.Generator) -> pl.DataFrame:
        """The recording, with noise."""
        n, joint = self.samples, self.joint
        time = np.arange(n) / self.rate
        q, v, a = self.motion(time)
        load = self.payloads.torque(time, q, a)
        for effect in self.effects:
            why = of_catalog(effect).cannot_hide(self.model, load)
            if why is not None:
                raise SpecError(why)
        torque = self.friction_and_load()
        white = noise * joint.coulomb * math.sqrt(1.0 - NOISE_MEMORY**2)
        torque_noise = white * rng.standard_normal(n + 200)
        torque_noise = scipy.signal.lfilter([1.0], [1.0, -NOISE_MEMORY], torque_noise)[200:]
        temperature = _temperature(time, self.seconds, self.warming)
        frame = pl.DataFrame(
            {
                "time": time,
                "position": q + 1e-5 * joint.stroke * rng.standard_normal(n),
                "velocity": v + VELOCITY_NOISE * joint.speed * rng.standard_normal(n),
                "acceleration": a,
                "torque": torque + torque_noise,
                "load_torque": load,
                "temperature": temperature + 0.05 * rng.standard_normal(n),
            }
        )
        if "external_torque" not in self.model.core.needs:
            return frame
        return frame.with_columns(external_torque=self.payloads.external_torque(time, q))

    def truth(self, noise: float) -> Truth:
        """What is hidden, and how the recording is made."""
        model = self.model
        pairs = zip(model.parameters, model.values, strict=True)
        parameters = {p.name: {"value": float(x), "unit": p.unit} for p, x in pairs}
        if self.delay:
            parameters["delay"] = {"value": self.delay, "unit": "s"}
        return {
            "spec": "+".join((model.law, *self.effects)),
            "law": model.law,
            "hidden": list(self.effects),
            "parameters": parameters,
            "constants": dict(model.core.constants),
            "noise_rms": noise * self.joint.coulomb,
            "velocity_noise": VELOCITY_NOISE * self.joint.speed,
            "torque_unit": model.torque_unit,
            "position_unit": model.position_unit,
            "joint_kind": self.joint.kind,
            "seconds": float(self.seconds),
            "rate_hz": float(self.rate),
        }


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
