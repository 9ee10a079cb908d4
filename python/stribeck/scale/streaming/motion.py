"""Position, velocity and acceleration of a window."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.recording.acceleration_filter import AccelerationFilter, Derivable
from stribeck.recording.derive import Smoother
from stribeck.recording.joint.channels import Channels

__all__ = ["MotionChannels"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MotionChannels:
    """The channels of a recording's motion, arrays [n]; see `stribeck.recording.Recording`."""

    position: Array | None
    position_smooth: Array | None
    velocity: Array
    velocity_smooth: Array
    acceleration: Array
    acceleration_smooth: Array

    @classmethod
    def recorded(cls, data: Channels) -> MotionChannels:
        """Return the channels as recorded, for models that need no smooth or derived ones.

        An acceleration that is not in the files is NaN, so that it cannot be used by mistake.
        """
        position, velocity = data.values.get("position"), data.values["velocity"]
        missing = np.broadcast_to(np.nan, velocity.shape)
        acceleration = data.values.get("acceleration", missing)
        return cls(position, position, velocity, velocity, acceleration, acceleration)

    @classmethod
    def filtered(
        cls, data: Channels, smoother: Smoother, accelerated: AccelerationFilter
    ) -> MotionChannels:
        """Return the recorded or derived channels, and their smooth versions.

        Parameters
        ----------
        smoother
            With the cut-off found on the sample.
        accelerated
            The filter of a derived acceleration.
        """
        values = data.values
        position = values.get("position")
        if "velocity" in values:
            source, derivative = values["velocity"], 1
            velocity, velocity_smooth = source, smoother.smooth(source)
        else:
            source, derivative = values["position"], 2
            velocity = velocity_smooth = smoother.smooth(source, 1)
        if "acceleration" in values:
            acceleration = values["acceleration"]
            acceleration_smooth = smoother.smooth(acceleration)
        else:
            acceleration = accelerated.derived(
                Derivable(smoother.time, smoother.segment, source, derivative, velocity_smooth)
            )
            acceleration_smooth = acceleration
        return cls(
            position=position,
            position_smooth=None if position is None else smoother.smooth(position),
            velocity=velocity,
            velocity_smooth=velocity_smooth,
            acceleration=acceleration,
            acceleration_smooth=acceleration_smooth,
        )
