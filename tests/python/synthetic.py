"""Recordings made with numpy alone, so that a test never shares the product's formulas."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import polars as pl
import stribeck as sb
from numpy.typing import NDArray
from scipy.signal import lfilter

Array = NDArray[np.float64]

#: Coulomb friction in N m and viscous friction in N m s/rad of the joints made here.
COULOMB, VISCOUS = 3.0, 1.2
#: Inertia in kg m2 and weight in N m of `sticking`, and the steps that it takes for a sample.
INERTIA, WEIGHT, STEPS = 0.6, 4.0, 20


def ar1(rng: np.random.Generator, size: int, rho: float, rms: float) -> Array:
    """Noise that remembers `rho` of itself from one sample to the next, with this RMS."""
    white = rng.standard_normal(size + 500) * rms * np.sqrt(1.0 - rho**2)
    return lfilter([1.0], [1.0, -rho], white)[500:]


def motion(rows: int = 3000, rate: float = 100.0) -> tuple[Array, Array, Array, Array]:
    """Time, position, velocity, acceleration of three sines that never repeat together."""
    t = np.arange(rows) / rate
    q, v, a = np.zeros(rows), np.zeros(rows), np.zeros(rows)
    for size, frequency, phase in ((0.9, 0.21, 0.3), (0.25, 0.57, 1.1), (0.05, 1.34, 2.0)):
        w = 2.0 * np.pi * frequency
        q += size * np.sin(w * t + phase)
        v += size * w * np.cos(w * t + phase)
        a -= size * w**2 * np.sin(w * t + phase)
    return t, q, v, a


def joint(
    extra: Array | float = 0.0,
    *,
    rows: int = 3000,
    rate: float = 100.0,
    seed: int = 1,
    noise: float = 0.03,
    rho: float = 0.0,
    velocity_noise: float = 1e-4,
) -> pl.DataFrame:
    """A revolute joint with Coulomb and viscous friction, and `extra` torque.

    The load torque is given: gravity of a payload that changes four times, and inertia.
    """
    rng = np.random.default_rng(seed)
    t, q, v, a = motion(rows, rate)
    payload = np.array([0.4, 1.0, 1.6, 0.7, 1.3])[np.minimum(np.arange(rows) * 5 // rows, 4)]
    load = 6.0 * payload * np.sin(q + 0.4) + 0.3 * a
    friction = COULOMB * np.sign(v) + VISCOUS * v
    return pl.DataFrame(
        {
            "time": t,
            "position": q,
            "velocity": v + velocity_noise * rng.standard_normal(rows),
            "acceleration": a,
            "torque": load + friction + extra + ar1(rng, rows, rho, noise),
            "load_torque": load,
            "temperature": 30.0 - 12.0 * np.cos(2.0 * np.pi * t / t[-1]),
        }
    )


def behind_a_filter(frame: pl.DataFrame, lag: float) -> pl.DataFrame:
    """The same with a velocity behind a low-pass filter of first order."""
    share = 0.01 / lag
    v = frame["velocity"].to_numpy()
    late = lfilter([share], [1.0, share - 1.0], v, zi=[(1.0 - share) * v[0]])[0]
    return frame.with_columns(velocity=late)


def record(
    folder: Path, frame: pl.DataFrame, name: str = "made", **options: object
) -> sb.Recording:
    """Write `frame` to a file of `folder` and read it as a revolute joint."""
    path = folder / f"{name}.parquet"
    frame.write_parquet(path)
    return sb.read(path, **{"joint_kind": "revolute", **options})


def joint_with_stribeck_curve(rows: int = 3000) -> pl.DataFrame:
    """`joint` with a Stribeck curve of 1.5 N m at 0.1 rad/s."""
    v = motion(rows)[2]
    return joint(1.5 * np.sign(v) * np.exp(-((np.abs(v) / 0.1) ** 2)), rows=rows)


@cache
def sticking(
    seconds: float = 60.0, rate: float = 200.0
) -> tuple[Array, Array, Array, Array, Array]:
    """Time, position, velocity, acceleration and torque of a joint that a torque of sines drives.

    It has a weight. Where it stands, friction holds it up to its Coulomb level, and its
    acceleration jumps where friction stops or releases it.
    """
    step = 1.0 / (rate * STEPS)
    t = np.arange(round(seconds * rate) * STEPS) * step
    torque = sum(
        size * np.sin(2.0 * np.pi * frequency * t + phase)
        for size, frequency, phase in ((6.0, 0.17, 0.0), (4.0, 0.43, 1.0), (2.0, 1.1, 0.4))
    )
    q, v, a = (np.zeros(t.size) for _ in range(3))
    most = step / INERTIA * COULOMB
    for k in range(1, t.size):
        other = torque[k] - VISCOUS * v[k - 1] - WEIGHT * np.sin(q[k - 1])
        freely = v[k - 1] + step / INERTIA * other
        v[k] = np.sign(freely) * max(abs(freely) - most, 0.0)
        a[k] = (v[k] - v[k - 1]) / step
        q[k] = q[k - 1] + step * v[k]
    return tuple(x[::STEPS] for x in (t, q, v, a, torque))


def sticking_joint(
    velocity_noise: float = 0.01,
    noise: float = 0.08,
    *,
    acceleration_noise: float | None = None,
    seed: int = 2,
) -> pl.DataFrame:
    """A recording of `sticking`; without its acceleration if that has no noise."""
    t, q, v, a, torque = sticking()
    rng = np.random.default_rng(seed)
    columns = {
        "time": t,
        "position": q,
        "velocity": v + velocity_noise * rng.standard_normal(t.size),
    }
    if acceleration_noise is not None:
        columns["acceleration"] = a + acceleration_noise * rng.standard_normal(t.size)
    return pl.DataFrame({**columns, "torque": torque + noise * rng.standard_normal(t.size)})
