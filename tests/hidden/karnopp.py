"""The joint of the open-loop generator under sampled PD control: a third kind of recording.

Friction has the forms of `stribeck.benchmark.open_loop`; the motion is what the controller makes of
it. The benchmark's own closed loop (`stribeck.benchmark.closed_loop`) shares nothing with it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray
from stribeck.benchmark.draws import log_uniform, size_beyond
from stribeck.benchmark.open_loop.effects import CAPS, EFFECTS, check
from stribeck.benchmark.open_loop.joint import draw_joint
from stribeck.benchmark.open_loop.record import coloured_noise
from stribeck.benchmark.open_loop.schedule import schedule
from stribeck.benchmark.open_loop.shapes import draw_shapes
from stribeck.benchmark.open_loop.temperature import joint_temperature
from stribeck.benchmark.open_loop.world import World

Array = NDArray[np.float64]
Shape = Callable[[Array], Array]


def lookup(f: Shape, low: float, high: float, n: int = 16001) -> Callable[[float], float]:
    """A fast scalar version of `f` on [low, high], held beyond it."""
    values = np.broadcast_to(f(np.linspace(low, high, n)), (n,)).tolist()
    scale, last = (n - 1) / (high - low), n - 1

    def at(x: float) -> float:
        r = (x - low) * scale
        if r <= 0:
            return values[0]
        i = int(r)
        if i >= last:
            return values[last]
        return values[i] + (values[i + 1] - values[i]) * (r - i)

    return at


#: What the loop below does not simulate.
NOT_SIMULATED = (
    "presliding",
    "delay",
    "gain",
    "spring",
    "ripple",
    "drift",
    "saturation",
    "quadrant",
)
CLOSED_LOOP_EFFECTS = tuple(e for e in EFFECTS if e not in NOT_SIMULATED)


def make_closed_loop(
    effects: Sequence[str], seed: int, size: float | Sequence[float] = 1.0
) -> tuple[pl.DataFrame, dict[str, Any]]:
    """A joint under sampled PD control with feed-forward, recorded by its drive.

    Steps of 1 ms with a Karnopp zero-velocity band (inside it the joint sticks while the drive
    stays under breakaway); encoder counts; velocity from centred differences inside the drive;
    torque is the motor torque plus current noise. The size is searched on the reference motion;
    truth["sizes"] is what the real motion shows.
    """
    names, sizes, _ = check(effects, size, {})
    if bad := [n for n in names if n not in CLOSED_LOOP_EFFECTS]:
        raise ValueError(f"not available in closed loop: {bad}")
    rng = np.random.default_rng([seed, 7])
    rate, m = [(125.0, 8), (200.0, 5), (250.0, 4)][int(rng.integers(3))]
    duration, h = float(rng.uniform(95.0, 120.0)), 1 / (rate * m)
    joint = draw_joint(rng, names, None)
    motion, swaps = schedule(rng, joint, duration + 1.0, None)
    payload = rng.permutation(np.resize([0.35, 1.0, 1.6, 0.7], len(swaps) + 1))
    heat, holds = joint_temperature(rng, duration, None), rng.uniform(-0.9, 0.9, (997, 2))
    world = World(joint, motion, swaps, payload, heat, holds, {}, None, 1 / rate, m)
    n = round(duration * rate)
    fine = np.arange(n * m) * h
    rq, rv, ra = motion(fine)
    t, v, q, a = fine[::m], rv[::m], rq[::m], ra[::m]
    tl = world.true_load(t, q, a)
    world.shapes = shapes = draw_shapes(rng, joint, tl, heat(t))
    noise = joint.coulomb * log_uniform(rng, 0.02, 0.05)

    def contribution(amps: dict[str, float], state: tuple[Array, ...]) -> Array:
        t, q, v, a, tl = state
        return (
            world.friction(t, q, v, a, tl, amps)
            - world.known_load(q, a, tl, amps)
            - world.friction(t, q, v, a, tl, {})
            + tl
        )

    amps: dict[str, float] = {}
    on = np.abs(v) > 0.01 * joint.vmax
    for name, want in zip(names, sizes, strict=True):
        one = np.ones_like(v) if name == "direction" else v
        basis = np.stack([np.sign(v), v, one], 1)[on]
        grid = np.geomspace(1e-4, 1.0, 60) * CAPS[name]
        state = (t, q, v, a, tl)
        found = [size_beyond(contribution({name: float(x)}, state)[on], basis) for x in grid]
        noise = min(noise, found[-1] / (1.02 * want))
        amps[name] = float(np.exp(np.interp(want * noise, found, np.log(grid))))

    # scalar versions of everything the loop needs
    big = 3 * joint.vmax
    x = amps.get("stribeck", 0.0)
    by_speed = lookup(lambda s: joint.coulomb * (1 + x * shapes["stribeck"](s)), 0.0, big, 60001)
    by_rate = lookup(lambda s: shapes["rate"](s, amps.get("nonlinear_viscous", 0.0)), 0.0, big)
    y = amps.get("position", 0.0)
    ends = joint.centre - 1.5 * joint.half, joint.centre + 1.5 * joint.half
    by_place = lookup(lambda p: np.maximum(1 + y * shapes["position"](p), 0.05), *ends)
    z = amps.get("load", 0.0)
    heavy = 4 * float(np.abs(tl).max())
    by_load = lookup(lambda w: 1 + z * shapes["load"](w), 0.0, heavy)
    temps = heat(fine)
    hot = (1 + amps.get("temperature_dry", 0.0) * shapes["dry"](temps)).tolist()
    thin = shapes["viscosity"](temps, amps.get("temperature_viscous", 0.0)).tolist()
    mass = (payload[np.searchsorted(swaps, fine)] * joint.gravity).tolist()
    of_dry, of_rate = (0.5 * amps.get("direction", 0.0) * k for k in shapes["direction"])
    constant = shapes["offset"] * amps.get("offset", 0.0) * joint.coulomb
    revolute, inertia = joint.kind == "revolute", joint.inertia
    count = 2.0 ** round(math.log2(2 * joint.half / 3e5))
    wn = 2 * math.pi * rng.uniform(2.5, 5.0)
    kp, kd = inertia * wn * wn, 1.4 * inertia * wn
    band = 1e-4 * joint.vmax
    target, speed, push = rq.tolist(), rv.tolist(), (inertia * ra).tolist()
    pos, vel, acc, drive, current, smooth, last = target[0], 0.0, 0.0, 0.0, 0.0, 0.0, target[0]
    out_q, out_v = [0.0] * (n * m), [0.0] * (n * m)
    out_a, out_u, out_g = [0.0] * n, [0.0] * n, [0.0] * n
    for i in range(n * m):
        if revolute:
            g = mass[i] * math.cos(pos + joint.phase)
        else:
            g = mass[i] + joint.spring * (pos - joint.centre)
        if i % m == 0:
            seen = round(pos / count) * count
            smooth += 0.6 * ((seen - last) * rate - smooth)
            last, wanted = seen, speed[i]
            fade = wanted / (abs(wanted) + 0.01 * joint.vmax)
            current = push[i] + g + joint.coulomb * 0.8 * fade + joint.viscous * wanted
            drive = current + kp * (target[i] - seen) + kd * (wanted - smooth)
        free = drive - g - constant
        w = vel if vel != 0.0 else free
        side = 1.0 if w > 0 else -1.0
        s = abs(vel)
        dry = by_speed(s) * hot[i]
        if y:
            dry *= by_place(pos)
        dry *= 1 + side * of_dry
        rate_part = side * by_rate(s) * thin[i] * (1 + side * of_rate)
        if z:
            f = side * dry + rate_part + constant
            f = side * dry * by_load(abs(drive - f)) + rate_part + constant
            for _ in range(4):
                f = side * dry * by_load(abs(drive - f)) + rate_part + constant
            dry *= by_load(abs(drive - f))
        if s < band and abs(free) <= dry:
            vel = acc = 0.0
        else:
            acc = (free - side * dry - rate_part) / inertia
        out_q[i], out_v[i] = pos, vel
        if i % m == 0:
            k = i // m
            out_a[k], out_u[k], out_g[k] = acc, drive, g
        new = vel + h * acc
        if new * vel < 0:
            new = 0.0
        pos += 0.5 * h * (vel + new)
        vel = new

    path, true_v = np.asarray(out_q), np.asarray(out_v)
    seen = np.round(path / count) * count
    wide = np.pad(seen, 2, mode="edge")
    v_seen = ((wide[4:] - wide[:-4]) / (4 * h))[::m]
    q, v, a = path[::m], true_v[::m], np.asarray(out_a)
    torque, tl = np.asarray(out_u), inertia * a + np.asarray(out_g)
    sigma = count / math.sqrt(6) / (4 * h)
    on = (np.abs(v_seen) > 5 * sigma) & (t > 1.0)
    recorded = torque + noise * coloured_noise(rng, n)
    given = world.known_load(q, a, tl, amps)
    law = tl + world.friction(t, q, v_seen, a, tl, amps)
    level = float(np.sqrt(np.mean((recorded - law)[on] ** 2)))
    basis = np.stack([np.sign(v_seen), v_seen], 1)[on]
    state = (t, q, np.where(on, v, 0), a, tl)
    parts = {k: contribution({k: x}, state)[on] for k, x in amps.items()}
    whole = contribution(amps, state)[on]
    frame = pl.DataFrame(
        {
            "time": t,
            "position": seen[::m],
            "velocity": v_seen,
            "acceleration": a,
            "torque": recorded,
            "load_torque": given,
            "temperature": heat(t) + 0.04 * rng.standard_normal(n),
        }
    )
    truth: dict[str, Any] = {
        "hidden": names or ["none"],
        "size": size_beyond(whole, basis) / level if amps else 0.0,
        "sizes": {k: size_beyond(p, basis) / level for k, p in parts.items()},
        "asked": dict(zip(names, sizes, strict=True)),
        "amplitudes": amps,
        "kind": joint.kind,
        "coulomb": joint.coulomb,
        "viscous": joint.viscous,
        "noise_rms": level,
        "current_noise": noise,
        "velocity_noise": sigma,
        "rate": rate,
        "seed": seed,
        "limit": None,
        "cannot_show": [],
        "closed_loop": True,
    }
    return frame, truth
