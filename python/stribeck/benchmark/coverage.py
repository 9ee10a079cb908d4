"""Coverage of the 95 % intervals of parameters under autocorrelated noise."""

from __future__ import annotations

import math
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import polars as pl
import scipy
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.open_loop.joint import SimulatedJoint, draw_joint
from stribeck.benchmark.open_loop.schedule import schedule

Array = NDArray[np.float64]

RATE, DURATION = 100.0, 120.0
#: Two-sided 95 % of the normal distribution.
NORMAL_95 = 1.959964


@dataclass(frozen=True)
class Interval:
    """Whether an interval covers the truth.

    Attributes
    ----------
    covers, covers_profile
        For the 95 % interval of the fit, and for that of the profile likelihood.
    covers_ordinary
        For ordinary least squares, which treats samples as independent; None if the law is not
        linear in its parameters.
    width, width_ordinary
        Half-width of the interval divided by the parameter.
    """

    parameter: str
    covers: bool
    covers_ordinary: bool | None
    width: float
    width_ordinary: float | None
    covers_profile: bool | None = None


def intervals(law: str, seed: int, correlation: float | None) -> tuple[Interval, ...]:
    """Fit one recording whose friction is exactly the law, and check the intervals.

    Parameters
    ----------
    law : {"coulomb", "stribeck"}
        Coulomb and viscous friction, without or with a Stribeck curve.
    correlation
        Autocorrelation of the noise at lag one.
    """
    from stribeck.fitting.fit import fit
    from stribeck.recording.load import read

    frame, truth = autoregressive_recording(law, seed, correlation or 0.0)
    with tempfile.TemporaryDirectory(prefix="stribeck-benchmark-") as folder:
        path = Path(folder) / "recording.parquet"
        frame.write_parquet(path)
        recording = read(path)
    spec = "coulomb" if law == "coulomb" else "coulomb+stribeck"
    fitted = fit(spec, recording, starts=3)
    profiled = fit(spec, recording, starts=3, errors="profile")
    ordinary = _ordinary_intervals(frame, recording.moving) if law == "coulomb" else {}
    made = []
    for name, value in truth.items():
        low, high = fitted.estimates[name].ci95 or (math.nan, math.nan)
        from_profile = profiled.estimates[name].ci95 or (math.nan, math.nan)
        others = ordinary.get(name)
        made.append(
            Interval(
                name,
                bool(low <= value <= high),
                None if others is None else bool(others[0] <= value <= others[1]),
                (high - low) / 2 / abs(value),
                None if others is None else (others[1] - others[0]) / 2 / abs(value),
                bool(from_profile[0] <= value <= from_profile[1]),
            )
        )
    return tuple(made)


def autoregressive_recording(
    law: str, seed: int, correlation: float
) -> tuple[pl.DataFrame, dict[str, float]]:
    """Return a recording with known parameters and AR(1) noise, and the parameters by name."""
    rng = np.random.default_rng([seed, round(1000 * correlation)])
    joint = draw_joint(rng, (), None)
    motion, _ = schedule(rng, joint, DURATION + 1.0, None)
    t = np.arange(round(DURATION * RATE)) / RATE
    q, v, a = motion(t)
    friction, truth = _friction(rng, law, joint, v)
    load = joint.inertia * a + joint.gravity * np.cos(q + joint.phase)
    noise = joint.coulomb * log_uniform(rng, 0.02, 0.05)
    frame = pl.DataFrame(
        {
            "time": t,
            "position": q,
            "velocity": v + joint.vmax * 2e-4 * rng.standard_normal(t.size),
            "acceleration": a,
            "torque": load + friction + noise * _autoregressive(rng, t.size, correlation),
            "load_torque": load,
        }
    )
    return frame, truth


def _friction(
    rng: np.random.Generator, law: str, joint: SimulatedJoint, v: Array
) -> tuple[Array, dict[str, float]]:
    dry = np.full_like(v, joint.coulomb)
    truth = {"coulomb_friction": joint.coulomb, "viscous_friction": joint.viscous}
    if law == "stribeck":
        height = joint.coulomb * rng.uniform(0.3, 0.8)
        speed, exponent = joint.vmax * log_uniform(rng, 0.03, 0.1), float(rng.uniform(1.0, 2.0))
        dry += height * np.exp(-((np.abs(v) / speed) ** exponent))
        truth |= {
            "stribeck_height": height,
            "stribeck_velocity": speed,
            "stribeck_exponent": exponent,
        }
    return dry * np.sign(v) + joint.viscous * v, truth


def _autoregressive(rng: np.random.Generator, n: int, correlation: float) -> Array:
    """Unit AR(1) noise, stationary from the start."""
    warm = 2000
    innovation = math.sqrt(1 - correlation**2) * rng.standard_normal(n + warm)
    return np.asarray(scipy.signal.lfilter([1.0], [1.0, -correlation], innovation))[warm:]


def _ordinary_intervals(
    frame: pl.DataFrame, rows: NDArray[np.bool_]
) -> dict[str, tuple[float, float]]:
    """95 % intervals of ordinary least squares with ``s^2 (X'X)^-1``."""
    v = frame["velocity"].to_numpy()[rows]
    y = (frame["torque"] - frame["load_torque"]).to_numpy()[rows]
    x = np.stack([np.sign(v), v], 1)
    best = linear.least_norm(x, y)
    variance = np.sum((y - x @ best) ** 2) / (y.size - 2) * linear.solve(x.T @ x, np.eye(2))
    half = NORMAL_95 * np.sqrt(np.diag(variance))
    names = ("coulomb_friction", "viscous_friction")
    return {
        name: (float(b - h), float(b + h)) for name, b, h in zip(names, best, half, strict=True)
    }
