"""Messages of topics as parts: one row for each message, one column for each number in it."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.door import Asked, Entered
from stribeck.recording.formats.part import Part, Read, chosen

__all__ = ["Topics"]

#: Longest array of numbers whose places are columns, and longest list of messages.
_LONGEST, _LONGEST_LIST = 64, 16
#: Deepest message in messages.
_DEEPEST = 8
#: Messages after which memory is looked at; kinds of messages that one topic may have.
_LOOK, _KINDS = 4096, 32
#: Types that hold the motion of joints, the most telling first.
_JOINTS = ("JointState", "DynamicJointState", "JointTrajectoryControllerState")
#: Types that hold no channels, and take long to decode.
_HEAVY = ("Image", "CompressedImage", "PointCloud2", "LaserScan", "OccupancyGrid", "TFMessage")
#: Nanoseconds of a second.
_SECOND = 1_000_000_000


class Topics:
    """The topics of a file that are read.

    Parameters
    ----------
    kinds
        Topic -> name of its type.
    """

    def __init__(self, file: Entered, kinds: Mapping[str, str], asked: Asked) -> None:
        self.file, self.asked = file, asked
        self.kinds = {topic: kind.rsplit("/", 1)[-1] for topic, kind in kinds.items()}
        self.wanted = self._wanted()
        self.rows = {topic: _Topic(file, topic, self.kinds[topic]) for topic in self.wanted}
        self.origin: int | None = None

    def _wanted(self) -> tuple[str, ...]:
        """Those asked for; else those of joints; else all that are not images or the like."""
        asked = [t for t in self.kinds if self.asked.mentions(f"{t}.")]
        joints = [t for t, kind in self.kinds.items() if kind == _JOINTS[0]]
        joints = joints or [t for t, kind in self.kinds.items() if kind in _JOINTS]
        return tuple(asked or joints or [t for t, k in self.kinds.items() if k not in _HEAVY])

    def add(self, topic: str, message: object, recorded: int) -> None:
        """Enter a message that was recorded at a time [ns]."""
        self.rows[topic].add(message, recorded)

    def read(self) -> Read:
        """The table of the topic that holds what was asked.

        Raises
        ------
        RecordingError
            No message holds numbers, or what was asked is in topics that do not fit together.
        """
        stamps = [kind.stamps[0] for topic in self.rows.values() for kind in topic.kinds.values()]
        origin = min(stamps, default=0)
        parts = [part for topic in self.rows.values() for part in topic.parts(origin)]
        if not parts:
            there = ", ".join(f"{t} ({k})" for t, k in [*self.kinds.items()][:6]) or "none"
            raise RecordingError(
                f"{self.file.name}: no message holds numbers of a joint; its topics are {there}"
            )
        read = chosen(self.file, parts, self.asked)
        notes = list(read.notes)
        if read.joints:
            named = ", ".join(f"{index} {name}" for name, index in read.joints.items())
            notes.append(f"joints: {named}")
        for topic in self.rows.values():
            notes += topic.notes
        others = [t for t in self.kinds if t not in self.wanted]
        if others:
            more = f" and {len(others) - 6} more" if len(others) > 6 else ""
            notes.append(f"topics that are not read: {', '.join(others[:6])}{more}")
        return Read(read.table, tuple(notes), joints=read.joints)


@dataclass
class _Kind:
    """Messages of a topic whose arrays have the same lengths and joints."""

    scalars: Callable[[Any], Any] | None
    single: bool
    arrays: list[Callable[[Any], Any]]
    names: list[str]
    joints: tuple[str, ...]
    stamps: array[int] = field(default_factory=lambda: array("q"))
    values: array[float] = field(default_factory=lambda: array("d"))

    def add(self, message: object, arrays: Sequence[Any], stamp: int) -> None:
        self.stamps.append(stamp)
        values = self.values
        if self.scalars is not None:
            found = self.scalars(message)
            if self.single:
                values.append(found)
            else:
                values.extend(found)
        for own in arrays:
            if isinstance(own, np.ndarray):
                values.frombytes(own.astype(np.float64).tobytes())
            else:
                values.extend(own)


class _Topic:
    """The messages of one topic."""

    def __init__(self, file: Entered, topic: str, type_name: str) -> None:
        self.file, self.topic, self.type_name = file, topic, type_name
        self.kinds: dict[object, _Kind] = {}
        self.notes: list[str] = []
        self.plan: _Plan | None = None
        self.count = 0

    def add(self, message: object, recorded: int) -> None:
        if self.plan is None:
            self.plan = _Plan.of(message, self.type_name)
        plan = self.plan
        arrays = [get(message) for get in plan.arrays]
        joints = tuple(plan.joints(message)) if plan.joints is not None else ()
        key = (tuple(map(len, arrays)), joints)
        kind = self.kinds.get(key)
        if kind is None:
            if len(self.kinds) == _KINDS:
                raise RecordingError(
                    f"{self.file.name}: the messages of {self.topic} have arrays of changing "
                    "lengths, which are no columns: name columns of another topic"
                )
            kind = self.kinds[key] = plan.kind(message, arrays, joints)
        stamp = plan.stamp(message) if plan.stamp is not None else 0
        kind.add(message, arrays, stamp or recorded)
        self.count += 1
        if self.count % _LOOK == 0:
            size = sum(len(k.values) + len(k.stamps) for k in self.kinds.values())
            self.file.refuse_above(8 * size, f"topic {self.topic}")

    def parts(self, origin: int) -> Iterator[Part]:
        """A part for the joints of each publisher, or for the most frequent kind of message."""
        kinds = [kind for kind in self.kinds.values() if kind.names]
        if not kinds:
            return
        every = list(dict.fromkeys(joint for kind in kinds for joint in kind.joints))
        most = max(len(kind.stamps) for kind in kinds)
        taken: set[tuple[str, ...]] = set()
        for kind in sorted(kinds, key=lambda k: -len(k.stamps)):
            if kind.joints in taken or (not every and len(kind.stamps) < most):
                self.notes.append(
                    f"{len(kind.stamps)} messages of {self.topic} left out, with other lengths than"
                    f" the others"
                )
                continue
            taken.add(kind.joints)
            yield self._part(kind, every, origin)

    def _part(self, kind: _Kind, every: list[str], origin: int) -> Part:
        rows = np.frombuffer(kind.values, dtype=np.float64).reshape(len(kind.stamps), -1)
        # The difference is taken before the rounding: seconds since 1970 lose microseconds.
        time = (np.frombuffer(kind.stamps, dtype=np.int64) - origin) * 1e-9
        columns = {"time": time}
        for i, name in enumerate(kind.names):
            columns[f"{self.topic}.{_indexed(name, kind.joints, every)}"] = rows[:, i]
        joints = {joint: str(every.index(joint)) for joint in kind.joints}
        return Part(self.topic, pl.DataFrame(columns), "time", joints)


def _indexed(name: str, joints: tuple[str, ...], every: list[str]) -> str:
    """The name with the index of its joint among those of all publishers."""
    if not joints or not name.endswith("]"):
        return name
    stem, _, index = name[:-1].rpartition("[")
    place = int(index)
    return f"{stem}[{every.index(joints[place])}]" if place < len(joints) else name


@dataclass
class _Plan:
    """Where the numbers of a topic's messages are, from its first message."""

    scalars: list[str]
    arrays: list[Callable[[Any], Any]]
    array_names: list[str]
    joints: Callable[[Any], Any] | None
    stamp: Callable[[Any], int] | None
    named: Callable[[Any], list[str]] | None = None

    @classmethod
    def of(cls, message: object, type_name: str) -> _Plan:
        if type_name == "DynamicJointState":
            return cls(
                [], [_interface_values], [""], attrgetter("joint_names"), _stamp_of(message),
                _interface_names,
            )  # fmt: skip
        plan = cls([], [], [], None, _stamp_of(message))
        _walk(plan, message, "", 0)
        own = "name" if type_name == "JointState" else "joint_names"
        if isinstance(_get(message, own), list) and type_name in _JOINTS:
            plan.joints = _getter(own, message)
        return plan

    def kind(self, message: object, arrays: Sequence[Any], joints: tuple[str, ...]) -> _Kind:
        names = list(self.scalars)
        if self.named is not None:
            names += self.named(message)
        else:
            for name, values in zip(self.array_names, arrays, strict=True):
                names += [f"{name}[{i}]" for i in range(len(values))]
        getter = None
        if self.scalars:
            getter = _getters(self.scalars, message)
        return _Kind(getter, len(self.scalars) == 1, self.arrays, names, joints)


