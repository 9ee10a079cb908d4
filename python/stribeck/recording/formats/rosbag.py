"""Bags of ROS 1 and ROS 2."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.door import Asked, Entered, missing_library
from stribeck.recording.formats.messages import Topics
from stribeck.recording.formats.part import Read

if TYPE_CHECKING:
    from rosbags.interfaces import Connection
    from rosbags.typesys.store import Typestore

__all__ = ["read_bag"]

#: Names of types and of their fields.
_TYPE = re.compile(r"[A-Za-z]\w*(/[A-Za-z]\w*){1,3}", re.ASCII)
_FIELD = re.compile(r"[A-Za-z_]\w*", re.ASCII)


def read_bag(file: Entered, asked: Asked) -> Read:
    """The topics of a .bag file (ROS 1) or of a .db3 file (ROS 2), message by message.

    Raises
    ------
    RecordingError
        The file is damaged or too large, or rosbags is not installed.
    """
    try:
        from rosbags.rosbag1 import Reader as Reader1
        from rosbags.rosbag2 import Reader as Reader2
    except ImportError:
        raise missing_library(file.name, "bag", "rosbags") from None
    if file.compressed:
        raise RecordingError(f"{file.name}: bags are read as they are: decompress it (gunzip)")
    first = file.suffix == ".bag"
    kind: Any = Reader1 if first else Reader2
    try:
        with kind(file.path) as reader:
            kinds = {c.topic: c.msgtype for c in reader.connections}
            topics = Topics(file, kinds, asked)
            wanted = [c for c in reader.connections if c.topic in topics.wanted]
            store = _types(file, wanted, first)
            decode: Callable[[bytes, str], object] = (
                store.deserialize_ros1 if first else store.deserialize_cdr
            )
            # Without connections, the library would read all of them.
            for connection, recorded, data in reader.messages(wanted) if wanted else ():
                topics.add(connection.topic, decode(data, connection.msgtype), recorded)
        return topics.read()
    except RecordingError:
        raise
    except Exception as error:  # the library raises many kinds on damaged files
        remedy = "copy it again, or index it anew (rosbag reindex, ros2 bag reindex)"
        raise file.damaged("bag", error, remedy) from None


def _types(file: Entered, connections: list[Connection], first: bool) -> Typestore:
    """The types of the messages: those of the file, else those of ROS 2."""
    from rosbags.interfaces import MessageDefinitionFormat as Format
    from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

    found: dict[str, Any] = {}
    for connection in connections:
        _check_type(file, connection.msgtype)
        definition = connection.msgdef
        if definition.format == Format.MSG:
            found.update(get_types_from_msg(definition.data, connection.msgtype))
        elif definition.format == Format.IDL:
            mark = "=" * 80 + "\n"
            for part in definition.data.split(mark):
                text = part.split("\n", 1)[1] if part.startswith("IDL: ") else part
                if text.strip():
                    found.update(get_types_from_idl(text))
    if not found:
        # Bags of ROS 2 before Iron have no definitions; these types have not changed since.
        return get_typestore(Stores.ROS1_NOETIC if first else Stores.ROS2_HUMBLE)
    _check_definitions(file, found)
    store = get_typestore(Stores.EMPTY)
    store.register(found)
    return store


def _check_definitions(file: Entered, found: Mapping[str, Any]) -> None:
    """Refuse names that are none: rosbags makes Python classes of the definitions and runs them."""
    for name, (constants, fields) in found.items():
        _check_type(file, name)
        for field, *_ in (*constants, *fields):
            if not _FIELD.fullmatch(str(field)):
                raise RecordingError(
                    f"{file.name}: a field of {name} is called {str(field)[:40]!r}, which is no "
                    "name: record it again"
                )
        for _, description in fields:
            _check_reference(file, description)


def _check_reference(file: Entered, description: Any) -> None:
    """Check the types that a field refers to."""
    for item in description[1:]:
        if isinstance(item, tuple):
            _check_reference(file, ("", *item))
        elif isinstance(item, str) and "/" in item:
            _check_type(file, item)
        elif isinstance(item, str) and item and not _FIELD.fullmatch(item):
            raise RecordingError(
                f"{file.name}: {item[:40]!r} is no name of a type: record it again"
            )


def _check_type(file: Entered, name: str) -> None:
    if not _TYPE.fullmatch(name):
        raise RecordingError(f"{file.name}: {name[:40]!r} is no name of a type: record it again")
