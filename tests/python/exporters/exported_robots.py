"""A robot to export, with a different law in most joints."""

from __future__ import annotations

import numpy as np
import stribeck as sb
from exported_models import valued
from stribeck.robot.arm import Robot, RobotJoint

LAWS = ("lugre+load", "coulomb", "coulomb+load", "lugre+load", "gms", "coulomb+temperature_viscous")

#: Motors 5 and 6 are a differential that turns with joint 4 too.
WRIST = tuple(
    tuple(map(float, row))
    for row in (
        (1, 0, 0, 0, 0, 0),
        (0, 1, 0, 0, 0, 0),
        (0, 0, 1, 0, 0, 0),
        (0, 0, 0, 1, 0, 0),
        (0, 0, 0, 0.5, 1, 1),
        (0, 0, 0, 0, 1, -1),
    )
)


def made_robot(seed: int = 0) -> Robot:
    """A tree: joint 3 slides, joints 4 to 6 stand on link 1; axes and frames are askew."""
    random = np.random.default_rng(seed)
    joints = []
    for k, parent in enumerate((None, 0, 1, 0, 3, 4)):
        axis = random.normal(size=3) if k else np.array([0.0, 0.0, 1.0])
        axis /= np.sqrt(axis @ axis)
        frame = np.linalg.qr(random.normal(size=(3, 3)))[0]
        frame[:, 0] *= np.sign(np.linalg.det(frame))
        centre, mass = random.uniform(-0.2, 0.2, 3), random.uniform(1.0, 8.0)
        about = mass * (centre @ centre * np.eye(3) - np.outer(centre, centre)) + 0.05 * np.eye(3)
        moments = [about[0, 0], about[0, 1], about[1, 1], about[0, 2], about[1, 2], about[2, 2]]
        joints.append(
            RobotJoint(
                name=f"axis {k + 1}",
                movement="prismatic" if k == 2 else "revolute",
                parent=parent,
                axis=(float(axis[0]), float(axis[1]), float(axis[2])),
                rotation=frame,
                translation=random.uniform(-0.5, 0.5, 3),
                inertial=np.array([mass, *(mass * centre), *moments]),
                rotor=0.1 * k,
            )
        )
    return Robot("made arm", tuple(joints), gravity=(0.3, -0.4, -9.7))


def friction_of(robot: Robot, specs: tuple[str, ...] = LAWS) -> dict[str, sb.Model]:
    made = {}
    for k, (name, spec) in enumerate(zip(robot.names, specs, strict=True)):
        made[name] = valued(sb.model(spec), np.random.default_rng(k))
    return made
