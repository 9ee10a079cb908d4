"""One recording: draw the joint, evaluate its motion, and add noise to the channels."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
import scipy
from numpy.typing import NDArray

from stribeck.benchmark.draws import log_uniform, size_beyond
from stribeck.benchmark.open_loop.amplitude import find_amplitudes
from stribeck.benchmark.open_loop.effects import IMPLIED, LIMITS, check
from stribeck.benchmark.open_loop.joint import draw_joint
from stribeck.benchmark.open_loop.moves import Array
from stribeck.benchmark.open_loop.outside import draw_outside
from stribeck.benchmark.open_loop.schedule import schedule
from stribeck.benchmark.open_loop.shapes import (
    draw_additive_shapes,
    draw_quadrant_shape,
    draw_shapes,
)
from stribeck.benchmark.open_loop.temperature import joint_temperature
from stribeck.benchmark.open_loop.world import Amplitudes, World
from stribeck.benchmark.sample import Oracle, Sample, Truth, tangents

Rows = NDArray[np.bool_]
RATES = (125.0, 160.0, 200.0, 250.0)
#: Time excluded from all sizes, s, in which filters settle.
SETTLED = 1.0


@dataclass
class Recording:
    """A recording, with additional data for tests of the generator.

    Attributes
    ----------
    moving : bool array [n]
        Rows of `frame` over which sizes are computed.
    clean : array [n]
        The torque channel without noise.
    contributions : dict of arrays [n]
        Change of `clean` by each hidden effect alone.
    """

    frame: pl.DataFrame
    truth: Truth
    moving: Rows
    clean: Array
    contributions: dict[str, Array]
    oracle: Oracle


def record(
    effects: Sequence[str], seed: int, size: float | Sequence[float] = 1.0, **limits: bool
) -> Recording:
    """Generate a recording with hidden `effects`, with its truth.

    Parameters
    ----------
    effects
        Names of `EFFECTS` or `OUTSIDE`, or ``("none",)``.
    size
        RMS of an effect over the moving rows, after a refit of Coulomb and viscous friction,
        relative to the noise: one number, or one for each effect.
    limits
        One limit of the motion (see `LIMITS`) set to true. Effects in ``truth["cannot_show"]`` are
        not visible then, so they have a fixed, physical amplitude.

    Raises
    ------
    ValueError
        An unknown effect or limit, two limits, or a wrong number of sizes.
    """
    names, sizes, limit = check(effects, size, limits)
    return _Session(names, sizes, limit, seed).recording()


def make(
    effects: Sequence[str], seed: int, size: float | Sequence[float] = 1.0, **limits: bool
) -> tuple[pl.DataFrame, Truth]:
    """Return the rows and the truth of `record`.

    ``truth["noise_rms"]`` is the residual RMS of the true friction, evaluated at the recorded
    velocity, over the moving rows.
    """
    made = record(effects, seed, size, **limits)
    return made.frame, made.truth


def sample(
    effects: Sequence[str], seed: int, size: float | Sequence[float] = 1.0, **limits: bool
) -> Sample:
    """Generate a recording in the common form of all generators."""
    made = record(effects, seed, size, **limits)
    return Sample(made.frame, made.truth, made.oracle)


def coloured_noise(rng: np.random.Generator, n: int) -> Array:
    """Unit noise: an AR(1) part with random correlation plus a white part."""
    rho, share = rng.uniform(0.0, 0.95), rng.uniform(0.2, 0.9)
    drive = rng.standard_normal(n + 500)
    red = scipy.signal.lfilter([math.sqrt(1 - rho * rho)], [1, -rho], drive)[500:]
    white = rng.standard_normal(n)
    return np.asarray(math.sqrt(share) * np.asarray(red) + math.sqrt(1 - share) * white)


class _Session:
    """The random quantities of one seed, in the order in which they are drawn."""

    def __init__(self, names: list[str], sizes: list[float], limit: str | None, seed: int) -> None:
        self.names, self.sizes, self.limit, self.seed = names, sizes, limit, seed
        rng = np.random.default_rng(seed)
        self.rate = float(rng.choice(RATES))
        duration = float(rng.uniform(130.0, 235.0))
        self.t = np.arange(round(duration * self.rate)) / self.rate
        self.joint = draw_joint(rng, names, limit)
        self.world = self._draw_world(rng, duration)
        self.q, self.v, self.a = self.world.motion(self.t)
        self._draw_forms(rng, duration)
        self.keep = self._kept_rows()
        self._draw_noise(rng)
        self._plain = self.world.measured(self.t, {})
        self._rng = rng

    def _draw_world(self, rng: np.random.Generator, duration: float) -> World:
        joint, limit = self.joint, self.limit
        motion, swaps = schedule(
            rng, joint, duration + 1.0, limit, "presliding" in self.names, "delay" in self.names
        )
        payload = rng.permutation(np.resize([0.35, 1.0, 1.6, 0.7], len(swaps) + 1))
        heat = joint_temperature(rng, duration, limit)
        holds = rng.uniform(-0.9, 0.9, (997, 2))
        over = int(rng.integers(8, 17))
        return World(joint, motion, swaps, payload, heat, holds, {}, limit, 1 / self.rate, over)

    def _draw_forms(self, rng: np.random.Generator, duration: float) -> None:
        world, joint = self.world, self.joint
        loads = world.true_load(self.t, self.q, self.a)
        world.shapes = draw_shapes(rng, joint, loads, world.temperature(self.t))
        # Drawn from another generator, so that recordings without these effects do not change.
        apart = {k: np.random.default_rng([self.seed, k]) for k in (11, 13, 17)}
        world.shapes |= draw_additive_shapes(apart[11], joint, loads, duration)
        world.shapes |= draw_quadrant_shape(apart[13], joint, loads)
        world.shapes |= draw_outside(apart[17], joint, duration, world.swaps)

    def _kept_rows(self) -> Rows:
        if self.limit == "no_slow_motion":
            return (np.abs(self.v) > 0.69 * self.joint.vmax) & (self.a == 0)
        if self.limit == "one_direction":
            return np.asarray(self.v >= 0)
        return np.ones(len(self.t), bool)

    def _draw_noise(self, rng: np.random.Generator) -> None:
        n = len(self.t)
        self.noise = self.joint.coulomb * log_uniform(rng, 0.015, 0.05)
        self.base_sigma = self.joint.vmax * log_uniform(rng, 4e-4, 1.4e-3)
        if "presliding" in self.names:  # the encoder must resolve the presliding distance
            self.base_sigma *= 0.4
        self.unit_v = np.clip(rng.standard_normal(n), -4.5, 4.5)
        self.unit = coloured_noise(rng, n)
        slow = np.abs(self.v) < 0.02 * self.joint.vmax
        turns = np.abs(self.a[slow]) if np.any(slow) else self.a
        self._turn = float(np.max(np.abs(turns), initial=0.0))

    def sigma(self, amplitudes: Amplitudes) -> float:
        """Velocity noise; samples with an uncertain direction under a delay must not be moving."""
        slip = self._turn * amplitudes.get("delay", 0.0) / self.rate
        return max(self.base_sigma, 1.05 * slip / 5)

    def rows(self, amplitudes: Amplitudes) -> Rows:
        """Moving rows, by the recorded velocity."""
        s = self.sigma(amplitudes)
        moving = np.abs(self.v + s * self.unit_v) > 5 * s
        return np.asarray(self.keep & moving & (self.t > SETTLED))

    def contribution(self, amplitudes: Amplitudes) -> Array:
        """Change of measured torque minus recorded load torque by the hidden effects."""
        torque, given = self.world.measured(self.t, amplitudes)
        return (torque - given) - (self._plain[0] - self._plain[1])

    def _base(self, *names: str) -> Array:
        """Columns of the base model, and of the simpler effects contained in those of `names`."""
        return np.stack([np.sign(self.v), self.v, *self._contained(*names).values()], 1)

    def _contained(self, *names: str) -> dict[str, Array]:
        """Shapes of the simpler effects contained in those of `names`."""
        shapes = {}
        if "direction" in names:
            shapes["offset"] = np.ones_like(self.v)
        if "quadrant" in names:
            load = self.world.true_load(self.t, self.q, self.a)
            shapes["load"] = np.sign(self.v) * np.abs(load)
        return shapes

    def size(self, name: str, amplitude: float) -> float:
        """RMS of one effect outside the span of the base model."""
        one = {name: amplitude}
        on = self.rows(one)
        return size_beyond(self.contribution(one)[on], self._base(name)[on])

    def recording(self) -> Recording:
        """Return the recording."""
        world, joint, rng, t = self.world, self.joint, self._rng, self.t
        cannot = LIMITS.get(self.limit or "", [])
        wanted = dict(zip(self.names, self.sizes, strict=True))
        world.coarse = True
        amplitudes, noise = find_amplitudes(wanted, self.noise, self.size, cannot)
        world.coarse = False
        s, on = self.sigma(amplitudes), self.rows(amplitudes)
        clean, given = world.measured(t, amplitudes)
        fineness = joint.half / 30000 / joint.vmax * self.base_sigma / 1e-3 + 1e-12
        count = 2.0 ** round(math.log2(fineness))
        velocity_error = s * self.unit_v
        frame = pl.DataFrame(
            {
                "time": t,
                "position": np.round(self.q / count) * count if count > 0 else self.q,
                "velocity": self.v + velocity_error,
                "acceleration": self.a,
                "torque": clean + noise * self.unit,
                "load_torque": given,
                "temperature": world.temperature(t) + 0.04 * rng.standard_normal(len(t)),
            }
        )
        floor = noise * self.unit - joint.viscous * velocity_error
        parts = {n: self.contribution({n: amplitude}) for n, amplitude in amplitudes.items()}
        level = float(np.sqrt(np.mean(floor[on] ** 2)))
        truth = self._truth(wanted, amplitudes, parts, on, level)
        keep = self.keep
        return Recording(
            frame.filter(pl.Series(keep)),
            truth,
            on[keep],
            clean[keep],
            {n: p[keep] for n, p in parts.items()},
            self._oracle(amplitudes, velocity_error),
        )

    def _truth(
        self,
        wanted: Mapping[str, float],
        amplitudes: dict[str, float],
        parts: Mapping[str, Array],
        on: Rows,
        level: float,
    ) -> Truth:
        basis = self._base()[on]
        whole = self.contribution(amplitudes)[on] if amplitudes else np.zeros(int(on.sum()))
        own = {}
        for name, part in parts.items():
            others = [parts[o][on] for o in parts if o != name]
            own[name] = size_beyond(part[on], np.column_stack([basis, *others])) / level
        truth: Truth = {
            "hidden": self.names or ["none"],
            "implied": [e for n in self.names for e in IMPLIED.get(n, [])],
            "size": size_beyond(whole, basis) / level,
            "sizes": {n: size_beyond(p[on], basis) / level for n, p in parts.items()},
            "sizes_beyond_others": own,
            "asked": dict(wanted),
            "amplitudes": amplitudes,
            "kind": self.joint.kind,
            "coulomb": self.joint.coulomb,
            "viscous": self.joint.viscous,
            "noise_rms": level,
            "velocity_noise": self.sigma(amplitudes),
            "rate": self.rate,
            "seed": self.seed,
            "limit": self.limit,
            "cannot_show": list(LIMITS.get(self.limit or "", [])),
            "closed_loop": False,
        }
        if "delay" in amplitudes:
            truth["delay_s"] = self.world.shapes["delay"] * amplitudes["delay"] / self.rate
        return truth

    def _oracle(self, amplitudes: Mapping[str, float], velocity_error: Array) -> Oracle:
        """The true friction at the recorded velocity, with free amplitudes."""
        values = {"coulomb": 1.0, "viscous": 1.0, **amplitudes}
        _, given = self.world.measured(self.t, amplitudes)

        def predict(at: Mapping[str, float]) -> Array:
            torque, known = self.world.measured(self.t, at, velocity_error)
            return np.asarray((torque - known + given)[self.keep])

        prediction = predict(values)
        without = {e: {k: v for k, v in values.items() if k != e} for e in amplitudes}
        contained = self._contained(*amplitudes)
        return Oracle(
            prediction,
            tangents(predict, values, prediction),
            {e: prediction - predict(others) for e, others in without.items()},
            {name: shape[self.keep] for name, shape in contained.items()},
        )
