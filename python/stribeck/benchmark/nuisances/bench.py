"""The channels of a recording on their way from the joint to the file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base import low_pass
from stribeck.benchmark.draws import root_mean_square
from stribeck.benchmark.sample import Oracle, Sample

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bench:
    """Channels of a recording, and the torque of the best possible model through the same chain.

    Attributes
    ----------
    channels : dict of arrays [n]
        The columns of the recording.
    oracle : Oracle
        A nuisance that acts on the torque acts on this too, so that the oracle knows it.
    noise
        RMS of the noise of the torque.
    """

    channels: Mapping[str, Array]
    oracle: Oracle
    noise: float

    @classmethod
    def of(cls, sample: Sample) -> Bench:
        """The bench of a recording as generated."""
        return cls(
            {name: sample.frame[name].to_numpy() for name in sample.frame.columns},
            sample.oracle,
            float(sample.truth["noise_rms"]),
        )

    def __getitem__(self, channel: str) -> Array:
        """One channel [n]."""
        return self.channels[channel]

    @property
    def dt(self) -> float:
        """Sampling period, s."""
        return float(np.median(np.diff(self["time"])))

    @property
    def unknown(self) -> float:
        """RMS of the torque without the recorded load torque."""
        return root_mean_square(self["torque"] - self["load_torque"])

    def with_channels(self, **channels: Array) -> Bench:
        """The same with other values in some channels."""
        made = replace(self, channels={**self.channels, **channels})
        oracle = self.oracle
        for added in made._errors_of_friction(self):
            oracle = oracle.with_nuisance(added)
        return replace(made, oracle=oracle)

    def _errors_of_friction(self, exact: Bench) -> list[Array]:
        """What the channels of `exact` add to the torque of load and friction of these."""
        load, v, heat = (self[c] - exact[c] for c in ("load_torque", "velocity", "temperature"))
        turned = np.sign(self["velocity"]) - np.sign(exact["velocity"])
        direction, speed = np.sign(exact["velocity"]), exact["velocity"]
        return [c for c in (load, turned, v, heat * direction, heat * speed) if c.any()]

    def torque_through(self, chain: Callable[[Array], Array]) -> Bench:
        """The same with the torque, as recorded and as predicted, through a measuring `chain`."""
        made = self.with_channels(torque=chain(self["torque"]))
        return replace(made, oracle=self.oracle.through(chain))

    def kept(self, rows: NDArray[np.bool_]) -> Bench:
        """The same with some of the rows, bool [n]."""
        return replace(
            self,
            channels={name: values[rows] for name, values in self.channels.items()},
            oracle=self.oracle.kept(rows),
        )

    def sample(self, truth: Mapping[str, object]) -> Sample:
        """The recording with its `truth`."""
        return Sample(pl.DataFrame(dict(self.channels)), dict(truth), self.oracle)


#: What a bench adds to a recording; random quantities come from the generator.
Nuisance: TypeAlias = Callable[[Bench, np.random.Generator], Bench]


def first_order(values: Array, dt: float, lag: float) -> Array:
    """Low-pass filter of first order with the time constant `lag`, at rest before the start."""
    steps = np.full_like(values, dt)
    return low_pass.first_order(values - values[0], steps, lag) + values[0]
