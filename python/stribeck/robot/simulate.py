"""Simulated recordings of a robot: a motion of all joints, and the torques that it takes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.checks import check_number, check_share
from stribeck.base.errors import SpecError, listed, nearest
from stribeck.models.model import Model
from stribeck.robot.arm import Robot

Array = NDArray[np.float64]

#: Columns of a simulated recording where the robot states none.
COLUMNS = (
    ("time", "time"),
    ("position", "position_{joint}"),
    ("velocity", "velocity_{joint}"),
    ("torque", "torque_{joint}"),
)


def simulate_robot(
    robot: Robot,
    friction: Mapping[str, Model],
    *,
    seconds: float = 30.0,
    rate: float = 200.0,
    speed: float = 1.0,
    harmonics: int = 5,
    noise: float = 0.0,
    velocity_noise: float = 0.0,
    seed: int = 0,
) -> pl.DataFrame:
    """Torques of a robot that follows a random Fourier motion exactly.

    Parameters
    ----------
    friction : mapping of Model
        Friction of each joint, with values; its load is the torque of the rigid bodies.
    seconds, rate
        Duration, s, and samples per second, Hz.
    speed, harmonics
        RMS speed of a joint, rad/s or m/s, and number of harmonics of ten seconds.
    noise, velocity_noise
        Standard deviation of the torque's noise as a share of the joint's RMS torque, and of the
        velocity's noise, rad/s or m/s.

    Returns
    -------
    polars.DataFrame
        Columns `COLUMNS`, or those of the robot, for each joint.

    Examples
    --------
    >>> import numpy as np
    >>> from stribeck import model, robot
    >>> arm = robot.from_tables("planar", [{"a": 0.4}, {"a": 0.3}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, -0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]] * 2))
    >>> friction = {
    ...     name: model("coulomb", coulomb_friction=2.0, viscous_friction=1.0) for name in arm.names
    ... }
    >>> robot.simulate_robot(arm, friction, seconds=5.0, rate=100.0).columns[:4]
    ['time', 'position_1', 'velocity_1', 'torque_1']
    """
    _check(robot, friction, seconds, rate, speed, noise)
    random = np.random.default_rng(seed)
    time = np.arange(int(seconds * rate)) / rate
    q, v, a = fourier_motion(time, len(robot.joints), speed, harmonics, random)
    motors = robot.core.of_motors(q, v, a)
    load = motors[3]
    if robot.encoders == "motors":
        q, v = motors[:2]
    named = dict(robot.columns) or dict(COLUMNS)
    effort = "torque" if "torque" in named else "current"
    made = {named["time"]: time}
    for k, joint in enumerate(robot.joints):
        torque = load[:, k]
        if joint.name in friction:
            torque = torque + _friction(friction[joint.name], time, motors, k)
        size = float(np.sqrt(np.mean(torque**2)))
        torque = torque + noise * size * random.normal(size=time.size)
        gain = joint.drive_gain if effort == "current" and joint.drive_gain else 1.0
        measured = v[:, k] + velocity_noise * random.normal(size=time.size)
        for channel, values in (
            ("position", q[:, k]),
            ("velocity", measured),
            (effort, torque / gain),
        ):
            if channel in named:
                made[named[channel].format(joint=joint.name, number=k + 1)] = values
    return pl.DataFrame(made)


def _check(
    robot: Robot,
    friction: Mapping[str, Model],
    seconds: float,
    rate: float,
    speed: float,
    noise: float,
) -> None:
    check_friction(robot, friction)
    check_number("seconds", seconds, 1.0, 3600.0, " s")
    check_number("rate", rate, 10.0, 10_000.0, " Hz")
    check_number("speed", speed, 1e-6, 1e3)
    check_share("noise", noise)


def check_friction(robot: Robot, friction: Mapping[str, Model]) -> None:
    """Refuse friction of joints that do not exist, and a robot whose bodies are not known."""
    for name in friction:
        if name not in robot.names:
            hint = nearest(name, robot.names) or f"; the joints are {listed(robot.names)}"
            raise SpecError(f"{robot.name} has no joint '{name}'{hint}")
    if not robot.has_inertia:
        raise SpecError(f"{robot.name}: the inertial parameters of its links are not known")


def fourier_motion(
    time: Array, joints: int, speed: float, harmonics: int, random: np.random.Generator
) -> tuple[Array, Array, Array]:
    """Position, velocity and acceleration [n, N] of a Fourier series with a period of 10 s."""
    base = 2.0 * np.pi / 10.0
    q, v, a = np.zeros((3, time.size, joints))
    for joint in range(joints):
        sine, cosine = random.normal(size=(2, harmonics))
        scale = speed / np.sqrt(0.5 * np.sum(sine**2 + cosine**2))
        for k, (s, c) in enumerate(zip(scale * sine, scale * cosine, strict=True), start=1):
            w = base * k
            q[:, joint] += (s * np.sin(w * time) - c * np.cos(w * time)) / w
            v[:, joint] += s * np.cos(w * time) + c * np.sin(w * time)
            a[:, joint] += w * (c * np.cos(w * time) - s * np.sin(w * time))
    return q, v, a


def _friction(model: Model, time: Array, motors: Sequence[Array], joint: int) -> Array:
    position, velocity, acceleration, load = motors
    dt = np.full(time.size, time[1] - time[0])
    dt[0] = 0.0
    shifted = model.torque(
        velocity[:, joint],
        position=position[:, joint],
        acceleration=acceleration[:, joint],
        load_torque=load[:, joint],
        dt=dt,
    )
    return np.asarray(shifted)
