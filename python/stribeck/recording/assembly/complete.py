"""What sampled and averaged recordings have in common: from checked channels to a `Recording`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.base.errors import option
from stribeck.recording.acceleration_filter import AccelerationFilter
from stribeck.recording.arrays import Floats, Ints, bools, floats, floats_or_none, ints
from stribeck.recording.joint.channels import Channels, Layout
from stribeck.recording.joint.loads import Loads
from stribeck.recording.recording import Recording
from stribeck.recording.rows import SIGMAS, predictable

__all__ = ["Clock", "Motion", "complete"]

#: A lower threshold is proposed if it scores so many times as many samples.
_MORE = 2.0


@dataclass(frozen=True)
class Motion:
    """Motion of one joint, arrays [n].

    Attributes
    ----------
    velocity_noise
        Standard deviation of the noise of the velocity.
    cutoff_hz
        Of the low-pass that made the smooth arrays; None: they are the measured ones.
    noise_left
        Standard deviation of the noise that a low-pass leaves in the velocity; None without one.
    acceleration_filter
        Behind which the acceleration was derived; None: it was recorded.
    """

    position: Floats | None
    velocity: Floats
    acceleration: Floats
    position_smooth: Floats | None
    velocity_smooth: Floats
    acceleration_smooth: Floats
    velocity_noise: float
    cutoff_hz: float | None
    noise_left: float | None = None
    acceleration_filter: AccelerationFilter | None = None


@dataclass(frozen=True)
class Clock:
    """Times and segments of the samples, arrays [n]; see `Recording`."""

    time: Floats
    segment: Ints
    dt: Floats
    block: Ints
    block_count: int
    rate_hz: float
    gaps: int


def complete(
    data: Channels, layout: Layout, motion: Motion, loads: Loads, clock: Clock, *, averaged: bool
) -> Recording:
    """The recording, with read-only arrays and the samples that are scored."""
    speed = np.abs(motion.velocity)
    threshold = max(SIGMAS * motion.velocity_noise, 1e-6 * float(speed.max()))
    given = data.prepared.settings.moving_above
    if given is not None:
        threshold = given
        data.notes.append(
            f"samples faster than {given:g} {layout.position_unit}/s move, as given (five times "
            f"the noise of the velocity is {SIGMAS * motion.velocity_noise:.3g})"
        )
    elif motion.noise_left is not None:
        _propose(data, layout, speed, threshold, SIGMAS * motion.noise_left)
    moving = predictable(motion.velocity, motion.velocity_smooth, clock.segment, threshold)
    return Recording(
        path=data.path,
        sha256=data.prepared.source.sha256,
        joint=layout.joint,
        joint_kind=layout.joint_kind,
        torque_unit=layout.torque_unit,
        position_unit=layout.position_unit,
        time=floats(clock.time),
        segment=ints(clock.segment),
        run=ints(layout.run),
        run_names=layout.run_names,
        dt=floats(clock.dt),
        position=floats_or_none(motion.position),
        velocity=floats(motion.velocity),
        acceleration=floats(motion.acceleration),
        torque=floats(loads.torque),
        load_torque=floats_or_none(loads.load),
        temperature=floats_or_none(data.values.get("temperature")),
        position_smooth=floats_or_none(motion.position_smooth),
        velocity_smooth=floats(motion.velocity_smooth),
        acceleration_smooth=floats(motion.acceleration_smooth),
        load_torque_smooth=floats_or_none(loads.load_smooth),
        columns=data.columns,
        notes=tuple(data.notes),
        velocity_noise=float(motion.velocity_noise),
        velocity_threshold=float(threshold),
        moving=bools(moving),
        block=ints(clock.block),
        block_count=clock.block_count,
        rate_hz=clock.rate_hz,
        gaps=clock.gaps,
        rows_dropped=layout.rows_dropped,
        averaged=averaged,
        cutoff_hz=motion.cutoff_hz,
        acceleration_filter=motion.acceleration_filter,
        weight=floats_or_none(data.values.get("weight")),
        motor=dict(data.prepared.settings.mechanics.motor),
    )


def _propose(data: Channels, layout: Layout, speed: Floats, threshold: float, lower: float) -> None:
    """Note that the noise of the velocity hides motion which the filtered velocity shows."""
    scored, more = (float(np.mean(speed > bound)) for bound in (threshold, lower))
    if more > _MORE * scored:
        unit, do = f"{layout.position_unit}/s", option("moving_above", float(f"{lower:.2g}"))
        data.notes.append(
            f"only {100 * scored:.2g} % of the samples are scored, those faster than five times "
            f"the noise of the velocity ({threshold:.2g} {unit}); the low-pass leaves less noise "
            f"(five times: {lower:.2g} {unit}): {do} scores {100 * more:.2g} %"
        )