def _walk(plan: _Plan, value: object, path: str, depth: int) -> None:
    """Enter the numbers of a message, and of the messages in it, into the plan."""
    if depth > _DEEPEST:
        return
    for name, inner in _fields(value):
        own = f"{path}.{name}" if path else name
        if name == "header" and depth == 0:
            continue
        if isinstance(inner, bool | int | float | np.number):
            plan.scalars.append(own)
        elif isinstance(inner, list | tuple | np.ndarray):
            root: object = None
            if not len(inner) or isinstance(inner[0], int | float | np.number):
                if len(inner) <= _LONGEST and not isinstance(inner, bytes):
                    plan.arrays.append(_getter(own, value, path))
                    plan.array_names.append(own)
            elif _is_message(inner[0]) and len(inner) <= _LONGEST_LIST:
                for i, item in enumerate(inner):
                    _walk_item(plan, item, own, i, root)
        elif _is_message(inner):
            _walk(plan, inner, own, depth + 1)


def _walk_item(plan: _Plan, item: object, path: str, i: int, root: object) -> None:
    """Enter the numbers of one message of a list."""
    for name, inner in _fields(item):
        if isinstance(inner, bool | int | float | np.number):
            plan.arrays.append(_item_getter(path, i, name, one=True))
            plan.array_names.append(f"{path}[{i}].{name}")
        elif isinstance(inner, list | np.ndarray) and len(inner) <= _LONGEST:
            if not len(inner) or isinstance(inner[0], int | float | np.number):
                plan.arrays.append(_item_getter(path, i, name, one=False))
                plan.array_names.append(f"{path}[{i}].{name}")


