"""A recording of steady-state points: the median of each run, or each row of the file."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Floats
from stribeck.recording.assembly.complete import Clock, Motion, complete
from stribeck.recording.joint.channels import Channels, Layout
from stribeck.recording.joint.loads import Loads, measured_torque, rigid_body_load
from stribeck.recording.recording import Column, Recording
from stribeck.recording.rows import quantisation_step

__all__ = ["averaged"]

_CHANNELS = ("position", "velocity", "torque", "load_torque", "friction_torque", "temperature")


def averaged(data: Channels, layout: Layout) -> Recording:
    """The recording of one point per run.

    Raises
    ------
    RecordingError
        There is no velocity, one run only, or nothing moves.
    """
    n = len(layout.run_names)
    sigma = _medians(data, layout)
    velocity, position = data.values["velocity"], data.values.get("position")
    still = np.zeros(n)
    data.columns["acceleration"] = Column(
        "acceleration", "steady runs", f"{layout.position_unit}/s2", True, 0.0, 0.0
    )
    data.notes.append(
        f"each of {n} rows is a steady-state point, acceleration zero"
        if data.prepared.settings.average == "row"
        else f"one point per run: the median of each channel over {n} runs, acceleration zero"
    )
    loads = _loads(data, layout, position, still)
    for name in _CHANNELS:
        if name in data.values and name in data.columns:
            old = data.columns[name]
            data.columns[name] = Column.of(
                name, old.source, old.unit, old.derived, data.values[name]
            )
    motion = Motion(position, velocity, still, position, velocity, still, sigma, None)
    order = np.arange(n)
    clock = Clock(
        time=order.astype(np.float64),
        segment=order,
        dt=still,
        block=order,
        block_count=n if n >= 5 else min(10, n),
        rate_hz=0.0,
        gaps=0,
    )
    # After averaging, each point is its own run.
    points = replace(layout, run=order)
    made = complete(data, points, motion, loads, clock, averaged=True)
    if not made.moving.any() and data.prepared.settings.rows != "all":
        raise RecordingError(f"{data.path}: nothing moves in any run: give a recording with motion")
    return made


def _medians(data: Channels, layout: Layout) -> float:
    """Replace each channel by its medians over the runs; returns the noise of the velocity."""
    if "velocity" not in data.values:
        raise RecordingError(
            f"{data.path}: {option('average', 'run')} needs a velocity column: name it with "
            f"{option('map', 'velocity=COLUMN')}"
        )
    n, run = len(layout.run_names), layout.run
    starts = np.flatnonzero(np.concatenate(([True], run[1:] != run[:-1])))
    parts = np.split(np.arange(len(run)), starts[1:])
    if n < 2:
        raise RecordingError(f"{data.path}: one run gives one point, at least two runs are needed")
    errors = np.array([_median_error(data.values["velocity"][part]) for part in parts])
    data.values = {
        name: np.array([float(np.median(values[part])) for part in parts])
        for name, values in data.values.items()
    }
    # The threshold separates slow runs from standing ones, and scatter grows with speed: the
    # slowest quarter of the runs tells how well a slow median is known.
    slowest = np.argsort(np.abs(data.values["velocity"]), kind="stable")[: max(1, n // 4)]
    return float(np.median(errors[slowest]))


def _median_error(values: Floats) -> float:
    """Standard error of the median of one steady run, from its robust scatter."""
    scatter = float(np.median(np.abs(values - np.median(values)))) / 0.6745
    # The scatter of a coarsely quantised channel is at least that of its steps.
    scatter = max(scatter, quantisation_step(values) / np.sqrt(12.0))
    return float(1.2533 * scatter / np.sqrt(len(values)))


def _loads(data: Channels, layout: Layout, position: Floats | None, still: Floats) -> Loads:
    torque, load = measured_torque(data)
    if load is None:
        load = rigid_body_load(data, position, still, layout.torque_unit, smooth=False)
    if load is None and position is None:
        # Steady points without a position identify neither inertia nor gravity.
        load = still
        data.notes.append(
            "steady runs without position or load: all of the torque is taken as friction"
        )
    return Loads(torque, load, load)
