"""MJCF with the inertia, damping and friction that were identified."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import ModelFileError, listed
from stribeck.base.files import write_whole
from stribeck.base.replaceable import check_regular
from stribeck.models.model import Model
from stribeck.robot.arm import Robot
from stribeck.robot.coupled import coupled
from stribeck.robot.mjcf import compiled, robot_of

Array = NDArray[np.float64]


def updated_mjcf(source: str | Path, robot: Robot, friction: Mapping[str, Model]) -> str:
    """The MJCF `source` with identified inertias, armature, and Coulomb and viscous friction.

    Identified inertias replace those of the geoms; the inertia of bodies without a joint is in the
    body that carries them. Terms of friction other than Coulomb and viscous are left out, and
    rotors and friction of motors that turn with several joints. Names of meshes are relative to
    `source`: write the file beside it.

    Parameters
    ----------
    robot
        Its joints have the names and frames of `source`.

    Raises
    ------
    ModelFileError
        The MJCF has other joints or frames, or joints that are not in its own text.
    """
    check_regular(Path(source), ModelFileError)
    model = compiled(str(source))
    _require_frames(str(source), robot_of(str(source), model), robot)
    root = ET.parse(source).getroot()
    _take_inertia_as_stated(root)
    bodies = [body for world in root.findall("worldbody") for body in world.iter("body")]
    moved = [(body, own) for body in bodies if (own := body.find("joint")) is not None]
    if len(moved) != len(robot.joints):
        raise ModelFileError(
            f"{source} has joints in an <include>, <frame> or <replicate>: write it out as one "
            "file by MuJoCo's mj_saveLastXML, and give that"
        )
    for body in bodies:
        for old in body.findall("inertial"):
            body.remove(old)
    shared = coupled(robot.coupling)
    for k, (joint, (body, element)) in enumerate(zip(robot.joints, moved, strict=True)):
        if joint.inertial is None or not joint.inertial[0] > 0.0:
            raise ModelFileError(f"{robot.name}: the mass on joint {joint.name} is not known")
        body.insert(0, _inertial(joint.inertial, model.jnt_pos[k]))
        if k in shared:
            continue
        element.set("armature", repr(float(joint.rotor)))
        if joint.name in friction:
            _set_friction(element, friction[joint.name])
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def write_mjcf(
    path: str | os.PathLike[str], source: str | Path, robot: Robot, friction: Mapping[str, Model]
) -> None:
    """Write an updated MJCF, whole or not at all.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from stribeck import model, robot
    >>> body = '<body><joint name="hip"/><geom type="sphere" size="0.1" mass="2"/></body>'
    >>> friction = {"hip": model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     old, new = Path(folder, "old.xml"), Path(folder, "new.xml")
    ...     _ = old.write_text(f"<mujoco><worldbody>{body}</worldbody></mujoco>")
    ...     robot.write_mjcf(new, old, robot.read_robot(old), friction)
    ...     'damping="0.5" frictionloss="2.0"' in new.read_text()
    True
    """
    write_whole(path, updated_mjcf(source, robot, friction), ModelFileError)


def _require_frames(source: str, own: Robot, robot: Robot) -> None:
    missing = [name for name in robot.names if name not in own.names]
    if missing:
        raise ModelFileError(f"{source} has no joint {listed(missing)}: give the robot's own MJCF")
    if own.names != robot.names:
        more = [name for name in own.names if name not in robot.names]
        raise ModelFileError(f"{source} has joints that {robot.name} has not: {listed(more)}")
    for one, other in zip(own.joints, robot.joints, strict=True):
        same = one.parent == other.parent and one.movement == other.movement
        for a, b in (
            (one.axis, other.axis),
            (one.rotation, other.rotation),
            (one.translation, other.translation),
        ):
            same = same and bool(np.allclose(a, b, rtol=0.0, atol=1e-6))
        if not same:
            raise ModelFileError(
                f"joint {one.name} of {source} stands elsewhere than that of {robot.name}: fit "
                f"with --mjcf {source}"
            )


def _take_inertia_as_stated(root: ET.Element) -> None:
    """Let MuJoCo take inertias from the bodies as they are written, not from geoms."""
    compiler = root.find("compiler")
    if compiler is None:
        compiler = ET.Element("compiler")
        root.insert(0, compiler)
    for settings in root.findall("compiler"):
        for key in ("boundmass", "boundinertia", "balanceinertia", "settotalmass"):
            settings.attrib.pop(key, None)
        settings.set("inertiafromgeom", "false")


def _inertial(values: Array, place: Array) -> ET.Element:
    """An element from the ten inertial parameters about a point of the body."""
    mass = float(values[0])
    centre = values[1:4] / mass
    xx, xy, yy, xz, yz, zz = values[4:10]
    about = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    about = about - mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    numbers = (*np.diag(about), about[0, 1], about[0, 2], about[1, 2])
    return ET.Element(
        "inertial", mass=repr(mass), pos=_text(centre + place), fullinertia=_text(numbers)
    )


def _text(numbers: Iterable[float]) -> str:
    return " ".join(repr(float(x)) for x in numbers)


def _set_friction(joint: ET.Element, model: Model) -> None:
    for key, name in (("damping", "viscous_friction"), ("frictionloss", "coulomb_friction")):
        if name in model.names:
            joint.set(key, repr(float(model.value(name))))
