"""A URDF with the inertia, damping and friction that were identified."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import ModelFileError, listed
from stribeck.base.files import write_whole
from stribeck.base.replaceable import check_regular
from stribeck.models.model import Model
from stribeck.robot.arm import Robot
from stribeck.robot.coupled import coupled

Array = NDArray[np.float64]


def updated_urdf(source: str | Path, robot: Robot, friction: Mapping[str, Model]) -> str:
    """The URDF `source` with identified inertias, and the Coulomb and viscous friction of joints.

    The inertia of links behind fixed joints is in the link that carries them, and their own is
    removed. Rotor inertia has no place in URDF; it is left out. Other terms of friction are too,
    and all friction of motors that turn with several joints.

    Parameters
    ----------
    robot
        Its joints have the names and frames of the URDF.

    Raises
    ------
    ModelFileError
        The URDF has other joints.
    """
    check_regular(Path(source), ModelFileError)
    try:
        tree = ET.parse(source)
    except (OSError, ET.ParseError) as failure:
        raise ModelFileError(f"{source}: not a URDF that can be read ({failure})") from None
    root = tree.getroot()
    joints = {str(joint.get("name")): joint for joint in root.findall("joint")}
    missing = [name for name in robot.names if name not in joints]
    if missing:
        raise ModelFileError(f"{source} has no joint {listed(missing)}: give the robot's own URDF")
    links = {str(link.get("name")): link for link in root.findall("link")}
    for element in joints.values():
        if element.get("type") == "fixed":
            _without_inertial(links[_child(element)])
    shared = coupled(robot.coupling)
    for k, joint in enumerate(robot.joints):
        if joint.inertial is None or not joint.inertial[0] > 0.0:
            raise ModelFileError(f"{robot.name}: the mass on joint {joint.name} is not known")
        link = links[_child(joints[joint.name])]
        _without_inertial(link)
        link.insert(0, _inertial(joint.inertial))
        if joint.name in friction and k not in shared:
            _set_friction(joints[joint.name], friction[joint.name])
    ET.indent(tree)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def write_urdf(
    path: str | os.PathLike[str], source: str | Path, robot: Robot, friction: Mapping[str, Model]
) -> None:
    """Write an updated URDF, whole or not at all.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from stribeck import model, robot
    >>> inertia = '<mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    >>> link = f'<link name="base"/><link name="arm"><inertial>{inertia}</inertial></link>'
    >>> joint = '<joint name="hip" type="revolute"><parent link="base"/><child link="arm"/></joint>'
    >>> friction = {"hip": model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     old, new = Path(folder, "old.urdf"), Path(folder, "new.urdf")
    ...     _ = old.write_text(f'<robot name="one">{link}{joint}</robot>')
    ...     robot.write_urdf(new, old, robot.read_robot(old), friction)
    ...     '<dynamics damping="0.5" friction="2.0" />' in new.read_text()
    True
    """
    write_whole(path, updated_urdf(source, robot, friction), ModelFileError)


def _child(joint: ET.Element) -> str:
    child = joint.find("child")
    return "" if child is None else str(child.get("link"))


def _without_inertial(link: ET.Element) -> None:
    for old in link.findall("inertial"):
        link.remove(old)


def _inertial(values: Array) -> ET.Element:
    """An element from the ten inertial parameters: mass, centre of mass, inertia about it."""
    mass = float(values[0])
    centre = values[1:4] / mass
    xx, xy, yy, xz, yz, zz = values[4:10]
    about = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    about = about - mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    made = ET.Element("inertial")
    ET.SubElement(made, "mass", value=repr(mass))
    ET.SubElement(made, "origin", xyz=" ".join(repr(float(x)) for x in centre), rpy="0 0 0")
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    numbers = about[np.triu_indices(3)]
    ET.SubElement(
        made, "inertia", {name: repr(float(x)) for name, x in zip(names, numbers, strict=True)}
    )
    return made


def _set_friction(joint: ET.Element, model: Model) -> None:
    dynamics = joint.find("dynamics")
    if dynamics is None:
        dynamics = ET.SubElement(joint, "dynamics")
    for key, name in (("damping", "viscous_friction"), ("friction", "coulomb_friction")):
        if name in model.names:
            dynamics.set(key, repr(model.value(name)))
