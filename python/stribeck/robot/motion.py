"""Recordings of a whole robot: one recording per joint, of the same samples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import psutil
import scipy
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError, joint_called, option
from stribeck.base.low_pass import zero_phase
from stribeck.recording.load import read_with
from stribeck.recording.recording import Column, Recording
from stribeck.recording.stated.options import ReadOptions, split_pairs
from stribeck.robot.arm import Robot
from stribeck.robot.coupled import motor_columns

Array = NDArray[np.float64]

#: The filter's cut-off as a multiple of the fastest joint's bandwidth of motion.
BANDWIDTHS = 10.0
#: Position and velocity pass a low-pass so many times as fast before they are differentiated, so
#: that their accelerations are whole below the cut-off, where both sides are compared.
BEFORE = 3.0
#: Cut-offs as a share of the sampling rate at most.
FASTEST = 0.4
#: Samples whose regressor is computed at once.
STRETCH = 20_000
#: Memory for a sample, over the square of the number of joints: each has columns of all links.
BYTES = 190
#: Segments of so many samples are too short to be filtered.
SHORTEST = 30


@dataclass(frozen=True, repr=False)
class RobotMotion:
    """A motion of all joints, and their torques.

    Attributes
    ----------
    joints
        The recording of each joint, of its motor where motors are coupled; all have the same
        samples.
    position, velocity, acceleration : arrays [n, N]
        Of the joints, after the zero-phase low-pass; what the rigid bodies see.
    cutoff
        Of the low-pass that both sides of the torque balance pass, Hz.

    Examples
    --------
    >>> import numpy as np
    >>> from stribeck import read, robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, 0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]]))
    >>> run = robot.simulate_robot(arm, {}, seconds=10.0, rate=100.0)
    >>> motion = robot.RobotMotion.of(arm, [read(run)])
    >>> bodies = arm.torque(motion.position, motion.velocity, motion.acceleration)
    >>> bool(abs(motion.torque - bodies).max() < 0.01 * abs(bodies).max())
    True
    """

    robot: Robot
    joints: tuple[Recording, ...]
    position: Array
    velocity: Array
    acceleration: Array
    cutoff: float

    @classmethod
    def of(
        cls, robot: Robot, joints: Sequence[Recording], cutoff: float | None = None
    ) -> RobotMotion:
        """Join the recordings of the joints.

        Parameters
        ----------
        cutoff
            Hz; default: ten times the bandwidth of the fastest joint's motion.
        """
        first = joints[0]
        for name, recording in zip(robot.names, joints, strict=True):
            if recording.position is None:
                raise RecordingError(f"{recording.path}: {joint_called(name)} has no position")
            if not np.array_equal(recording.time, first.time):
                raise RecordingError(
                    f"{recording.path}: the joints have different samples; remove rows in which a "
                    f"value is missing with {option('where')}"
                )
        chosen = _cutoff(first.path, joints, cutoff)
        order = _Filter(first, min(BEFORE * chosen, FASTEST * first.rate_hz))
        motors = order.smooth(np.stack([np.asarray(r.position) for r in joints], axis=1))
        measured = np.stack([r.velocity for r in joints], axis=1)
        position, velocity = robot.joints_of(motors), robot.joints_of(order.smooth(measured))
        return cls(robot, tuple(joints), position, velocity, order.slope(velocity), chosen)

    def __repr__(self) -> str:
        return (
            f"<RobotMotion {self.path}: {self.rows} samples of {len(self.joints)} joints, "
            f"low-pass at {self.cutoff:.3g} Hz>"
        )

    @property
    def path(self) -> str:
        """The file or files."""
        return self.joints[0].path

    @property
    def rows(self) -> int:
        """Number of samples."""
        return int(self.joints[0].time.size)

    @cached_property
    def scored(self) -> NDArray[np.bool_]:
        """Samples at which a joint moves, bool array [n, N]."""
        return np.stack([recording.moving for recording in self.joints], axis=1)

    @cached_property
    def torque(self) -> Array:
        """Measured torques, array [n, N]."""
        return np.stack([recording.torque for recording in self.joints], axis=1)

    def regressor(self, columns: NDArray[np.intp]) -> Array:
        """Derivatives of the motors' torques by some inertial parameters, array [n, N, columns].

        By stretches of samples, so that those of all parameters are never in memory together.
        """
        made = np.empty((*self.position.shape, columns.size))
        for first in range(0, self.rows, STRETCH):
            part = slice(first, first + STRETCH)
            whole = self.robot.regressor(
                self.position[part], self.velocity[part], self.acceleration[part]
            )
            made[part] = self.robot.motor_torque(whole[:, :, columns])
        return made

    def filtered(self, values: Array, joint: int | None = None) -> Array:
        """The zero-phase low-pass of `values` [n, ...].

        With a `joint`, samples at which it rests are bridged by straight lines first: friction at
        rest is whatever holds the joint.
        """
        if joint is not None and not self.scored[:, joint].all():
            moving = np.flatnonzero(self.scored[:, joint])
            if moving.size:
                values = scipy.interpolate.interp1d(
                    moving,
                    values[moving],
                    axis=0,
                    bounds_error=False,
                    fill_value=(values[moving[0]], values[moving[-1]]),
                )(np.arange(len(values)))
        return _Filter(self.joints[0], self.cutoff).smooth(values)

    def with_load(self, joint: int, load: Array) -> Recording:
        """The recording of a joint whose load torque [n] is that of the rigid bodies."""
        recording = self.joints[joint]
        column = Column.of("load_torque", "rigid bodies", recording.torque_unit, True, load)
        return replace(
            recording,
            load_torque=load,
            load_torque_smooth=load,
            columns={**recording.columns, "load_torque": column},
            origin=None,
        )


def read_motion(
    robot: Robot,
    files: Sequence[str],
    reading: ReadOptions | None = None,
    cutoff: float | None = None,
) -> RobotMotion:
    """Read the recordings of all joints; several files are runs.

    Parameters
    ----------
    reading
        Options of `stribeck.read`; in `map`, ``{joint}`` and ``{number}`` stand for the joint.
        Without a column that depends on the joint, the file has a column ``joint``.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from stribeck.recording.stated.options import ReadOptions
    >>> import numpy as np
    >>> from stribeck import model, robot
    >>> arm = robot.from_tables("planar", [{"a": 0.4}, {"a": 0.3}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, -0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]] * 2))
    >>> friction = {
    ...     name: model("coulomb", coulomb_friction=2.0, viscous_friction=1.0) for name in arm.names
    ... }
    >>> run = robot.simulate_robot(arm, friction, seconds=20.0, rate=100.0, noise=0.01)
    >>> columns = [f"{what}={what}_{{joint}}" for what in ("position", "velocity", "torque")]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder, "run.parquet")
    ...     run.write_parquet(path)
    ...     motion = robot.read_motion(arm, [str(path)], ReadOptions(map=columns))
    >>> motion.torque.shape
    (2000, 2)
    """
    options = joint_options(robot, ReadOptions() if reading is None else reading)
    made = []
    for joint, own in zip(robot.joints, options, strict=True):
        made.append(replace(read_with(list(files), own), joint=joint.name))
        _refuse_too_many(made[0], len(robot.joints))
    return RobotMotion.of(robot, made, cutoff)


def _refuse_too_many(recording: Recording, joints: int) -> None:
    """Refuse samples whose columns would not fit into the memory that is free."""
    needed, free = BYTES * joints**2 * recording.rows, psutil.virtual_memory().available
    if needed > free:
        raise RecordingError(
            f"{recording.path}: {recording.rows} samples of {joints} joints need about "
            f"{needed / 1e9:.2g} GB of memory, {free / 1e9:.2g} GB are free: read them in passes, "
            f"with {option('stream')} (in Python `sb.stream_robot`)"
        )


def joint_options(robot: Robot, options: ReadOptions) -> list[ReadOptions]:
    """The options with which each joint is read."""
    given = {**dict(robot.columns), **dict(split_pairs("map", options.map))}
    of_joints: dict[str, list[str]] = {
        channel: [_column(given[channel], n, k) for k, n in enumerate(robot.names, start=1)]
        for channel in ("position", "velocity")
        if channel in given
    }
    made = []
    for number, joint in enumerate(robot.joints, start=1):
        names = {c: _column(text, joint.name, number) for c, text in given.items()}
        own = replace(options, map=names, joint_kind=joint.movement)
        if names == given:
            own = replace(own, joint=joint.name)
        if robot.coupling and robot.encoders == "joints":
            own = _of_motor(robot, own, number, of_joints)
        known = options.torque_constant is not None or "torque" in given
        if joint.drive_gain is not None and not known:
            own = replace(own, torque_constant=joint.drive_gain, gear_ratio=1.0)
        made.append(own)
    return made


def _of_motor(
    robot: Robot, own: ReadOptions, number: int, of_joints: Mapping[str, Sequence[str]]
) -> ReadOptions:
    """The options with which a joint is read, with the position and velocity of its motor."""
    if "position" not in of_joints:
        raise RecordingError(
            f"{robot.name}: motors of coupled joints need a column of each joint: name them with "
            f"{option('map', 'position=COLUMN')}, with {{joint}} or {{number}} in COLUMN"
        )
    named, formulas = motor_columns(robot.name, robot.coupling, number - 1, of_joints)
    unit = dict(split_pairs("unit", own.unit))
    for channel, name in named.items():
        column = of_joints[channel][number - 1]
        if column in unit:
            unit[name] = unit[column]
    return replace(
        own,
        map={**dict(split_pairs("map", own.map)), **named},
        derive={**dict(split_pairs("derive", own.derive)), **formulas},
        unit=unit,
    )


def _column(text: str, joint: str, number: int) -> str:
    """A column's name for one joint."""
    try:
        return text.format(joint=joint, number=number)
    except (KeyError, IndexError, ValueError, AttributeError):
        raise RecordingError(
            f"the column {text!r} cannot be named for a joint: {{joint}} stands for its name, "
            f"{{number}} for its number, and a brace in a name is doubled"
        ) from None


