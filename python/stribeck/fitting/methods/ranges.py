"""Ranges of parameters as a unit box: logarithmic where a range is positive."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.scaling import scaled_parameters
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
        """The ranges of random starts on a recording, and the bounds of linear parameters.

        Parameters that a law holds stay at their start.
        """
        rows = scaled_parameters(model, recording)
        ends = [
            (p.start, p.start) if p.role == "held" else (p.lower, p.upper) if p.linear else p.drawn
            for p in rows
        ]
        lower, upper = np.array(ends, dtype=np.float64).reshape(-1, 2).T
        return cls(lower, upper)

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
