"""Spheres around the links of a robot, and how far they are apart in motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import listed, nearest
from stribeck.base.toml import TomlText
from stribeck.robot.arm import Robot, RobotJoint, Sphere

Array = NDArray[np.float64]

KEYS = ("joint", "centre", "radius")


def read_spheres(text: TomlText, rows: object, names: Sequence[str]) -> tuple[Sphere, ...]:
    """The rows ``[[sphere]]`` of a robot file."""
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise text.stop("[[sphere]] is a list of tables", "sphere")
    return tuple(_read(text, row, names) for row in rows)


def _read(text: TomlText, row: Mapping[str, object], names: Sequence[str]) -> Sphere:
    text.check_keys(row, KEYS, "[[sphere]]")
    joint = row.get("joint")
    if joint is not None and joint not in names:
        hint = nearest(str(joint), names) or f"; the joints are {listed(names)}"
        raise text.stop(f"there is no joint {joint!r}{hint}", "[[sphere]]", "joint")
    try:
        centre = np.asarray(row.get("centre", (0.0, 0.0, 0.0)), dtype=np.float64)
        radius = np.asarray(row.get("radius"), dtype=np.float64)
    except (TypeError, ValueError):
        centre = radius = np.zeros(0)
    if centre.shape != (3,) or not np.all(np.isfinite(centre)):
        raise text.stop("centre is three finite numbers, in m", "[[sphere]]", "centre")
    if radius.shape != () or not 0.0 < float(radius) < np.inf:
        raise text.stop("radius is a number above 0, in m", "[[sphere]]", "radius")
    x, y, z = (float(c) for c in centre)
    return Sphere(None if joint is None else str(joint), (x, y, z), float(radius))


def frames(robot: Robot, position: Array) -> tuple[Array, Array]:
    """Where the frames of the links are at positions [n, N].

    Returns
    -------
    rotation, origin : arrays [n, N, 3, 3] and [n, N, 3]
        Axes of each link's frame as columns, and its origin, in the frame of the base; m.

    Examples
    --------
    >>> from stribeck.robot.tables import from_tables
    >>> arm = from_tables("planar", [{"a": 0.4}, {"a": 0.3}])
    >>> frames(arm, np.array([[np.pi / 2, 0.0]]))[1][0, 1].round(12)
    array([0. , 0.4, 0. ])
    """
    count = len(position)
    rotation = np.empty((count, len(robot.joints), 3, 3))
    origin = np.empty((count, len(robot.joints), 3))
    for k, joint in enumerate(robot.joints):
        turn = np.broadcast_to(np.eye(3), (count, 3, 3))
        place = np.zeros((count, 3))
        if joint.parent is not None:
            turn, place = rotation[:, joint.parent], origin[:, joint.parent]
        own, moved = _moved(joint, position[:, k])
        rotation[:, k] = turn @ own
        origin[:, k] = place + np.einsum("nij,nj->ni", turn, moved)
    return rotation, origin


def _moved(joint: RobotJoint, position: Array) -> tuple[Array, Array]:
    """Frame of a link in that of its parent: rotation [n, 3, 3], origin [n, 3]."""
    x, y, z = joint.axis
    if joint.movement == "prismatic":
        along = joint.rotation @ np.array(joint.axis)
        turned = np.broadcast_to(joint.rotation, (len(position), 3, 3))
        return turned, joint.translation + position[:, None] * along
    # Rodrigues' formula.
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    s, c = np.sin(position)[:, None, None], np.cos(position)[:, None, None]
    turned = joint.rotation @ (np.eye(3) + s * cross + (1.0 - c) * (cross @ cross))
    return turned, np.broadcast_to(joint.translation, (len(position), 3))


def clearance(robot: Robot, position: Array) -> Array:
    """Smallest distance between the surfaces of spheres of different links, array [n], m.

    Links that a joint connects may touch. Below zero spheres overlap; infinite without spheres.
    """
    links = [None if s.joint is None else robot.names.index(s.joint) for s in robot.spheres]
    if not links:
        return np.full(len(position), np.inf)
    rotation, origin = frames(robot, position)
    centres = [
        np.broadcast_to(np.array(sphere.centre), (len(position), 3))
        if link is None
        else origin[:, link] + rotation[:, link] @ np.array(sphere.centre)
        for link, sphere in zip(links, robot.spheres, strict=True)
    ]
    smallest = np.full(len(position), np.inf)
    for i, first in enumerate(links):
        for j, second in enumerate(links[:i]):
            if first == second or _connected(robot, first, second):
                continue
            radii = robot.spheres[i].radius + robot.spheres[j].radius
            gap = np.sqrt(np.sum((centres[i] - centres[j]) ** 2, axis=1)) - radii
            smallest = np.minimum(smallest, gap)
    return smallest


def _connected(robot: Robot, first: int | None, second: int | None) -> bool:
    """Whether a joint connects two links."""
    return any(
        one is not None and robot.joints[one].parent == other
        for one, other in ((first, second), (second, first))
    )
