"""Joints of a robot file by frames: axis, pose on the parent, inertial parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from stribeck.base.toml import TomlText
from stribeck.robot.arm import PARAMETERS, Movement, RobotJoint

Array = NDArray[np.float64]

KEYS = (
    "name",
    "kind",
    "parent",
    "axis",
    "rotation",
    "translation",
    "inertial",
    "rotor",
    "drive_gain",
    "torque_limit",
    "motor_turns",
    "friction",
)
_SYMBOLS = [symbol for symbol, _ in PARAMETERS[:10]]


def joint_of(text: TomlText, row: Mapping[str, object], names: Sequence[str]) -> RobotJoint:
    """One joint; `names` are those of the joints before it."""
    name = str(row.get("name", len(names) + 1))
    kind = row.get("kind", "revolute")
    if kind not in ("revolute", "prismatic"):
        raise text.stop(f"a joint is revolute or prismatic, not {kind!r}", "[[joint]]", "kind")
    movement: Movement = "revolute" if kind == "revolute" else "prismatic"
    parent = row.get("parent")
    if parent is not None and parent not in names:
        raise text.stop(f"no joint before it is named {parent!r}", "[[joint]]", "parent")
    rotation = _numbers(text, row, "rotation", (3, 3), np.eye(3))
    if np.max(np.abs(rotation @ rotation.T - np.eye(3))) > 1e-6 or np.linalg.det(rotation) < 0.0:
        raise text.stop("rotation is not a rotation matrix", "[[joint]]", "rotation")
    axis = _numbers(text, row, "axis", (3,), np.array([0.0, 0.0, 1.0]))
    if abs(float(axis @ axis) - 1.0) > 1e-6:
        raise text.stop("axis is a vector of length 1", "[[joint]]", "axis")
    gain = _numbers(text, row, "drive_gain", (), np.array(math.nan))
    x, y, z = axis
    return RobotJoint(
        name,
        movement,
        None if parent is None else list(names).index(str(parent)),
        (float(x), float(y), float(z)),
        rotation,
        _numbers(text, row, "translation", (3,), np.zeros(3)),
        _inertial(text, row),
        float(_numbers(text, row, "rotor", (), np.array(0.0))),
        None if "drive_gain" not in row else float(gain),
        torque_limit(text, row),
    )


def torque_limit(text: TomlText, row: Mapping[str, object]) -> float | None:
    """Largest torque of a joint's drive."""
    if "torque_limit" not in row:
        return None
    value = float(_numbers(text, row, "torque_limit", (), np.array(math.nan)))
    if value <= 0.0:
        raise text.stop("torque_limit is above 0", "[[joint]]", "torque_limit")
    return value


def _numbers(
    text: TomlText, row: Mapping[str, object], key: str, shape: tuple[int, ...], default: Array
) -> Array:
    if key not in row:
        return default
    try:
        values = np.asarray(row[key], dtype=np.float64)
    except (TypeError, ValueError):
        values = np.array(math.nan)
    if values.shape != shape or not np.all(np.isfinite(values)):
        size = " x ".join(map(str, shape)) or "1"
        raise text.stop(f"{key} is {size} finite numbers", "[[joint]]", key)
    return values


def _inertial(text: TomlText, row: Mapping[str, object]) -> Array | None:
    given = row.get("inertial")
    if given is None:
        return None
    if not isinstance(given, dict) or sorted(given) != sorted(_SYMBOLS):
        listed = ", ".join(_SYMBOLS)
        raise text.stop(f"inertial is a table of {listed}", "[[joint]]", "inertial")
    return np.array([_numbers(text, given, symbol, (), np.zeros(())) for symbol in _SYMBOLS])
