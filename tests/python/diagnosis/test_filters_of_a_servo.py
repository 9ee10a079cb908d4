"""A servo that lacks nothing, whose channels are behind different filters.

Of all that they leave, a late torque is the one cause that may be named with confidence: no drive
train, no gain, no spring.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from scipy.signal import butter, filtfilt, lfilter
from synthetic import Array, record

RATE, SECONDS = 250.0, 60.0
#: Inertia in kg m2, weight and Coulomb friction in N m, viscous friction in N m s/rad.
INERTIA, WEIGHT, COULOMB, VISCOUS = 0.01, 0.45, 0.06, 0.03
#: Step of the encoder in rad; of the current, as a torque, and noise in N m.
STEP, CURRENT, NOISE = 2.0 * np.pi / 4096, 0.00404, 0.004


def behind(values: Array, tau: float) -> Array:
    """`values` behind a filter of first order with the time constant `tau`, s."""
    keep = np.exp(-1.0 / (RATE * tau))
    return np.asarray(lfilter([1.0 - keep], [1.0, -keep], values, zi=[keep * values[0]])[0])


def smooth(values: Array) -> Array:
    """`values` behind a low-pass without phase."""
    return np.asarray(filtfilt(*butter(2, 25.0 / (0.5 * RATE)), values))


def sines(rng: np.random.Generator) -> tuple[Array, Array]:
    """Time, and a position of sines from 0.08 to 1.2 Hz, one after the other."""
    t = np.arange(round(SECONDS * RATE)) / RATE
    hertz = np.repeat(rng.permutation(np.geomspace(0.08, 1.2, 8)), t.size // 8 + 1)[: t.size]
    hertz = np.convolve(np.r_[np.full(125, hertz[0]), hertz], np.ones(125) / 125, "valid")[: t.size]
    w = 2.0 * np.pi * hertz
    size = np.minimum(1.2, np.minimum(4.0 / w, 30.0 / w**2))
    size = np.convolve(np.pad(size, 250, "edge"), np.ones(501) / 501, "valid")
    return t, size * np.sin(np.cumsum(w) / RATE)


def servo(seed: int) -> pl.DataFrame:
    """The servo: coarse encoder, torque 5 ms late, velocity 4 ms, load torque from the encoder."""
    rng = np.random.default_rng(seed)
    t, q = sines(rng)
    v = np.gradient(q) * RATE
    a = np.gradient(v) * RATE
    friction = COULOMB * np.tanh(v / 1e-3) + VISCOUS * v
    torque = behind(INERTIA * a + WEIGHT * np.sin(q) + friction, 0.005)
    torque = torque + NOISE * rng.standard_normal(t.size)
    seen = np.round(q / STEP) * STEP
    acceleration = smooth(np.gradient(smooth(np.gradient(seen) * RATE)) * RATE)
    return pl.DataFrame(
        {
            "time": t,
            "position": seen,
            "velocity": behind(np.diff(seen, prepend=seen[0]) * RATE, 0.004),
            "torque": np.round(torque / CURRENT) * CURRENT,
            "load_torque": INERTIA * acceleration + WEIGHT * np.sin(seen),
        }
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", [6, 11])
def test_filters_are_no_drive_train_and_no_gain(seed: int, tmp_path: Path) -> None:
    found = sb.improve("coulomb", record(tmp_path, servo(seed)))
    claimed = {s.finding.effect for s in found.steps if s.finding.confidence > 0.5}
    assert claimed <= {"delay"}
    coulomb = found.final.estimates["coulomb_friction"].value
    assert coulomb == pytest.approx(COULOMB, rel=0.05)
