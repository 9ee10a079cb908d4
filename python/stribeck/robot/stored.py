"""Identified robots as robot files: frames, inertial parameters and the friction of each joint."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import tomlkit

from stribeck.base.errors import ModelFileError
from stribeck.base.files import write_whole
from stribeck.base.toml import TomlText, read_text
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.models.reader import read_model
from stribeck.robot.arm import PARAMETERS, Array, Robot
from stribeck.robot.describe import SCHEMA
from stribeck.robot.result import RobotFit


def robot_toml(found: RobotFit) -> str:
    """The text of a robot file with what was identified; it reads back with the same bits."""
    balance = found.solved.balance
    robot, bodies = balance.base.robot, found.bodies.parameters
    document = tomlkit.document()
    document.add("kind", tomlkit.item("robot"))
    document.add("schema", tomlkit.item(SCHEMA))
    document.add("name", tomlkit.item(robot.name))
    document.add("convention", tomlkit.item("frames"))
    document.add("gravity", tomlkit.item([float(x) for x in robot.gravity]))
    if robot.encoders != "joints":
        document.add("encoders", tomlkit.item(robot.encoders))
    if robot.columns:
        document.add("columns", tomlkit.item(dict(robot.columns)))
    rows = tomlkit.aot()
    for joint, fitted, values in zip(robot.joints, found.joints, bodies, strict=True):
        row = tomlkit.table()
        row.add("name", joint.name)
        row.add("kind", joint.movement)
        if joint.parent is not None:
            row.add("parent", robot.names[joint.parent])
        row.add("axis", [float(x) for x in joint.axis])
        row.add("rotation", [[float(x) for x in line] for line in joint.rotation])
        row.add("translation", [float(x) for x in joint.translation])
        row.add("inertial", _inertial(values[:10]))
        row.add("rotor", float(values[10]))
        if joint.drive_gain is not None:
            row.add("drive_gain", float(joint.drive_gain))
        if joint.torque_limit is not None:
            row.add("torque_limit", float(joint.torque_limit))
        if robot.coupling:
            row.add("motor_turns", _turns(robot, len(rows)))
        friction = tomlkit.table()
        errors = {n: e.stderr for n, e in fitted.estimates.items() if e.stderr is not None}
        ModelFile(fitted.model, errors).write_into(friction)
        row.add("friction", friction)
        rows.append(row)
    document.add("joint", rows)
    if robot.spheres:
        document.add("sphere", _spheres(robot))
    first = balance.motion.joints[0]
    fitted_on = {
        "path": first.path,
        "hashes": list(balance.hashes),
        "cutoff_hz": balance.motion.cutoff,
    }
    document.add("fitted_on", tomlkit.item(fitted_on))
    return tomlkit.dumps(document)


def _spheres(robot: Robot) -> tomlkit.items.AoT:
    rows = tomlkit.aot()
    for sphere in robot.spheres:
        row = tomlkit.table()
        if sphere.joint is not None:
            row.add("joint", sphere.joint)
        row.add("centre", list(sphere.centre))
        row.add("radius", sphere.radius)
        rows.append(row)
    return rows


def _turns(robot: Robot, number: int) -> tomlkit.items.InlineTable:
    """The joints with which a motor turns, by name."""
    table = tomlkit.inline_table()
    for name, factor in zip(robot.names, robot.coupling[number], strict=True):
        if factor != 0.0:
            table.append(name, factor)
    return table


def _inertial(values: Array) -> tomlkit.items.InlineTable:
    """Inertial parameters by symbol."""
    table = tomlkit.inline_table()
    for (symbol, _), value in zip(PARAMETERS[:10], values, strict=True):
        table.append(symbol, float(value))
    return table


def write_robot(found: RobotFit, path: str | os.PathLike[str]) -> None:
    """Write a robot file, whole or not at all.

    Examples
    --------
    >>> import numpy as np, tempfile
    >>> from stribeck import read, robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, 0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]]))
    >>> run = robot.simulate_robot(arm, {}, seconds=20.0, rate=100.0, noise=0.01)
    >>> found = robot.fit_robot(robot.RobotMotion.of(arm, [read(run)]), "coulomb")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     robot.write_robot(found, f"{folder}/arm.toml")
    ...     robot.read_robot(f"{folder}/arm.toml").has_inertia
    True
    """
    write_whole(path, robot_toml(found), ModelFileError)


def read_friction(path: str | Path) -> dict[str, Model]:
    """The friction of each joint of a robot file that was written by `write_robot`.

    Raises
    ------
    ModelFileError
        A joint has no friction.

    Examples
    --------
    >>> import numpy as np, tempfile
    >>> from stribeck import model, read, robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, 0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]]))
    >>> friction = {"1": model("coulomb", coulomb_friction=2.0, viscous_friction=1.0)}
    >>> run = robot.simulate_robot(arm, friction, seconds=20.0, rate=100.0, noise=0.01)
    >>> found = robot.fit_robot(robot.RobotMotion.of(arm, [read(run)]), "coulomb")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     robot.write_robot(found, f"{folder}/arm.toml")
    ...     robot.read_friction(f"{folder}/arm.toml")["1"].values.round(1)
    array([1., 2.])
    """
    where = Path(path)
    if where.suffix.lower() in (".urdf", ".xml"):
        raise ModelFileError(
            f"{where} has no friction that was identified: give a file of `stribeck robot fit -o`"
        )
    text = TomlText(where, read_text(where, "robot file", ModelFileError), ModelFileError)
    content = text.parsed()
    if content.get("kind") != "robot":
        raise text.stop(f'kind = "robot" is needed, not {content.get("kind")!r}', "kind")
    rows = content.get("joint", [])
    made: dict[str, Model] = {}
    for row in rows if isinstance(rows, list) else []:
        friction: object = row.get("friction") if isinstance(row, Mapping) else None
        if not isinstance(friction, dict):
            raise text.stop(
                "a joint has no friction: write the file by `stribeck robot fit -o FILE`",
                "[[joint]]",
            )
        made[str(row["name"])] = read_model(friction, where, text.text, "[[joint]]").model
    return made
