"""The joint of one seed, evaluated at any time for given amplitudes of the hidden effects."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from stribeck.benchmark.open_loop.joint import SimulatedJoint
from stribeck.benchmark.open_loop.maxwell_slip import maxwell_slip
from stribeck.benchmark.open_loop.motion import MoveChain
from stribeck.benchmark.open_loop.moves import Array
from stribeck.benchmark.open_loop.outside import OUTSIDE
from stribeck.benchmark.open_loop.shapes import Shapes

Amplitudes = Mapping[str, float]


@dataclass
class World:
    """All random quantities of one seed.

    Amplitudes are by effect; ``coulomb`` and ``viscous`` are factors of the basic friction.
    """

    joint: SimulatedJoint
    motion: MoveChain
    swaps: Array
    payload: Array
    temperature: Callable[[Array], Array]
    holds: Array
    shapes: Shapes
    limit: str | None
    dt: float
    oversampling: int
    coarse: bool = False

    def true_load(self, t: Array, q: Array, a: Array) -> Array:
        """Load torque: inertia, and gravity with a payload that changes in dwells."""
        j = self.joint
        if self.limit == "constant_load":
            return np.full_like(q, j.gravity)
        mass = self.payload[np.searchsorted(self.swaps, t)]
        if j.kind == "prismatic":
            return np.asarray(j.inertia * a + mass * j.gravity + j.spring * (q - j.centre))
        return np.asarray(j.inertia * a + mass * j.gravity * np.cos(q + j.phase))

    def direction(self, t: Array, v: Array, amplitudes: Amplitudes) -> Array:
        """Factor of the dry friction: sgn v, sticking at rest, or the Maxwell-slip state."""
        if amplitudes.get("presliding"):
            m = 1 if self.coarse else self.oversampling
            fine = (t[:, None] + self.dt * (np.arange(1 - m, 1) / m)).ravel()
            path = self.motion(fine)[0]
            reach = amplitudes["presliding"] * self.joint.half
            return maxwell_slip(path, reach, self.shapes["exponent"])[m - 1 :: m]
        d = np.sign(v)
        rest = v == 0
        edge = np.flatnonzero(np.diff(np.concatenate([[False], rest, [False]]).astype(int)))
        for k, (i, j) in enumerate(zip(edge[::2], edge[1::2], strict=True)):
            h = self.holds[k % len(self.holds)]
            d[i:j] = np.linspace(h[0], h[1], j - i)
        return d

    def friction(
        self, t: Array, q: Array, v: Array, a: Array, tl: Array, amplitudes: Amplitudes
    ) -> Array:
        """Friction and other unknown torques: offset, spring, ripple."""
        j, s = self.joint, self.shapes
        dry = np.full_like(q, j.coulomb * amplitudes.get("coulomb", 1.0))
        if x := amplitudes.get("stribeck"):
            dry *= 1 + x * s["stribeck"](np.abs(v))
        if x := amplitudes.get("load"):
            dry *= 1 + x * s["load"](np.abs(tl))
        if x := amplitudes.get("quadrant"):
            dry *= 1 + x * s["quadrant"](v, tl)
        if x := amplitudes.get("temperature_dry"):
            dry *= 1 + x * s["dry"](self.temperature(t))
        if x := amplitudes.get("position"):
            dry *= np.maximum(1 + x * s["position"](q), 0.05)
        if x := amplitudes.get("drift"):
            dry *= 1 + x * s["drift"](t)
        for name in OUTSIDE:
            if x := amplitudes.get(name):
                dry *= np.maximum(1 + x * s[name](t, q, v, a), 0.05)
        rate = s["rate"](v, amplitudes.get("nonlinear_viscous", 0.0))
        if x := amplitudes.get("temperature_viscous"):
            rate = rate * s["viscosity"](self.temperature(t), x)
        if x := amplitudes.get("direction"):
            of_dry, of_rate = s["direction"]
            dry *= 1 + 0.5 * x * of_dry * np.sign(v)
            rate = rate * (1 + 0.5 * x * of_rate * np.sign(v))
        constant = s["offset"] * amplitudes.get("offset", 0.0) * j.coulomb
        for name in ("spring", "ripple"):
            if x := amplitudes.get(name):
                constant = constant + x * j.coulomb * s[name](q)
        rate = rate * amplitudes.get("viscous", 1.0)
        return np.asarray(dry * self.direction(t, v, amplitudes) + rate + constant)

    def known_load(self, q: Array, a: Array, tl: Array, amplitudes: Amplitudes) -> Array:
        """The recorded load torque, with a hidden error of inertia or gravity."""
        j = self.joint
        given = tl - amplitudes.get("inertia", 0.0) * (j.inertia or j.coulomb / j.amax) * a
        return np.asarray(
            given
            - amplitudes.get("gravity", 0.0)
            * j.gravity
            * np.cos(q + j.phase + self.shapes["gravity"])
        )

    def measured(
        self, t: Array, amplitudes: Amplitudes, velocity_error: Array | float = 0.0
    ) -> tuple[Array, Array]:
        """Noise-free torque channel and the recorded load torque, both at the times `t`.

        With a `velocity_error` friction is evaluated at the recorded velocity, in the true
        direction: the prediction of a perfect model.
        """
        q, v, a = self.motion(t)
        given = self.known_load(q, a, self.true_load(t, q, a), amplitudes)
        late = t
        if x := amplitudes.get("delay"):
            late = t - self.shapes["delay"] * x * self.dt
            q, v, a = self.motion(late)
        tl = self.true_load(late, q, a)
        seen = v + np.clip(velocity_error, -0.9 * np.abs(v), 0.9 * np.abs(v))
        torque = tl + self.friction(late, q, seen, a, tl, amplitudes)
        return self.shown(torque, amplitudes), given

    def shown(self, torque: Array, amplitudes: Amplitudes) -> Array:
        """The torque channel for an acting `torque`: current times a nominal torque constant."""
        if x := amplitudes.get("saturation"):
            torque = self.shapes["saturation"](torque, x)
        if x := amplitudes.get("gain"):
            torque = torque / (1 - self.shapes["gain"] * x)
        return torque
