"""A recording of samples in time: derived channels, segments and held-out blocks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.recording.acceleration_filter import AccelerationFilter, Derivable, filter_text
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.assembly.accelerated import accelerated
from stribeck.recording.assembly.complete import Clock, Motion, complete
from stribeck.recording.derive import Smoother, choose_cutoff
from stribeck.recording.joint.channels import Channels, Layout
from stribeck.recording.joint.loads import Loads, measured_torque, rigid_body_load
from stribeck.recording.joint.units import natural_unit
from stribeck.recording.mend.late_velocity import Moved, late, note, torque_follows
from stribeck.recording.mend.load_of_motion import differing, slow_motion
from stribeck.recording.mend.load_of_motion import note as load_note
from stribeck.recording.mend.load_of_motion import torque_follows as follows_motion
from stribeck.recording.motion.derived_motion import acceleration_cutoff, filtered_noise, slope
from stribeck.recording.recording import Column, Recording
from stribeck.recording.rows import (
    SIGMAS,
    held_out_blocks,
    noise_level,
    segment_rows,
    segment_slices,
    slope_noise,
)

__all__ = ["sampled"]


@dataclass(frozen=True)
class _Smoothers:
    """Low-passes: of velocity, and of an acceleration that is derived."""

    velocity: Smoother
    acceleration: Smoother | None


def sampled(data: Channels, layout: Layout) -> Recording:
    """The recording of channels sampled in time."""
    time = data.values["time"]
    segment, dt, typical = segment_rows(time, layout.run, data.sequence)
    motion, smoothers = _motion(data, layout, segment, typical)
    loads = _loads(data, layout, motion, smoothers)
    block, count = held_out_blocks(dt, segment, layout.run, typical)
    clock = Clock(
        time=time,
        segment=segment,
        dt=dt,
        block=block,
        block_count=count,
        rate_hz=1.0 / typical if typical > 0.0 else 0.0,
        gaps=len(segment_slices(segment)) - len(layout.run_names),
    )
    return complete(data, layout, motion, loads, clock, averaged=False)


def _motion(
    data: Channels, layout: Layout, segment: Ints, typical: float
) -> tuple[Motion, _Smoothers]:
    """Position, velocity and acceleration, derived where they were not recorded."""
    time = data.values["time"]
    position, velocity = data.values.get("position"), data.values.get("velocity")
    acceleration = data.values.get("acceleration")
    sigma = None if velocity is None else noise_level(time, velocity, segment)
    if velocity is not None and _is_replaced(data, segment, typical, SIGMAS * float(sigma or 0.0)):
        velocity = acceleration = None
    if velocity is not None:
        cutoff = choose_cutoff(time, velocity, segment, 1)
        smoother = Smoother(time, segment, cutoff)
        velocity_smooth = smoother.smooth(velocity)
        source, derivative = velocity, 1
        left = None
    else:
        assert position is not None
        step = typical if typical > 0.0 else float(np.median(np.diff(time)))
        velocity, cutoff = slope(time, position, segment)
        left = filtered_noise(noise_level(time, position, segment), step, cutoff)
        if sigma is None:
            sigma = slope_noise(time, position, segment, step)
        else:
            # Scored are the samples that both velocities show moving.
            sigma = max(sigma, left or 0.0)
        velocity_smooth = velocity
        smoother = Smoother(time, segment, cutoff)
        source, derivative = position, 2
        unit = f"{layout.position_unit}/s"
        data.columns["velocity"] = Column.of("velocity", "position", unit, True, velocity)
        data.notes.append(f"velocity derived from position, {filter_text(cutoff)}")
    derived: Smoother | None = None
    filtered: AccelerationFilter | None = None
    if acceleration is None:
        usual = acceleration_cutoff(time, velocity, segment, typical, cutoff)
        known = Derivable(time, segment, source, derivative, velocity_smooth)
        noise = float(sigma or 0.0)
        filtered, acceleration = accelerated(data, layout, known, velocity, noise, usual)
        derived = Smoother(time, segment, filtered.cutoff)
        acceleration_smooth = acceleration
    else:
        acceleration_smooth = smoother.smooth(acceleration)
    position_smooth = None if position is None else smoother.smooth(position)
    motion = Motion(
        position,
        velocity,
        acceleration,
        position_smooth,
        velocity_smooth,
        acceleration_smooth,
        float(sigma or 0.0),
        cutoff,
        left,
        filtered,
    )
    return motion, _Smoothers(smoother, derived)


def _is_replaced(data: Channels, segment: Ints, period: float, threshold: float) -> bool:
    """Whether the position gives the velocity in place of a recorded one, which is late; noted.

    Parameters
    ----------
    period, threshold
        Median sampling period, s; speed above which samples move.
    """
    lag = late(data, segment, period)
    if lag is None:
        return False
    time, position, velocity = (data.values[name] for name in ("time", "position", "velocity"))
    derived, cutoff = slope(time, position, segment)
    smoother = Smoother(time, segment, cutoff)
    by_position = Moved(derived, smoother.smooth(position, 2))
    recorded = Moved(velocity, smoother.smooth(velocity, 1))
    if not torque_follows(data, by_position, recorded, threshold, segment):
        return False
    data.notes.append(note(lag, period))
    return True


def _loads(data: Channels, layout: Layout, motion: Motion, smoothers: _Smoothers) -> Loads:
    torque, load = measured_torque(data)
    kind = layout.joint_kind
    if load is not None:
        load = _of_motion(data, layout, motion, smoothers, torque, load)
        return Loads(torque, load, smoothers.velocity.smooth(load))
    unit = layout.torque_unit if data.prepared.settings.drive is None else natural_unit(kind)
    load = rigid_body_load(data, motion.position, motion.acceleration, unit, smooth=False)
    smooth: Floats | None = None
    if load is not None:
        smooth = rigid_body_load(
            data, motion.position_smooth, motion.acceleration_smooth, unit, smooth=True
        )
    return Loads(torque, load, smooth)


def _of_motion(
    data: Channels,
    layout: Layout,
    motion: Motion,
    smoothers: _Smoothers,
    torque: Floats,
    load: Floats,
) -> Floats:
    """The load torque with the acceleration of the motion, where the torque follows that; noted."""
    settings = data.prepared.settings
    if settings.trust or settings.drive is not None or "torque" not in data.values:
        return load
    moving = np.abs(motion.velocity_smooth) > SIGMAS * motion.velocity_noise
    position = motion.position if layout.joint_kind == "revolute" else None
    alike = load if smoothers.acceleration is None else smoothers.acceleration.smooth(load)
    time, segment = smoothers.velocity.time, smoothers.velocity.segment
    slow = slow_motion(time, motion.velocity, segment)
    found = differing(alike, motion.acceleration, position, moving, slow.smooth)
    if found is None:
        return load
    if not follows_motion(found, torque, load, motion.velocity, position, moving):
        return load
    unit = "kg m2" if layout.joint_kind == "revolute" else "kg"
    data.notes.append(load_note(found.inertia, unit))
    given, mended = data.columns["load_torque"], load - found.torque
    source = f"{given.source} and the motion"
    data.columns["load_torque"] = Column.of("load_torque", source, given.unit, True, mended)
    return mended
