"""Robots from Denavit-Hartenberg tables, standard and modified."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import ModelFileError
from stribeck.robot.arm import GRAVITY, Movement, Robot, RobotJoint

Array = NDArray[np.float64]

Convention = Literal["standard", "modified"]


def from_tables(
    name: str,
    rows: Sequence[Mapping[str, float]],
    *,
    convention: Convention = "standard",
    names: Sequence[str] = (),
    movements: Sequence[Movement] = (),
    drive_gains: Sequence[float | None] = (),
    gravity: tuple[float, float, float] = GRAVITY,
) -> Robot:
    """A serial robot from a Denavit-Hartenberg table.

    Parameters
    ----------
    rows : sequence of mappings
        One row a joint: ``a`` and ``d`` in m, ``alpha`` and ``theta`` in rad; 0 where left out. The
        position of a revolute joint is added to theta, that of a prismatic one to d.
    convention : {"standard", "modified"}
        ``Rz(theta) Tz(d) Tx(a) Rx(alpha)`` with a and alpha of the link behind the joint (Denavit
        and Hartenberg 1955), or ``Rx(alpha) Tx(a) Rz(theta) Tz(d)`` with those of the link before
        it (Craig 1986).
    names, movements, drive_gains
        Of the joints; by default ``"1"``, ``"2"``, ..., revolute, without gain.

    Examples
    --------
    >>> arm = from_tables("planar", [{"a": 0.4}, {"a": 0.3}])
    >>> arm.joints[1].translation
    array([0.4, 0. , 0. ])
    """
    if not rows:
        raise ModelFileError(f"{name}: the table has no joint")
    joints = []
    before = (np.eye(3), np.zeros(3))
    for k, row in enumerate(rows):
        movement = movements[k] if movements else "revolute"
        turn = _about_z(row.get("theta", 0.0))
        out = np.array([0.0, 0.0, row.get("d", 0.0)])
        link = (_about_x(row.get("alpha", 0.0)), np.array([row.get("a", 0.0), 0.0, 0.0]))
        at = before if convention == "standard" else link
        joints.append(
            RobotJoint(
                name=names[k] if names else str(k + 1),
                movement=movement,
                parent=k - 1 if k else None,
                axis=(0.0, 0.0, 1.0),
                rotation=at[0] @ turn,
                translation=at[1] + (at[0] @ out if convention == "modified" else 0.0),
                drive_gain=drive_gains[k] if drive_gains else None,
            )
        )
        before = (link[0], link[1] + out)
    return Robot(name, tuple(joints), gravity)


def _about_x(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def _about_z(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
