"""Robots from URDF, read by urdf_parser_py."""

from __future__ import annotations

import contextlib
import io
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import ModelFileError, listed
from stribeck.base.toml import read_text
from stribeck.robot.arm import Robot, RobotJoint

if TYPE_CHECKING:
    from urdf_parser_py import urdf

Array = NDArray[np.float64]
Frame = tuple[Array, Array]

_MOVEMENTS = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic"}


def read_urdf(path: str | Path) -> Robot:
    """Read a robot from a URDF file. Links behind fixed joints are part of the link before.

    Raises
    ------
    ModelFileError
        The file is not a URDF of a tree of revolute and prismatic joints.
    """
    text = read_text(Path(path), "URDF", ModelFileError)
    try:
        from urdf_parser_py import urdf
    except ImportError:
        raise ModelFileError(
            f"{path}: reading URDF needs urdf_parser_py: pip install 'stribeck[robots]'"
        ) from None
    try:
        # The parser prints what it does not know, such as elements of simulators.
        with contextlib.redirect_stderr(io.StringIO()):
            parsed = urdf.URDF.from_xml_string(text.encode())
        root = parsed.get_root()
    except Exception as failure:
        raise ModelFileError(f"{path}: not a URDF that can be read ({failure})") from None
    return _Tree(str(path), parsed).robot(root)


class _Tree:
    """The joints of a URDF in the order in which links carry each other."""

    def __init__(self, path: str, parsed: urdf.URDF) -> None:
        self.path = path
        self.parsed = parsed
        self.joints: list[RobotJoint] = []
        self.inertial: list[Array | None] = []

    def robot(self, root: str) -> Robot:
        """The robot on the link `root`."""
        self._add(root, None, (np.eye(3), np.zeros(3)))
        if not self.joints:
            raise ModelFileError(
                f"{self.path}: no joint moves: a revolute or prismatic one is needed"
            )
        known = all(inertial is not None for inertial in self.inertial)
        joints = [
            replace(joint, inertial=inertial if known else None)
            for joint, inertial in zip(self.joints, self.inertial, strict=True)
        ]
        return Robot(str(self.parsed.name or "robot"), tuple(joints), source=self.path)

    def _add(self, link: str, carrier: int | None, at: Frame) -> None:
        """Add what stands on a link, which has the pose `at` in the frame of joint `carrier`."""
        if carrier is not None:
            self._carry(carrier, link, at)
        for name, child in self.parsed.child_map.get(link, []):
            joint = self.parsed.joint_map[name]
            if joint.mimic is not None:
                raise ModelFileError(
                    f"{self.path}: joint '{name}' mimics '{joint.mimic.joint}': a joint without a "
                    f"motor of its own is not read: make it a fixed joint"
                )
            here = _after(at, _frame(joint.origin))
            if joint.type == "fixed":
                self._add(child, carrier, here)
                continue
            movement = _MOVEMENTS.get(joint.type)
            if movement is None:
                raise ModelFileError(
                    f"{self.path}: joint '{name}' is {joint.type}: only {listed(_MOVEMENTS)} and "
                    f"fixed joints are read"
                )
            self.joints.append(
                RobotJoint(
                    name=name,
                    movement="revolute" if movement == "revolute" else "prismatic",
                    parent=carrier,
                    axis=self._axis(name, joint.axis),
                    rotation=here[0],
                    translation=here[1],
                )
            )
            self.inertial.append(None)
            self._add(child, len(self.joints) - 1, (np.eye(3), np.zeros(3)))

    def _axis(self, name: str, given: list[float] | None) -> tuple[float, float, float]:
        axis = np.array([1.0, 0.0, 0.0] if given is None else given, dtype=np.float64)
        size = float(np.sqrt(axis @ axis))
        if axis.shape != (3,) or not np.isfinite(size) or size == 0.0:
            raise ModelFileError(f"{self.path}: the axis of joint '{name}' is not a direction")
        x, y, z = axis / size
        return float(x), float(y), float(z)

    def _carry(self, carrier: int, link: str, at: Frame) -> None:
        """Add the inertia of a link to that of the joint that carries it."""
        stated = self.parsed.link_map[link].inertial
        if stated is None:
            return
        rotation, centre = _after(at, _frame(stated.origin))
        i = stated.inertia
        about = np.array([[i.ixx, i.ixy, i.ixz], [i.ixy, i.iyy, i.iyz], [i.ixz, i.iyz, i.izz]])
        turned = rotation @ about @ rotation.T
        made = from_centre(float(stated.mass), centre, turned)
        before = self.inertial[carrier]
        self.inertial[carrier] = made if before is None else before + made


def from_centre(mass: float, centre: Array, inertia: Array) -> Array:
    """The ten inertial parameters [10] from the inertia [3, 3] about the centre of mass [3].

    Examples
    --------
    >>> from_centre(2.0, np.array([0.0, 0.0, 0.5]), np.zeros((3, 3))).tolist()
    [2.0, 0.0, 0.0, 1.0, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0]
    """
    whole = inertia + mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    xx, xy, yy = whole[0, 0], whole[0, 1], whole[1, 1]
    return np.array([mass, *(mass * centre), xx, xy, yy, whole[0, 2], whole[1, 2], whole[2, 2]])


def _frame(origin: urdf.Pose | None) -> Frame:
    """Rotation and translation of an ``<origin>``: fixed-axis roll, pitch, yaw."""
    if origin is None:
        return np.eye(3), np.zeros(3)
    roll, pitch, yaw = origin.rpy or (0.0, 0.0, 0.0)
    (cr, sr), (cp, sp), (cy, sy) = ((np.cos(x), np.sin(x)) for x in (roll, pitch, yaw))
    rotation = np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )
    return rotation, np.array(origin.xyz or (0.0, 0.0, 0.0), dtype=np.float64)


def _after(outer: Frame, inner: Frame) -> Frame:
    return outer[0] @ inner[0], outer[1] + outer[0] @ inner[1]
