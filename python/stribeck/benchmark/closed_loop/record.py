"""One recording of a controlled joint."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
import polars as pl
import scipy
from numpy.typing import NDArray

from stribeck.benchmark.closed_loop.actuator import Actuator
from stribeck.benchmark.closed_loop.channels import Channels, channels
from stribeck.benchmark.closed_loop.effects import (
    AMPLITUDES,
    EFFECTS,
    IMPLIED,
    LEAST_AMPLITUDES,
    LIMITS,
    OUTSIDE,
)
from stribeck.benchmark.closed_loop.friction import (
    Amplitudes,
    Friction,
    State,
    draw_shapes,
    stribeck_height,
)
from stribeck.benchmark.closed_loop.machine import STEP, draw_machine
from stribeck.benchmark.closed_loop.reference import draw_reference
from stribeck.benchmark.closed_loop.simulation import gravity_error, simulate
from stribeck.benchmark.closed_loop.temperature import draw_temperature
from stribeck.benchmark.closed_loop.transmission import Transmission
from stribeck.benchmark.draws import log_uniform, root_mean_square, size_beyond
from stribeck.benchmark.sample import Oracle, Sample, tangents

Array = NDArray[np.float64]

#: Smallest and largest number of rows.
ROWS = (8_000, 12_000)
#: Payloads, which change in dwells.
PAYLOADS = (0.3, 1.0, 1.7, 0.6)
#: Duration of a change of the payload, s.
TAKEN_OVER = 0.12
#: Effects whose size is known only after a simulation.
SIMULATED = ("presliding", "backlash", "elasticity")
#: Largest number of simulations, and tolerances of the logarithm of the size ratio.
ROUNDS, CLOSE, CLOSE_ALONE = 3, 0.15, 0.25
#: Noise relative to Coulomb friction: range of the draw, and limits for adjusting the size.
NOISE, NOISE_LIMITS = (0.015, 0.05), (0.01, 0.12)


def sample(
    effects: Sequence[str], seed: int, size: float | Sequence[float] = 1.0, **limits: bool
) -> Sample:
    """Generate a recording with hidden `effects`, each of a size relative to the noise.

    The size is the RMS in the recorded motion, divided by the residual RMS of the true friction
    formula evaluated at the recorded channels.

    Raises
    ------
    ValueError
        An unknown effect or limit, or a wrong number of sizes.
    """
    names = [e for e in effects if e != "none"]
    on = [k for k, wanted in limits.items() if wanted]
    unknown = [e for e in names if e not in (*EFFECTS, *OUTSIDE)]
    unknown += [k for k in on if k not in LIMITS]
    if unknown or len(on) > 1:
        raise ValueError(f"unknown effect or limit, or more than one limit: {unknown or on}")
    sizes = [float(size)] * len(names) if isinstance(size, int | float) else list(size)
    wanted = dict(zip(names, sizes, strict=True))
    return _Session(wanted, seed, on[0] if on else None).sample()


class _Session:
    """The random quantities of one seed."""

    def __init__(self, wanted: dict[str, float], seed: int, limit: str | None) -> None:
        self.wanted, self.seed, self.limit = wanted, seed, limit
        # The exact size of a single effect is set by the noise at the end.
        self.close = CLOSE_ALONE if len(wanted) == 1 else CLOSE
        self.cannot = LIMITS.get(limit or "", [])
        rng = np.random.default_rng([seed, 71])
        self.machine = m = draw_machine(rng, wanted)
        rows = int(rng.integers(*ROWS))
        self.every = round(1 / (m.rate * STEP))
        self.reference = draw_reference(rng, m, rows / m.rate)
        r = self.reference
        steps = rng.permutation(np.resize(PAYLOADS, r.dwells.size + 1))
        payload = steps[np.searchsorted(r.dwells, r.time)]
        self.payload = np.asarray(scipy.ndimage.uniform_filter1d(payload, round(TAKEN_OVER / STEP)))
        self.temperature = draw_temperature(rng, r.time, limit)
        loads = m.inertia * r.acceleration + m.gravity_torque(r.position, self.payload)
        shapes = draw_shapes(rng, m, loads, self.temperature, r.dwells, float(r.time[-1]))
        self.friction = Friction(m, shapes)
        self.largest = float(np.abs(loads).max()) + m.coulomb + m.viscous * m.vmax
        self.noise = m.coulomb * log_uniform(rng, *NOISE)
        self.unit = _current_noise(rng, m.rate, rows)
        self.warm = 0.05 * rng.standard_normal(rows)
        self.speed_noise = rng.standard_normal(r.time.size)
        self.rows = slice(0, rows * self.every, self.every)
        self.time = r.time[self.rows]

    def sample(self) -> Sample:
        """Simulate until the sizes are close enough, and record."""
        x = self._first_amplitudes()
        for left in reversed(range(ROUNDS)):
            seen = self._simulate(x)
            level, sizes = self._noise_and_sizes(seen, x)
            off = {e: self.wanted[e] * level / s for e, s in sizes.items() if e not in self.cannot}
            if left == 0 or all(abs(math.log(f)) < self.close for f in off.values()):
                break
            further = {e: self._within(e, a * off.get(e, 1.0)) for e, a in x.items()}
            if further == x:
                break
            x = further
        if len(self.wanted) == 1 and off:
            self._meet_by_noise(seen, x, next(iter(off)), sizes)
        return self._record(seen, x)

    def _within(self, effect: str, amplitude: float) -> float:
        most = AMPLITUDES[effect][1]
        return min(max(amplitude, LEAST_AMPLITUDES.get(effect, 1e-4 * most)), most)

    def _first_amplitudes(self) -> dict[str, float]:
        """Amplitudes that give the sizes on the reference motion, or a first guess."""
        r = self.reference
        still = 0 * r.velocity
        seen = Channels(
            seen=r.position,
            position=r.position,
            velocity=r.velocity,
            exact=r.velocity,
            acceleration=r.acceleration,
            torque=still,
            direction=np.sign(r.velocity),
            carried=still,
            velocity_noise=1e-3 * self.machine.vmax,
        )
        x = {e: AMPLITUDES[e][0] for e in self.wanted}
        for effect, over_noise in self.wanted.items():
            if effect in SIMULATED or effect in self.cannot:
                continue
            for _ in range(4):
                reached = self._size(seen, {effect: x[effect]}, effect)
                x[effect] = self._within(effect, x[effect] * over_noise * self.noise / reached)
        return x

    def _simulate(self, x: Amplitudes) -> Channels:
        joined = None
        if "backlash" in x or "elasticity" in x:
            joined = Transmission(
                self.machine,
                x.get("elasticity", 0.0),
                x.get("backlash", 0.0),
                float(self.reference.position[0]),
            )
        course = simulate(
            self.machine,
            self.friction,
            self._actuator(x),
            joined,
            self.reference,
            self.payload,
            self.temperature,
            x,
        )
        return channels(self.machine, course, self.speed_noise)

    def _actuator(self, x: Amplitudes) -> Actuator:
        gain = self.friction.shapes.signs["gain"] * x.get("gain", 0.0)
        return Actuator(gain, x.get("saturation", 0.0), self.largest)

    def _known_load(self, seen: Channels, x: Amplitudes) -> Array:
        """Load torque of the robot's model, whose inertia or gravity may be wrong."""
        known = self.machine.inertia * (1 - x.get("inertia", 0.0))
        gravity = self.machine.gravity_torque(seen.position, self.payload)
        return np.asarray(known * seen.acceleration + gravity)

    def _predict(self, seen: Channels, x: Amplitudes, known: Array | None = None) -> Array:
        """Torque of each row by the true formula, at the measured channels.

        `known` is the recorded load torque; default: that for the amplitudes `x`.
        """
        m = self.machine
        load = m.inertia * seen.acceleration + m.gravity_torque(seen.position, self.payload)
        load = load + gravity_error(m, seen.position, x)
        load = load + seen.carried * x.get("carried", 1.0)
        torque = load + self.friction.torque(self._state(seen, load, x), x)
        shown = self._actuator(x).shown(torque)
        if known is not None:
            shown = shown + known - self._known_load(seen, x)
        return self._at_rows(shown, x)

    def _state(self, seen: Channels, load: Array, x: Amplitudes) -> State:
        # A moving, delayed sample may be at a reversal, where filtered values are between the
        # directions.
        turning = "presliding" in x or "delay" in x
        direction = seen.direction if turning else np.sign(seen.exact)
        speed = np.abs(seen.velocity)
        if late := x.get("frictional_lag"):
            t = self.reference.time
            speed = np.interp(t - late, t, speed)
        return State(
            self.reference.time,
            seen.position,
            seen.velocity,
            seen.acceleration,
            load,
            self.temperature,
            direction,
            self.friction.shapes.falls(speed),
        )

    def _at_rows(self, values: Array, x: Amplitudes) -> Array:
        """The torque channel at the rows, shifted in time if a delay is hidden."""
        late = self.friction.shapes.signs["delay"] * x.get("delay", 0.0)
        return (
            np.interp(self.time - late, self.reference.time, values) if late else values[self.rows]
        )

    def _left_over(self, seen: Channels, x: Amplitudes, *without: str) -> Array:
        """Predicted torque minus the recorded load torque, without some of the effects."""
        kept = {e: a for e, a in x.items() if e not in without}
        if {"backlash", "elasticity"} & set(without):
            kept["carried"] = 0.0
        if "frictional_lag" in without:
            # The Stribeck curve remains, without lag.
            kept["stribeck"] = stribeck_height(x)
        return self._predict(seen, kept) - self._known_load(seen, kept)[self.rows]

    def _moving(self, seen: Channels) -> NDArray[np.bool_]:
        fast = np.abs(seen.velocity[self.rows]) > 5 * seen.velocity_noise
        return np.asarray(fast & (self.time > 1.0))

    def _base(self, seen: Channels, *names: str) -> Array:
        """Columns of the base model, and of the simpler effects contained in those of `names`."""
        v = seen.velocity[self.rows]
        return np.stack([np.sign(v), v, *self._contained(seen, *names).values()], 1)

    def _contained(self, seen: Channels, *names: str) -> dict[str, Array]:
        """Shapes of the simpler effects contained in those of `names`."""
        v = seen.velocity[self.rows]
        shapes = {}
        if "direction" in names:
            shapes["offset"] = np.ones_like(v)
        if "quadrant" in names:
            shapes["load"] = np.sign(v) * np.abs(self._known_load(seen, {})[self.rows])
        if "frictional_lag" in names:
            shapes["stribeck"] = np.sign(v) * self.friction.shapes.falls(np.abs(v))
        return shapes

    def _size(self, seen: Channels, x: Amplitudes, effect: str) -> float:
        """RMS of one effect outside the span of the base model."""
        on = self._moving(seen)
        part = self._left_over(seen, x) - self._left_over(seen, x, effect)
        return max(size_beyond(part[on], self._base(seen, effect)[on]), 1e-300)

    def _noise_and_sizes(self, seen: Channels, x: Amplitudes) -> tuple[float, dict[str, float]]:
        """RMS of the residual of the true formula, and of each effect outside the base model."""
        on = self._moving(seen)
        level = root_mean_square((self._torque(seen, x) - self._predict(seen, x))[on])
        return level, {e: self._size(seen, x, e) for e in self.wanted}

    def _torque(self, seen: Channels, x: Amplitudes) -> Array:
        """The torque channel."""
        return self._at_rows(seen.torque, x) + self.noise * self.unit

    def _meet_by_noise(
        self, seen: Channels, x: Amplitudes, effect: str, sizes: Mapping[str, float]
    ) -> None:
        """Scale the noise, within limits, so that a single effect has exactly its size."""
        on = self._moving(seen)
        quiet = (self._at_rows(seen.torque, x) - self._predict(seen, x))[on]
        asked = (sizes[effect] / self.wanted[effect]) ** 2 - root_mean_square(quiet) ** 2
        low, high = (share * self.machine.coulomb for share in NOISE_LIMITS)
        self.noise = min(max(math.sqrt(max(asked, 0.0)), low), high)

    def _record(self, seen: Channels, x: dict[str, float]) -> Sample:
        known, rows = self._known_load(seen, x), self.rows
        frame = pl.DataFrame(
            {
                "time": self.time,
                "position": seen.seen[rows],
                "velocity": seen.velocity[rows],
                "acceleration": seen.acceleration[rows],
                "torque": self._torque(seen, x),
                "load_torque": known[rows],
                "temperature": self.temperature[rows] + self.warm,
            }
        )
        return Sample(frame, self._truth(seen, x), self._oracle(seen, x, known))

    def _truth(self, seen: Channels, x: dict[str, float]) -> dict[str, object]:
        level, sizes = self._noise_and_sizes(seen, x)
        on = self._moving(seen)
        quiet = (self._at_rows(seen.torque, x) - self._predict(seen, x))[on]
        names = list(self.wanted)
        return {
            "hidden": names or ["none"],
            "implied": [e for n in names for e in IMPLIED.get(n, [])],
            "sizes": {e: s / level for e, s in sizes.items()},
            "asked": self.wanted,
            "amplitudes": x,
            "kind": self.machine.kind,
            "coulomb": self.machine.coulomb,
            "viscous": self.machine.viscous,
            "noise_rms": level,
            "unmodelled_rms": root_mean_square(quiet),
            "velocity_noise": seen.velocity_noise,
            "rate": float(self.machine.rate),
            "seed": self.seed,
            "limit": self.limit,
            "cannot_show": list(self.cannot),
            "closed_loop": True,
        }

    def _oracle(self, seen: Channels, x: Amplitudes, known: Array) -> Oracle:
        """The true formula at the measured channels, with free amplitudes."""
        values = {"coulomb": 1.0, "viscous": 1.0, **x}
        if "backlash" in x or "elasticity" in x:
            values["carried"] = 1.0

        def predict(at: Mapping[str, float]) -> Array:
            return self._predict(seen, at, known)

        prediction = predict(values)
        free = {e: v for e, v in values.items() if e not in SIMULATED}
        made = tangents(lambda at: predict({**values, **at}), free, prediction)
        whole = self._left_over(seen, x)
        return Oracle(
            prediction,
            made,
            {e: whole - self._left_over(seen, x, e) for e in self.wanted},
            self._contained(seen, *self.wanted),
        )


def _current_noise(rng: np.random.Generator, rate: int, rows: int) -> Array:
    """Unit noise of the current: white noise, and a part correlated over tens of milliseconds."""
    memory = math.exp(-1 / (rate * float(rng.uniform(0.005, 0.05))))
    share = float(rng.uniform(0.0, 0.6))
    drive = rng.standard_normal(rows + 300)
    slow = scipy.signal.lfilter([math.sqrt(1 - memory**2)], [1, -memory], drive)[300:]
    noise = math.sqrt(share) * slow + math.sqrt(1 - share) * rng.standard_normal(rows)
    return np.asarray(noise / root_mean_square(noise))