def _item_getter(path: str, i: int, name: str, *, one: bool) -> Callable[[Any], Any]:
    steps = path.split(".")

    def get(message: object) -> Any:
        for step in steps:
            message = _get(message, step)
        items: Any = message
        if i >= len(items):
            return []
        value = _get(items[i], name)
        return [value] if one else value

    return get


def _is_message(value: object) -> bool:
    return isinstance(value, dict) or hasattr(value, "__slots__") or hasattr(value, "__dict__")


def _fields(value: object) -> list[tuple[str, Any]]:
    """The fields of a message, of any of the libraries."""
    if isinstance(value, dict):
        return [(str(k), v) for k, v in value.items()]
    names = getattr(type(value), "__slots__", None) or list(getattr(value, "__dict__", ()))
    return [(name, getattr(value, name)) for name in names if not name.startswith("_")]


def _get(value: Any, name: str) -> Any:
    return value.get(name) if isinstance(value, dict) else getattr(value, name, None)


def _getter(path: str, message: object, inside: str = "") -> Callable[[Any], Any]:
    """What takes the value at a path out of a message; a list that is not there is empty."""
    if not isinstance(message, dict):
        return attrgetter(path)
    steps = path.split(".")

    def get(value: Any) -> Any:
        for step in steps:
            value = value.get(step) if isinstance(value, dict) else None
        return [] if value is None else value

    return get


def _getters(paths: list[str], message: object) -> Callable[[Any], Any]:
    if not isinstance(message, dict):
        return attrgetter(*paths)
    each = [_getter(path, message) for path in paths]

    def one(get: Callable[[Any], Any], value: Any) -> float:
        found = get(value)
        return float(found) if isinstance(found, bool | int | float) else float("nan")

    if len(each) == 1:
        return lambda value: one(each[0], value)
    return lambda value: [one(get, value) for get in each]


def _stamp_of(message: object) -> Callable[[Any], int] | None:
    """What takes the time stamp [ns] out of a header; None where the messages have none."""
    stamp = _get(_get(message, "header"), "stamp")
    if stamp is None or _get(stamp, "sec") is None:
        return None
    if isinstance(message, dict):
        return lambda m: (
            int(m["header"]["stamp"]["sec"]) * _SECOND
            + int(m["header"]["stamp"].get("nanosec", m["header"]["stamp"].get("nsec", 0)))
        )
    both = attrgetter("header.stamp.sec", "header.stamp.nanosec")

    def get(message: Any) -> int:
        seconds, rest = both(message)
        return int(seconds) * _SECOND + int(rest)

    return get


def _interface_values(message: Any) -> list[float]:
    """The values of ros2_control's interfaces, joint by joint."""
    return [float(v) for joint in message.interface_values for v in joint.values]


def _interface_names(message: Any) -> list[str]:
    return [
        f"{name}[{i}]"
        for i, joint in enumerate(message.interface_values)
        for name in joint.interface_names
    ]
