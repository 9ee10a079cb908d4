"""A load torque of another acceleration than the motion's is computed from the motion."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt
from synthetic import COULOMB, VISCOUS, motion, record

Array = NDArray[np.float64]

#: Inertia in kg m2 and weight in N m; samples a second, and how many; noise of the torque in N m.
INERTIA, WEIGHT, RATE, ROWS, NOISE = 0.8, 4.0, 200.0, 8000, 0.02


def accelerations(seed: int = 2) -> tuple[Array, Array, Array, Array, Array]:
    """Time, position, velocity, and acceleration of the reference and of the joint.

    The joint follows the reference but for sines between 4 and 11 Hz.
    """
    t, q, v, wanted = motion(ROWS, RATE)
    rng = np.random.default_rng(seed)
    a = wanted.copy()
    for frequency in np.linspace(4.0, 11.0, 9):
        w, phase = 2.0 * np.pi * frequency, rng.uniform(0.0, 2.0 * np.pi)
        # About 0.15 rad/s2 each, more and less over time.
        size = 0.15 / w**2 * (1.0 + 0.5 * np.sin(0.3 * t + phase))
        q = q + size * np.sin(w * t + phase)
        v = v + size * w * np.cos(w * t + phase)
        a = a - size * w**2 * np.sin(w * t + phase)
    return t, q, v, wanted, a


def recorded(load_acceleration: Array, extra: Array | float = 0.0, inertia: float = INERTIA):
    """A recording whose load torque has another acceleration than the joint."""
    t, q, v, _, a = accelerations()
    rng = np.random.default_rng(5)
    gravity = WEIGHT * np.sin(q + 0.2)
    friction = COULOMB * np.sign(v) + VISCOUS * v
    return pl.DataFrame(
        {
            "time": t,
            "position": q,
            "velocity": v + 1e-4 * rng.standard_normal(ROWS),
            "torque": inertia * a + gravity + friction + extra + NOISE * rng.standard_normal(ROWS),
            "load_torque": INERTIA * load_acceleration + gravity,
        }
    )


def is_mended(recording: sb.Recording) -> bool:
    return any("that of another acceleration than the motion's" in n for n in recording.notes)


def filtered(a: Array) -> Array:
    return sosfiltfilt(butter(4, 5.0, fs=RATE, output="sos"), a)


@pytest.mark.parametrize("source", ["reference", "filter"])
def test_the_motion_gives_the_load_torque(tmp_path: Path, source: str) -> None:
    _, q, _, wanted, a = accelerations()
    frame = recorded(wanted if source == "reference" else filtered(a))
    mended = record(tmp_path, frame)
    assert is_mended(mended)
    (said,) = re.findall(r"its inertia, ([0-9.]+) kg m2", " ".join(mended.notes))
    assert float(said) == pytest.approx(INERTIA, rel=0.01)
    assert mended.columns["load_torque"].derived
    truth = INERTIA * a + WEIGHT * np.sin(q + 0.2)
    assert mended.load_torque is not None
    inside = slice(50, -50)
    off = (mended.load_torque - truth)[inside].std()
    assert off < 0.2 * (frame["load_torque"].to_numpy() - truth)[inside].std()
    kept = record(tmp_path, frame, "trusted", trust=True)
    assert not is_mended(kept)
    np.testing.assert_array_equal(kept.load_torque, frame["load_torque"])
    assert sb.fit("coulomb", mended).rmse < 0.5 * sb.fit("coulomb", kept).rmse


def test_a_load_torque_of_the_motion_stays(tmp_path: Path) -> None:
    *_, a = accelerations()
    frame = recorded(a)
    recording = record(tmp_path, frame)
    assert not is_mended(recording)
    np.testing.assert_array_equal(recording.load_torque, frame["load_torque"])


def test_a_load_torque_that_the_motor_needs_stays(tmp_path: Path) -> None:
    """What differs is the pull of another joint: it is in the torque too."""
    t, *_, a = accelerations()
    pull = 0.3 * np.sin(2.0 * np.pi * 3.1 * t) * np.sin(0.2 * t)
    frame = recorded(a, pull).with_columns(pl.col("load_torque") + pull)
    assert not is_mended(record(tmp_path, frame))


def test_a_wrong_inertia_stays(tmp_path: Path) -> None:
    *_, a = accelerations()
    recording = record(tmp_path, recorded(a, inertia=1.1 * INERTIA))
    assert not is_mended(recording)
    found = sb.diagnose(sb.fit("coulomb", recording))
    assert found.findings[0].effect == "inertia"


def test_nothing_is_named_beside_a_load_torque_of_the_reference(tmp_path: Path) -> None:
    *_, wanted, _ = accelerations()
    frame = recorded(wanted)
    mended = sb.diagnose(sb.fit("coulomb", record(tmp_path, frame)))
    kept = sb.diagnose(sb.fit("coulomb", record(tmp_path, frame, "trusted", trust=True)))
    for found in (mended, kept):
        assert not [f.effect for f in found.findings if f.confidence > 0.9]
