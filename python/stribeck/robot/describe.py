"""Robot files: `kind = "robot"`, with a Denavit-Hartenberg table, frames, a URDF or an MJCF."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from stribeck.base.checks import LARGEST
from stribeck.base.errors import ModelFileError
from stribeck.base.toml import TomlText, read_text
from stribeck.robot.arm import GRAVITY, Encoders, Movement, Robot, RobotJoint
from stribeck.robot.coupled import read_turns
from stribeck.robot.frames import KEYS, joint_of, torque_limit
from stribeck.robot.mjcf import is_mjcf, read_mjcf
from stribeck.robot.spheres import read_spheres
from stribeck.robot.tables import Convention, from_tables
from stribeck.robot.urdf import read_urdf

#: Version of the file's layout.
SCHEMA = 1
_SOURCES = ("urdf", "mjcf", "convention")
_KEYS = (
    "kind",
    "schema",
    "name",
    *_SOURCES,
    "gravity",
    "encoders",
    "joint",
    "sphere",
    "columns",
    "fitted_on",
)
_NUMBERS = ("a", "d", "alpha_deg", "alpha", "theta_deg", "theta", "drive_gain")
_ROW = ("name", "kind", *_NUMBERS, "torque_limit", "motor_turns")
#: Endings of a URDF or an MJCF.
DESCRIPTIONS = (".urdf", ".xml")
#: Channels of a joint that `[columns]` may name.
CHANNELS = ("time", "position", "velocity", "acceleration", "torque", "current", "temperature")


def read_robot(path: str | Path) -> Robot:
    """Read a robot from a robot file (TOML), a URDF or an MJCF.

    Raises
    ------
    ModelFileError
        What is wrong, with the line.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from stribeck import robot
    >>> lines = ['kind = "robot"', 'name = "planar"', 'convention = "standard"']
    >>> lines += ["[[joint]]", "a = 0.4", "[[joint]]", "a = 0.3"]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder, "arm.toml")
    ...     _ = path.write_text("\\n".join(lines))
    ...     robot.read_robot(path).names
    ('1', '2')
    """
    where = Path(path)
    if where.suffix.lower() in DESCRIPTIONS:
        return _described(where)
    text = TomlText(where, read_text(where, "robot file", ModelFileError), ModelFileError)
    content = text.parsed()
    if content.get("kind") != "robot":
        raise text.stop(f'kind = "robot" is needed, not {content.get("kind")!r}', "kind")
    text.check_keys(content, _KEYS)
    if content.get("schema", SCHEMA) != SCHEMA:
        raise text.stop(f"schema {content['schema']!r} is not {SCHEMA}", "schema")
    given = [key for key in _SOURCES if key in content]
    if len(given) != 1:
        raise text.stop(
            "one of urdf = FILE, mjcf = FILE and convention with a table of joints is needed"
        )
    if given[0] != "convention":
        made = _from_file(text, content, given[0])
    elif content["convention"] == "frames":
        made = _with_frames(text, content)
    else:
        made = _with_table(text, content)
    rows = content.get("joint", [])
    return replace(
        made,
        columns=_columns(text, content),
        source=str(where),
        spheres=read_spheres(text, content.get("sphere", []), made.names),
        coupling=read_turns(text, rows if isinstance(rows, list) else [], made.names),
        encoders=_encoders(text, content),
    )


def _encoders(text: TomlText, content: Mapping[str, object]) -> Encoders:
    given = content.get("encoders", "joints")
    if given not in ("joints", "motors"):
        raise text.stop(f"encoders are those of joints or motors, not {given!r}", "encoders")
    return "joints" if given == "joints" else "motors"


def _tables(
    text: TomlText, content: Mapping[str, object], keys: tuple[str, ...]
) -> list[Mapping[str, object]]:
    """The rows `[[joint]]`, which have known keys and different names."""
    rows = content.get("joint", [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise text.stop("[[joint]] is a list of tables", "joint")
    for row in rows:
        text.check_keys(row, keys, "[[joint]]")
    names = [str(row.get("name", k + 1)) for k, row in enumerate(rows)]
    if len(set(names)) < len(names):
        raise text.stop("two joints have the same name", "[[joint]]", "name")
    return rows


def _with_frames(text: TomlText, content: Mapping[str, object]) -> Robot:
    joints: list[RobotJoint] = []
    for row in _tables(text, content, KEYS):
        joints.append(joint_of(text, row, [joint.name for joint in joints]))
    if not joints:
        raise text.stop("there is no joint: write a [[joint]] for each", "convention")
    name = str(content.get("name", text.path.stem))
    return Robot(name, tuple(joints), _gravity(text, content))


def _rows(text: TomlText, content: Mapping[str, object]) -> list[Mapping[str, object]]:
    rows = _tables(text, content, _ROW)
    for row in rows:
        for key in _NUMBERS:
            value = row.get(key, 0.0)
            if not isinstance(value, int | float) or not abs(value) <= LARGEST:
                raise text.stop(
                    f"{key} is a number of at most {LARGEST:g}, not {value!r}", "[[joint]]", key
                )
        if row.get("drive_gain", 1.0) == 0.0:
            raise text.stop("drive_gain is not 0", "[[joint]]", "drive_gain")
    return rows


def _number(row: Mapping[str, object], key: str) -> float:
    value = row.get(key, 0.0)
    return float(value) if isinstance(value, int | float) else 0.0


def _gain(row: Mapping[str, object]) -> float | None:
    return _number(row, "drive_gain") if "drive_gain" in row else None


def _with_table(text: TomlText, content: Mapping[str, object]) -> Robot:
    convention = content["convention"]
    if convention not in ("standard", "modified"):
        raise text.stop(
            f"convention is standard, modified or frames, not {convention!r}", "convention"
        )
    chosen: Convention = "standard" if convention == "standard" else "modified"
    rows = _rows(text, content)
    if not rows:
        raise text.stop("there is no joint: write a [[joint]] for each", "convention")
    movements: list[Movement] = []
    for row in rows:
        kind = row.get("kind", "revolute")
        if kind not in ("revolute", "prismatic"):
            raise text.stop(f"a joint is revolute or prismatic, not {kind!r}", "[[joint]]", "kind")
        movements.append("revolute" if kind == "revolute" else "prismatic")
    names = [str(row.get("name", k + 1)) for k, row in enumerate(rows)]
    table = [
        {
            "a": _number(row, "a"),
            "d": _number(row, "d"),
            "alpha": _number(row, "alpha") + math.radians(_number(row, "alpha_deg")),
            "theta": _number(row, "theta") + math.radians(_number(row, "theta_deg")),
        }
        for row in rows
    ]
    made = from_tables(
        str(content.get("name", text.path.stem)),
        table,
        convention=chosen,
        names=names,
        movements=movements,
        drive_gains=[_gain(row) for row in rows],
        gravity=_gravity(text, content),
    )
    pairs = zip(made.joints, rows, strict=True)
    joints = tuple(replace(joint, torque_limit=torque_limit(text, row)) for joint, row in pairs)
    return replace(made, joints=joints)


def _described(path: Path) -> Robot:
    """The robot of a URDF or an MJCF."""
    if path.suffix.lower() == ".xml" and is_mjcf(read_text(path, "robot", ModelFileError)):
        return read_mjcf(path)
    return read_urdf(path)


def _from_file(text: TomlText, content: Mapping[str, object], key: str) -> Robot:
    made = _described(text.path.parent / str(content[key]))
    given = {}
    for row in _rows(text, content):
        if row.get("name") not in made.names:
            raise text.stop(
                f"{row.get('name')!r} is no joint of the {key.upper()}", "[[joint]]", "name"
            )
        given[row["name"]] = (_gain(row), torque_limit(text, row))
    joints = []
    for joint in made.joints:
        gain, largest = given.get(joint.name, (None, None))
        joints.append(replace(joint, drive_gain=gain, torque_limit=largest))
    name = str(content.get("name", made.name))
    gravity = _gravity(text, content) if "gravity" in content else made.gravity
    return replace(made, name=name, joints=tuple(joints), gravity=gravity)


def _gravity(text: TomlText, content: Mapping[str, object]) -> tuple[float, float, float]:
    given = content.get("gravity", list(GRAVITY))
    if (
        not isinstance(given, list)
        or len(given) != 3
        or not all(isinstance(x, int | float) and math.isfinite(x) for x in given)
    ):
        raise text.stop("gravity is three numbers, in m/s2 in the frame of the base", "gravity")
    x, y, z = given
    return float(x), float(y), float(z)


def _columns(text: TomlText, content: Mapping[str, object]) -> tuple[tuple[str, str], ...]:
    given = content.get("columns", {})
    if not isinstance(given, dict):
        raise text.stop("[columns] is a table of channels", "columns")
    text.check_keys(given, CHANNELS, "columns")
    return tuple((channel, str(column)) for channel, column in given.items())