def _cutoff(path: str, joints: Sequence[Recording], given: float | None) -> float:
    """The cut-off of the low-pass, Hz."""
    rate = joints[0].rate_hz
    if given is not None:
        if not 0.0 < given < FASTEST * rate:
            raise RecordingError(
                f"{path}: {option('cutoff', given)} Hz lies outside 0 .. {FASTEST * rate:.3g} Hz, "
                f"two fifths of the sampling rate"
            )
        return given
    return default_cutoff([recording.motion_band for recording in joints], rate)


def default_cutoff(bands: Sequence[float | None], rate: float) -> float:
    """The cut-off for joints with these bandwidths of motion, Hz; None: not known."""
    fastest = max((band for band in bands if band is not None), default=0.04 * rate)
    return min(BANDWIDTHS * fastest, 0.39 * rate)


class _Filter:
    """A zero-phase low-pass of all columns, segment by segment."""

    def __init__(self, recording: Recording, cutoff: float) -> None:
        first = np.flatnonzero(np.diff(recording.segment, prepend=-1))
        self.parts = [
            slice(a, b) for a, b in zip(first, [*first[1:], recording.time.size], strict=True)
        ]
        self.time = recording.time
        self.cutoff, self.rate = cutoff, recording.rate_hz

    def smooth(self, values: Array) -> Array:
        made = np.array(values, dtype=np.float64)
        for part in self.parts:
            if part.stop - part.start > SHORTEST:
                made[part] = zero_phase(values[part].T, self.cutoff, self.rate).T
        return made

    def slope(self, values: Array) -> Array:
        """Derivative by time, by central differences of fourth order."""
        made = np.zeros_like(values)
        for part in self.parts:
            size = part.stop - part.start
            if size > 1:
                made[part] = np.gradient(values[part], self.time[part], axis=0)
            if size > 4:
                time, own = self.time[part][:, None], values[part]
                rise = 8.0 * (own[3:-1] - own[1:-3]) - (own[4:] - own[:-4])
                made[part.start + 2 : part.stop - 2] = rise / (
                    8.0 * (time[3:-1] - time[1:-3]) - (time[4:] - time[:-4])
                )
        return made
