"""Fits whose residual is chosen, so that a rule can be held against its definition."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import cast

import numpy as np
from numpy.typing import NDArray
from stribeck.fitting.result import Fit

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Moved:
    """A recording by the channels that are read here; what is not given is zero or absent."""

    velocity: Array
    time: Array = None  # type: ignore[assignment]
    torque: Array = None  # type: ignore[assignment]
    dt: Array = None  # type: ignore[assignment]
    position: Array | None = None
    acceleration: Array | None = None
    temperature: Array | None = None
    load_torque: Array | None = None
    enabled: NDArray[np.bool_] | None = None
    segment: NDArray[np.intp] = None  # type: ignore[assignment]
    block: NDArray[np.intp] = None  # type: ignore[assignment]
    averaged: bool = False
    rate_hz: float = 1.0
    joint_kind: str = "prismatic"

    @property
    def rows(self) -> int:
        """Number of samples."""
        return self.velocity.size

    def __post_init__(self) -> None:
        size = self.velocity.size
        for name, value in (
            ("time", np.arange(size, dtype=np.float64)),
            ("torque", np.zeros(size)),
            ("dt", np.zeros(size)),
            ("segment", np.zeros(size, dtype=np.intp)),
            ("block", np.zeros(size, dtype=np.intp)),
        ):
            if getattr(self, name) is None:
                object.__setattr__(self, name, value)

    @property
    def moving(self) -> NDArray[np.bool_]:
        """Every sample but those at rest."""
        return self.velocity != 0.0

    @property
    def known_torque(self) -> Array:
        """No part of the torque is known."""
        return np.zeros(self.velocity.size)


@dataclass(frozen=True)
class Unit:
    """A model by its units."""

    torque_unit: str = "N m"
    position_unit: str = "m"


@dataclass(frozen=True)
class Left:
    """A fit by what it leaves. Held out it leaves the same, unless something else is given."""

    recording: Moved
    residual: Array
    held_out_residual: Array = None  # type: ignore[assignment]
    transient: NDArray[np.bool_] = None  # type: ignore[assignment]
    rmse: float = np.inf
    load: Array | None = None
    model: Unit = field(default_factory=Unit)

    def __post_init__(self) -> None:
        if self.held_out_residual is None:
            object.__setattr__(self, "held_out_residual", self.residual)
        if self.transient is None:
            object.__setattr__(self, "transient", np.zeros(self.residual.size, dtype=bool))

    @property
    def scored(self) -> NDArray[np.bool_]:
        """The samples in motion: none is in doubt."""
        return self.recording.moving

    @property
    def rows(self) -> NDArray[np.intp]:
        """The samples in motion, without transients."""
        return np.flatnonzero(self.recording.moving & ~self.transient)


def left(recording: Moved, residual: Array, **fields: object) -> Fit:
    """A fit of `recording` that leaves `residual`."""
    return cast("Fit", Left(recording, residual, **fields))  # type: ignore[arg-type]
