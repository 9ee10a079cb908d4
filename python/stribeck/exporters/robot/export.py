"""Export of an identified robot as a program for a controller."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from stribeck.base.arguments import door
from stribeck.base.errors import ModelFileError
from stribeck.exporters.c.files import identifier
from stribeck.exporters.precision import FLOATING, Precision
from stribeck.exporters.robot.c import robot_c_files
from stribeck.exporters.robot.joints import Joints
from stribeck.exporters.robot.rust import robot_rust_files
from stribeck.exporters.robot.vectors import robot_vectors
from stribeck.exporters.written import chosen, write_files
from stribeck.models.model import Model
from stribeck.robot.arm import Robot

Language = Literal["c", "rust"]


@dataclass(frozen=True)
class RobotExport:
    """What was written.

    Attributes
    ----------
    robot
        Name of the robot.
    models
        The friction of each joint.
    files
        The files that were written.
    """

    robot: str
    models: tuple[tuple[str, str], ...]
    language: Language
    precision: Precision
    files: tuple[Path, ...]

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "robot": self.robot,
            "models": dict(self.models),
            "to": self.language,
            "precision": self.precision,
            "files": [str(path) for path in self.files],
        }

    def __repr__(self) -> str:
        """The robot, then one line a file."""
        head = f"{self.robot}, {len(self.models)} joints, in {self.language}, {self.precision}"
        return "\n".join([head, *(f"  {path}" for path in self.files)])


@door(ModelFileError)
def export_robot(
    robot: Robot,
    friction: Mapping[str, Model],
    to: str,
    folder: str | os.PathLike[str],
    *,
    name: str | None = None,
    precision: str = "f64",
    seed: int = 0,
) -> RobotExport:
    """Write the torques of all joints as a program: gravity, inertia and friction.

    C, crate and Python give the same bits. A delay, which belongs to the recording, is left out.

    Parameters
    ----------
    robot
        With the inertial parameters of every link, as `read_robot` reads it from a robot file.
    friction : mapping of Model
        Friction of each joint, with values; its load is the torque of the rigid bodies.
    to : {"c", "rust"}
        C99 without libraries, or a Rust module for the crate.
    folder
        Folder of the files, created if needed. Files with the same names are replaced.
    name
        Start of the names of files, types and functions. [default: the robot's name]
    precision : {"f64", "f32"}
        Number format.
    seed
        Of the test vectors.

    Raises
    ------
    SpecError, ModelFileError
        A format that is unknown, a joint without friction or inertial parameters, or a folder that
        cannot be written to.

    Examples
    --------
    >>> import stribeck as sb, numpy as np, tempfile
    >>> from stribeck.robot.tables import from_tables
    >>> arm = from_tables("pendulum", [{"a": 0.5}], names=["hip"]).with_bodies(np.ones((1, 11)))
    >>> friction = {"hip": sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = export_robot(arm, friction, "c", folder, precision="f32")
    ...     [path.name for path in written.files]
    ['pendulum.h', 'pendulum.c', 'pendulum_vectors.h', 'pendulum_test.c']
    """
    language: Language = chosen("to", to, get_args(Language))
    joints = Joints.of(robot, friction, chosen("precision", precision, FLOATING))
    vectors = robot_vectors(joints, seed=seed)
    write = robot_c_files if language == "c" else robot_rust_files
    texts = write(joints, vectors, name=identifier(name or robot.name))
    return RobotExport(
        robot=robot.name,
        models=joints.specs,
        language=language,
        precision=joints.precision,
        files=write_files(texts, Path(folder)),
    )
