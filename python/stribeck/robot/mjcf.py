"""Robots from MJCF, the format of MuJoCo, compiled by MuJoCo itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import ModelFileError
from stribeck.base.toml import read_text
from stribeck.robot.arm import Movement, Robot, RobotJoint
from stribeck.robot.urdf import from_centre

if TYPE_CHECKING:
    import mujoco

Array = NDArray[np.float64]
Frame = tuple[Array, Array]


def is_mjcf(text: str) -> bool:
    """Whether a text in XML is MJCF: its root is ``<mujoco>``.

    Examples
    --------
    >>> is_mjcf('<?xml version="1.0"?> <!-- an arm --> <mujoco model="arm">')
    True
    >>> is_mjcf('<robot name="arm"><mujoco><compiler/></mujoco></robot>')
    False
    """
    rest = text.lstrip("\ufeff").lstrip()
    for start, end in (("<?", "?>"), ("<!--", "-->")):
        while rest.startswith(start):
            rest = rest.partition(end)[2].lstrip()
    return rest.startswith("<mujoco")


def mujoco_module(path: str) -> ModuleType:
    """MuJoCo.

    Raises
    ------
    ModelFileError
        It is not installed.
    """
    try:
        import mujoco
    except ImportError:
        raise ModelFileError(f"{path}: MJCF needs MuJoCo: pip install 'stribeck[robots]'") from None
    return mujoco


def read_mjcf(path: str | Path) -> Robot:
    """Read a robot from MJCF: hinges and slides, one a body. Bodies without a joint are fixed.

    `damping` and `frictionloss` are not read: friction is identified.

    Raises
    ------
    ModelFileError
        The file is not MJCF of a tree of hinges and slides.
    """
    read_text(Path(path), "MJCF", ModelFileError)
    return robot_of(str(path), compiled(str(path)))


def compiled(path: str) -> mujoco.MjModel:
    """The model that MuJoCo compiles.

    Raises
    ------
    ModelFileError
        MuJoCo refuses the file.
    """
    module = mujoco_module(path)
    try:
        return module.MjModel.from_xml_path(path)
    except ValueError as failure:
        said = " ".join(str(failure).split())
        raise ModelFileError(f"{path}: MuJoCo refuses it: {said}") from None


def robot_of(path: str, model: mujoco.MjModel) -> Robot:
    """The robot of a compiled model."""
    _refuse_couplings(path, model)
    joints: list[RobotJoint] = []
    inertial: list[Array] = []
    # Of each body: the joint that moves it, and its frame in that of the joint's link.
    placed: list[tuple[int | None, Frame]] = [(None, (np.eye(3), np.zeros(3)))]
    for body in range(1, model.nbody):
        carrier, outer = placed[model.body_parentid[body]]
        frame = _after(outer, (_rotation(model.body_quat[body]), model.body_pos[body]))
        if model.body_jntnum[body]:
            joint, frame = _joint(path, model, body, carrier, frame)
            joints.append(joint)
            inertial.append(np.zeros(10))
            carrier = len(joints) - 1
        placed.append((carrier, frame))
        if carrier is not None:
            inertial[carrier] = inertial[carrier] + _inertial(model, body, frame)
    if not joints:
        raise ModelFileError(f"{path}: no joint moves: a hinge or slide is needed")
    made = [replace(joint, inertial=own) for joint, own in zip(joints, inertial, strict=True)]
    x, y, z = model.opt.gravity
    name = model.names[: model.names.index(b"\0")].decode()
    gravity = (float(x), float(y), float(z))
    return Robot(name or "robot", tuple(made), gravity=gravity, source=path)


def _refuse_couplings(path: str, model: mujoco.MjModel) -> None:
    for count, what in (
        (model.neq, "equality constraint"),
        (model.ntendon, "tendon"),
        (int(np.count_nonzero(model.jnt_stiffness)), "joint with a stiffness"),
    ):
        if count:
            raise ModelFileError(f"{path}: a robot with a {what} cannot be read: remove it")


def _joint(
    path: str, model: mujoco.MjModel, body: int, carrier: int | None, frame: Frame
) -> tuple[RobotJoint, Frame]:
    """The joint that moves a body, and the frame of the body in that of its link.

    The link has its origin on the axis, where the body's own need not be.
    """
    number = int(model.body_jntadr[body])
    name = model.joint(number).name or str(number + 1)
    if model.body_jntnum[body] > 1:
        raise ModelFileError(
            f"{path}: body '{model.body(body).name}' has {model.body_jntnum[body]} joints: give "
            "each a body of its own"
        )
    kinds: dict[int, Movement] = {3: "revolute", 2: "prismatic"}
    movement = kinds.get(int(model.jnt_type[number]))
    if movement is None:
        raise ModelFileError(f"{path}: joint '{name}' is free or a ball, not a hinge or slide")
    axis, place = model.jnt_axis[number], model.jnt_pos[number]
    at_zero = _before(axis, movement, float(model.qpos0[model.jnt_qposadr[number]]))
    rotation, translation = _after(_after(frame, (np.eye(3), place)), at_zero)
    x, y, z = (float(x) for x in axis)
    joint = RobotJoint(
        name=name,
        movement=movement,
        parent=carrier,
        axis=(x, y, z),
        rotation=rotation,
        translation=translation,
        rotor=float(model.dof_armature[model.jnt_dofadr[number]]),
    )
    return joint, (np.eye(3), -place)


def _before(axis: Array, movement: Movement, reference: float) -> Frame:
    """The pose of a joint at 0, seen from its pose at the model's reference position."""
    if movement == "prismatic":
        return np.eye(3), -reference * axis
    half = -0.5 * reference
    return _rotation(np.array([np.cos(half), *(np.sin(half) * axis)])), np.zeros(3)


def _inertial(model: mujoco.MjModel, body: int, frame: Frame) -> Array:
    """The inertial parameters [10] of a body in the frame of its link."""
    principal = _rotation(model.body_iquat[body])
    rotation, centre = _after(frame, (principal, model.body_ipos[body]))
    about = rotation @ np.diag(model.body_inertia[body]) @ rotation.T
    return from_centre(float(model.body_mass[body]), centre, about)


def _rotation(quaternion: Array) -> Array:
    """The rotation [3, 3] of a unit quaternion w, x, y, z."""
    w, x, y, z = quaternion / np.sqrt(quaternion @ quaternion)
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def _after(outer: Frame, inner: Frame) -> Frame:
    return outer[0] @ inner[0], outer[1] + outer[0] @ inner[1]
