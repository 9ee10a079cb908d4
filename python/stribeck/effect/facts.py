"""What the effects look at in a recording, over its scored samples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Both directions count as present if each has this share of the scored samples.
BOTH_DIRECTIONS = 0.05


@dataclass(frozen=True)
class RecordingFacts:
    """What a recording holds.

    Attributes
    ----------
    load : array [n] or None
        Load torque of every sample: recorded, or else identified with the friction.
    velocity, speed : arrays [m]
        Of the scored samples.
    forward
        Share of the scored samples that move forward.
    reversals
        Changes of direction within a segment.
    """

    recording: Recording
    load: Array | None
    velocity: Array
    forward: float
    speed: Array
    reversals: int

    @classmethod
    def of(cls, recording: Recording, load: Array | None) -> RecordingFacts:
        """The facts of a recording; `load` [n] is used where it holds no load torque."""
        v = recording.velocity[recording.moving]
        return cls(
            recording=recording,
            load=recording.load_torque if recording.load_torque is not None else load,
            velocity=v,
            forward=float(np.mean(v > 0)) if v.size else 0.0,
            speed=np.abs(v),
            reversals=sign_changes(recording, v),
        )

    @property
    def both_directions(self) -> bool:
        """Whether the joint moves in both directions."""
        return BOTH_DIRECTIONS <= self.forward <= 1.0 - BOTH_DIRECTIONS

    @property
    def top_speed(self) -> float:
        """99th percentile of the speed."""
        return float(np.quantile(self.speed, 0.99))

    def scored(self, column: Array | None) -> Array | None:
        """A column [n] on the scored samples; None where the recording has none."""
        return None if column is None else column[self.recording.moving]


def sign_changes(recording: Recording, values: Array) -> int:
    """How often `values` [m], on the scored samples, change their sign within a segment."""
    changed = np.diff(np.sign(values)) != 0
    within = np.diff(recording.segment[recording.moving]) == 0
    return int(np.count_nonzero(changed & within))


def spread(values: Array) -> float:
    """From the 1st to the 99th percentile."""
    low, high = np.quantile(values, [0.01, 0.99])
    return float(high - low)
