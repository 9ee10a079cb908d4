"""What is measured on: a motion through slow and fast speeds, its torque, models with values."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import polars as pl
import stribeck as sb
from stribeck.motion.generate.motion import JOINTS
from stribeck.motion.generate.plausible import plausible_values

DT = 0.002
#: Standard deviation of the torque's noise, N m.
NOISE = 0.3
JOINT = JOINTS["revolute"]


def channels(samples: int) -> dict[str, Any]:
    """All that a law may read, arrays [samples]."""
    time = DT * np.arange(samples)
    velocity = 0.9 * np.sin(0.7 * time) * np.cos(0.11 * time) + 0.05 * np.sin(6.1 * time)
    position = np.cumsum(velocity) * DT
    return {
        "velocity": velocity,
        "position": position,
        "acceleration": np.gradient(velocity, DT),
        "temperature": 25.0 + 10.0 * np.sin(0.01 * time),
        "load_torque": 20.0 * np.sin(position),
    }


def valued(law: str) -> sb.Model:
    """A law with values of a usual size."""
    model = sb.model(law)
    values = plausible_values(model, JOINT, np.random.default_rng(0))
    return model.with_values([values[name] for name in model.names])


def recording(law: str, samples: int) -> sb.Recording:
    """A recording whose torque is that of a law, with noise."""
    columns = channels(samples)
    torque = valued(law).torque(**columns, dt=DT)
    noise = NOISE * np.random.default_rng(1).standard_normal(samples)
    table = pl.DataFrame(
        {"time": DT * np.arange(samples), **columns, "friction_torque": torque + noise}
    )
    with TemporaryDirectory() as folder:
        path = Path(folder) / "log.parquet"
        table.write_parquet(path)
        return sb.read(path, joint_kind="revolute")
