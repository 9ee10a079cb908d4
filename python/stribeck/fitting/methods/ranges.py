"""Ranges of parameters as a unit box: logarithmic where a range is positive."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.scaling import bounds
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Ranges:
    """From `lower` to `upper`, arrays [p]; a parameter with equal ends is held.

    Examples
    --------
    >>> ranges = Ranges(np.array([0.01, -1.0]), np.array([1.0, 3.0]))
    >>> ranges.at(np.array([0.5, 0.5]))
    array([0.1, 1. ])
    >>> ranges.share(np.array([0.1, 1.0]))
    array([0.5, 0.5])
    """

    lower: Array
    upper: Array

    @classmethod
    def of(cls, model: Model, recording: Recording) -> Ranges:
        """The catalog's bounds on a recording; parameters that a law holds stay at their start."""
        lower, upper, start = bounds(model, recording)
        held = np.array([p.role == "held" for p in model.parameters], dtype=bool)
        return cls(np.where(held, start, lower), np.where(held, start, upper))

    def at(self, share: Array) -> Array:
        """Values at `share` (0..1) of the range, array [p]."""
        with np.errstate(divide="ignore", invalid="ignore"):
            geometric = self.lower * (self.upper / self.lower) ** share
        straight = self.lower + share * (self.upper - self.lower)
        return np.clip(np.where(self.lower > 0, geometric, straight), self.lower, self.upper)

    def share(self, values: Array) -> Array:
        """Share (0..1) of the range at which `values` are, array [p]; 0 if held."""
        with np.errstate(divide="ignore", invalid="ignore"):
            geometric = np.log(values / self.lower) / np.log(self.upper / self.lower)
            straight = (values - self.lower) / (self.upper - self.lower)
        way = np.where(self.lower > 0, geometric, straight)
        return np.where(self.upper > self.lower, np.clip(way, 0.0, 1.0), 0.0)
