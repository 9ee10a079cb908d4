"""Test vectors: random cycles over a model's operating box, and their torque."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import SpecError, option
from stribeck.exporters.precision import Precision
from stribeck.exporters.program import Program
from stribeck.models.channels import ChannelArguments
from stribeck.models.model import Model

#: Sides of channels that neither the given box nor the model has.
_USUAL: dict[str, tuple[float, float]] = {
    "velocity": (-2.0, 2.0),
    "position": (-math.pi, math.pi),
    "acceleration": (-10.0, 10.0),
    "temperature": (20.0, 50.0),
    "temperature_rate": (-0.1, 0.1),
    "load_torque": (-10.0, 10.0),
    "motor_torque": (-15.0, 15.0),
    "external_torque": (-10.0, 10.0),
    "load_torque_curvature": (-100.0, 100.0),
}

#: Lengths of a cycle, s.
_STEPS = (2e-3, 1e-3, 5e-4)

#: Cycles of a test vector file.
ROWS = 500


@dataclass(frozen=True)
class Vectors:
    """Consecutive cycles that start from the initial state.

    Attributes
    ----------
    dt : array [n]
        Lengths of the cycles, s.
    channels : dict of array [n]
        SI units and degC.
    torque : array [n]
        Torque at the end of each cycle as the core computes it, N m or N.
    """

    dt: NDArray[np.float64]
    channels: Mapping[str, NDArray[np.float64]]
    torque: NDArray[np.float64]

    @property
    def rows(self) -> list[list[float]]:
        """``dt``, the channels, the torque: one list a cycle."""
        columns = [self.dt, *self.channels.values(), self.torque]
        return [[float(x) for x in row] for row in zip(*columns, strict=True)]


def vectors(
    model: Model,
    program: Program,
    box: Mapping[str, tuple[float, float]],
    precision: Precision,
    rows: int = ROWS,
    seed: int = 0,
) -> Vectors:
    """Cycles over the whole operating box: smooth motion, reversals, rest and jumps.

    Parameters
    ----------
    box
        Sides by channel, SI units and degC; others are those of the model, or usual ones.

    Raises
    ------
    SpecError
        The model cannot be evaluated there.
    """
    rng = np.random.default_rng(seed)
    form = np.float32 if precision == "f32" else np.float64
    channels = {
        name: waveform(side(model, name, box), rows, rng).astype(form).astype(np.float64)
        for name in program.channels
    }
    dt = cycles(rows, rng).astype(form).astype(np.float64)
    friction = model.without_effect("delay")
    # The core wants a column for what the model names, also where that has no influence.
    read: ChannelArguments = {
        name: channels.get(name, np.zeros(rows)) for name in friction.core.needs
    }
    try:
        torque = friction.core.torque(
            friction.values,
            dt if friction.has_state else None,
            **read,
            single=precision == "f32",
        )
    except ValueError as error:
        raise SpecError(f"{model.spec} has no test vectors: {error}") from None
    unbounded = np.flatnonzero(~np.isfinite(torque))
    if unbounded.size:
        raise SpecError(
            f"{model.spec} has no finite torque at {_point(channels, int(unbounded[0]))}: "
            f"give {option('box')} in which it has"
        )
    return Vectors(dt, channels, np.asarray(torque))


def _point(channels: Mapping[str, NDArray[np.float64]], row: int) -> str:
    return ", ".join(f"{name} = {column[row]:.4g}" for name, column in channels.items())


def cycles(rows: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """Lengths of cycles, s; the same for 25 in a row."""
    return np.repeat(rng.choice(_STEPS, size=-(-rows // 25)), 25)[:rows]


def side(model: Model, channel: str, box: Mapping[str, tuple[float, float]]) -> tuple[float, float]:
    """The range of a channel: as given, of the model, or a usual one."""
    constants = model.core.constants
    if channel in box:
        return box[channel]
    if channel in model.box:
        return model.box[channel]
    if channel == "time":
        return 0.0, constants.get("duration", 3600.0)
    return _USUAL[channel]


def waveform(
    within: tuple[float, float], rows: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Values of a channel: a slow wave, a fast one, rest, and jumps over its whole side."""
    low, high = within
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    time = np.arange(rows)
    wave = middle + half * np.sin(2.0 * np.pi * time / rng.uniform(60.0, 90.0))
    wave[rows // 3 :] = middle + 0.1 * half * np.sin(time[rows // 3 :] / rng.uniform(2.0, 5.0))
    still = slice(rows // 2, rows // 2 + rows // 25)
    wave[still] = 0.0 if low <= 0.0 <= high else middle
    jumps = slice(2 * rows // 3, rows)
    wave[jumps] = rng.uniform(low, high, size=wave[jumps].size)
    return np.clip(wave, low, high)
