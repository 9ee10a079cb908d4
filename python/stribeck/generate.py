"""Synthetic recordings with chosen hidden effects, made from the package's own models.

The motion is analytic (slow and fast passes, dwells, swings with sharp reversals), the load
changes sign and size independently of speed, the joint warms up and cools down. Everything
random comes from one seed.
"""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray
from scipy.signal import lfilter

from stribeck.errors import SpecError
from stribeck.model import Model, parse_spec

Array = NDArray[np.float64]

#: Correlation of the torque noise from one sample to the next: drives filter their current.
NOISE_MEMORY = 0.5
#: Noise of the recorded velocity, as a share of the top speed.
VELOCITY_NOISE = 4e-4
#: Steps a sample of laws with a state, whose bristle moves faster than a recording samples.
FINE_STEPS = 8
FEWEST_SECONDS = 20.0


@dataclass(frozen=True)
class Joint:
    """Sizes of a joint, in SI units; forces for a prismatic one."""

    kind: str
    stroke: float
    speed: float
    coulomb: float
    viscous: float
    inertia: float
    gravity: float

    @property
    def units(self) -> tuple[str, str]:
        """Unit of torque and of position."""
        return ("N m", "rad") if self.kind == "revolute" else ("N", "m")


JOINTS = {
    "revolute": Joint("revolute", 1.2, 2.0, 8.0, 5.0, 1.2, 22.0),
    "prismatic": Joint("prismatic", 0.35, 0.5, 60.0, 150.0, 18.0, 150.0),
}


@dataclass(frozen=True)
class Motion:
    """Rest-to-rest moves one after another, each analytic in its own time."""

    starts: tuple[float, ...]
    origins: tuple[float, ...]
    moves: tuple[Callable[[Array], tuple[Array, Array, Array]], ...]
    swaps: tuple[float, ...]

    def __call__(self, t: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at the times `t`."""
        q, v, a = np.empty_like(t), np.empty_like(t), np.empty_like(t)
        which = np.maximum(np.searchsorted(self.starts, t, side="right") - 1, 0)
        for i in np.unique(which):
            rows = which == i
            dq, v[rows], a[rows] = self.moves[i](np.maximum(t[rows] - self.starts[i], 0.0))
            q[rows] = self.origins[i] + dq
        return q, v, a


def _pass(distance: float, speed: float, ramp: float) -> tuple[float, Any]:
    """Duration and law of a move with a cruise at `speed` and cosine-shaped ramps of speed."""
    # Too short to reach the speed: the same ramps, a slower cruise.
    cruise = abs(distance) / speed - ramp
    if cruise < 0.0:
        speed, cruise = abs(distance) / ramp, 0.0
    top = math.copysign(speed, distance)
    end = cruise + 2.0 * ramp
    w = math.pi / ramp

    def up(t: Array) -> tuple[Array, Array, Array]:
        return (
            0.5 * top * (t - np.sin(w * t) / w),
            0.5 * top * (1.0 - np.cos(w * t)),
            0.5 * top * w * np.sin(w * t),
        )

    def move(t: Array) -> tuple[Array, Array, Array]:
        rising, falling = np.minimum(t, ramp), np.clip(end - t, 0.0, ramp)
        q_up, v_up, a_up = up(rising)
        q_down, v_down, a_down = up(falling)
        first, last = t < ramp, t > ramp + cruise
        q = np.where(last, distance - q_down, q_up + top * np.clip(t - ramp, 0.0, cruise))
        v = np.where(first, v_up, np.where(last, v_down, top))
        a = np.where(first, a_up, np.where(last, -a_down, 0.0))
        return q, v, a

    return end, move


def _swing(duration: float, reach: float, frequency: float) -> Any:
    """Swing about the present position, growing from rest and dying down to it."""
    w, e = 2.0 * math.pi * frequency, math.pi / duration

    def move(t: Array) -> tuple[Array, Array, Array]:
        t = np.minimum(t, duration)
        grow, rate, bend = (
            np.sin(e * t) ** 2,
            e * np.sin(2.0 * e * t),
            2.0 * e * e * np.cos(2.0 * e * t),
        )
        s, c = np.sin(w * t), np.cos(w * t)
        return (
            reach * grow * s,
            reach * (rate * s + grow * w * c),
            reach * (bend * s + 2.0 * rate * w * c - grow * w * w * s),
        )

    return move


def _dwell(t: Array) -> tuple[Array, Array, Array]:
    zero = np.zeros_like(t)
    return zero, zero, zero


def plan_motion(rng: np.random.Generator, joint: Joint, seconds: float) -> Motion:
    """Draw a motion of at least `seconds` with slow and fast passes, swings and dwells."""
    starts: list[float] = []
    origins: list[float] = []
    moves: list[Any] = []
    swaps: list[float] = []
    now, at, turn = 0.0, 0.0, 0

    def add(duration: float, move: Any, advance: float) -> None:
        nonlocal now, at
        starts.append(now)
        origins.append(at)
        moves.append(move)
        now, at = now + duration, at + advance

    add(0.5, _dwell, 0.0)
    while now < seconds:
        slow, middle = rng.uniform(0.008, 0.06), rng.uniform(0.12, 0.45)
        # Every speed is used there and back, so that direction and speed are independent.
        for share in (rng.uniform(0.75, 1.0), middle, slow):
            speed = share * joint.speed
            ramp = rng.uniform(0.25, 0.5)
            way = -1.0 if at > 0.0 else 1.0
            room = joint.stroke * rng.uniform(0.6, 1.0) + abs(at)
            distance = way * min(room, speed * rng.uniform(1.4, 2.0))
            for leg in (distance, -distance):
                duration, move = _pass(leg, speed, ramp)
                add(duration, move, leg)
            if rng.uniform() < 0.5:
                duration, move = _pass(0.5 * distance, 0.5 * joint.speed, ramp)
                add(duration, move, 0.5 * distance)
            swaps.append(now + 0.15)
            add(0.3, _dwell, 0.0)
        if turn % 2 == 0:
            frequency = rng.uniform(0.3, 1.1)
            reach = min(0.9 * joint.speed / (2.0 * math.pi * frequency), 0.4 * joint.stroke)
            add(3.0, _swing(3.0, reach, frequency), 0.0)
            swaps.append(now + 0.15)
            add(0.3, _dwell, 0.0)
        turn += 1
    add(60.0, _dwell, 0.0)
    return Motion(tuple(starts), tuple(origins), tuple(moves), tuple(swaps))


def _temperature(t: Array, seconds: float, warming: float) -> Array:
    """Warm up for the first 60 % of the time, then cool down, degC."""
    turn, slow = 0.6 * seconds, 0.25 * seconds
    full = -math.expm1(-turn / slow)
    rise = -np.expm1(-np.minimum(t, turn) / slow) / full
    return 24.0 + warming * rise * np.exp(-np.maximum(t - turn, 0.0) / slow)


def plausible_values(model: Model, joint: Joint, rng: np.random.Generator) -> dict[str, float]:
    """A value for every parameter, from the joint's sizes and the catalog's starts."""
    c, b = joint.coulomb, joint.viscous
    scales = {
        "none": 1.0,
        "speed": joint.speed,
        "torque": 2.0 * c,
        "stiffness": c / joint.stroke,
        "damping": b,
        "inertia": joint.inertia,
        "sample_period": 1.0,
    }
    own = {
        "coulomb_friction": c,
        "viscous_friction": b,
        "static_friction": 1.5 * c,
        "viscous_friction_forward": b,
        "viscous_friction_backward": b,
        "stribeck_height": 0.35 * c,
        "stribeck_velocity": 0.05 * joint.speed,
        "stribeck_exponent": 1.4,
        "temperature_dry_slope": 0.012,
        "temperature_dry_curvature": 0.01,
        "temperature_viscous_slope": 0.03,
        "temperature_viscous_curvature": 0.02,
        "load_coulomb": 0.16,
        "load_exponent": 1.0,
        "load_stribeck": 0.0,
        "direction_coulomb": 0.15 * c,
        "direction_viscous": 0.15 * b,
        "nonlinear_viscous_coefficient": 0.6 * b,
        "nonlinear_viscous_exponent": 2.0,
        "nonlinear_viscous_saturation": 100.0 * joint.speed,
        "offset": 0.12 * c,
        "inertia": 0.4 * joint.inertia,
        "gravity_cos": 0.12 * joint.gravity,
        "gravity_sin": 0.08 * joint.gravity,
        "presliding_stiffness": 150.0 * c / joint.stroke,
        "presliding_damping": 0.1 * b,
        "bristle_stiffness": 300.0 * c / joint.stroke,
        "bristle_damping": 0.1 * b,
    }
    values = {}
    for p in model.parameters:
        if p.name.startswith("position_"):
            order = int(p.name.rsplit("_", 1)[1])
            values[p.name] = float(0.22 * c * rng.uniform(-1.0, 1.0) / order)
        else:
            values[p.name] = float(own.get(p.name, p.start * scales[p.scale]))
    return values


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
        ``temperature``.
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
        "reference_temperature": 24.0 + 0.5 * warming,
        "reference_load": 0.5 * joint.gravity,
        "reference_velocity": joint.speed,
        "position_start": -1.5 * joint.stroke,
        "position_length": 3.0 * joint.stroke,
        "position_periodic": 0.0,
    }
    # The delay is made by sampling the joint at another time, so that nothing is interpolated.
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

    def load_at(t: Array, q: Array, a: Array) -> Array:
        held = payload[np.searchsorted(motion.swaps, t)]
        weight = np.cos(q - 0.75 * joint.stroke) if joint.kind == "revolute" else np.ones_like(q)
        return joint.gravity * held * weight + joint.inertia * a

    q, v, a = motion(time)
    load = load_at(time, q, a)
    inside = np.arange(n * fine) / (rate * fine) - (fine - 1) / (rate * fine) - delay
    fq, fv, fa = motion(inside)
    fload = load_at(inside, fq, fa)
    step = np.full(n * fine, 1.0 / (rate * fine))
    friction = model.torque(fv, fq, fa, _temperature(inside, seconds, warming), fload, dt=step)
    torque = (fload + friction)[fine - 1 :: fine]

    level = noise * joint.coulomb
    drive = math.sqrt(1.0 - NOISE_MEMORY**2)
    torque_noise = level * drive * rng.standard_normal(n + 200)
    torque_noise = lfilter([1.0], [1.0, -NOISE_MEMORY], torque_noise)[200:]
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
    truth: dict[str, Any] = {
        "spec": "+".join((law, *hidden)),
        "law": law,
        "hidden": list(hidden),
        "parameters": {p.name: {"value": values[p.name], "unit": p.unit} for p in model.parameters},
        "constants": {name: constants[name] for name in model.core.constants},
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


def file_bytes(frame: pl.DataFrame, suffix: str) -> bytes:
    """A recording as a file; numbers read back with the same bits."""
    if suffix == ".csv":
        return frame.write_csv().encode("utf-8")
    stream = io.BytesIO()
    frame.write_parquet(stream, compression="zstd", compression_level=19)
    return stream.getvalue()


def sidecar_text(truth: dict[str, Any]) -> str:
    """The sidecar of a generated recording: what its columns cannot say."""
    return f'kind = "recording"\njoint_kind = "{truth["joint_kind"]}"\n'


#: How the shipped recording of `stribeck demo` was made. The joint hardly warms up, as in any
#: recording this short, so that the demo also meets effects that its data cannot show.
DEMO: dict[str, Any] = {
    "effects": ("load", "stribeck"),
    "seed": 1,
    "seconds": 80.0,
    "rate": 100.0,
    "noise": 0.03,
    "warming": 2.5,
}


def demo_recording() -> tuple[pl.DataFrame, dict[str, Any]]:
    """Make the shipped recording again, with what is hidden in it."""
    made = dict(DEMO)
    return generate(made.pop("effects"), **made)


def demo_path() -> Path:
    """Where the shipped recording is."""
    return Path(str(resources.files("stribeck") / "data" / "demo.parquet"))


__all__ = ["DEMO", "demo_path", "demo_recording", "file_bytes", "generate", "sidecar_text"]
