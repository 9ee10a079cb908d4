"""Files of each format, written by the library of its ecosystem."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

NAMES = ("shoulder", "elbow")
START = 1_700_000_000_123_456_789

JOINT_STATE = """std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""


def stamps(frame: pl.DataFrame) -> list[int]:
    """Time stamps [ns] of the rows."""
    return [START + int(v) for v in np.round(frame["time"].to_numpy() * 1e9)]


def joints(frame: pl.DataFrame) -> dict[str, np.ndarray]:
    """Position, velocity and torque of two joints, [rows, 2]; the second is the frame's."""
    return {
        name: np.stack([0.5 * frame[name].to_numpy(), frame[name].to_numpy()], axis=1)
        for name in ("position", "velocity", "torque")
    }


def state(frame: pl.DataFrame, i: int, both: dict[str, np.ndarray], stamp: int) -> dict[str, Any]:
    """One sensor_msgs/JointState as plain values."""
    return {
        "header": {
            "stamp": {"sec": stamp // 10**9, "nanosec": stamp % 10**9},
            "frame_id": "base",
        },
        "name": list(NAMES),
        "position": both["position"][i].tolist(),
        "velocity": both["velocity"][i].tolist(),
        "effort": both["torque"][i].tolist(),
    }


def mcap_ros2(path: Path, frame: pl.DataFrame, compression: str = "ZSTD") -> None:
    """An MCAP file of /joint_states and of a slower /motor with a temperature."""
    from mcap.writer import CompressionType
    from mcap_ros2.writer import Writer

    both = joints(frame)
    with open(path, "wb") as stream:
        writer = Writer(stream, compression=CompressionType[compression])
        schema = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE)
        motor = writer.register_msgdef("motor_msgs/msg/Motor", "float64 temperature\nint32[3] code")
        for i, stamp in enumerate(stamps(frame)):
            message = state(frame, i, both, stamp)
            writer.write_message("/joint_states", schema, message, stamp + 50_000, stamp)
            if i % 10 == 0:
                slow = {"temperature": 20.0 + i / 100, "code": [1, 2, 3]}
                writer.write_message("/motor", motor, slow, stamp, stamp)
        writer.finish()


def mcap_of_two_publishers(path: Path, frame: pl.DataFrame) -> None:
    """An MCAP file of /joint_states with the joints of an arm, and with those of its gripper."""
    from mcap_ros2.writer import Writer

    both = joints(frame)
    with open(path, "wb") as stream:
        writer = Writer(stream)
        schema = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE)
        for i, stamp in enumerate(stamps(frame)):
            message = state(frame, i, both, stamp)
            writer.write_message("/joint_states", schema, message, stamp, stamp)
            own = {key: [0.5 * message[key][1]] for key in ("position", "velocity", "effort")}
            gripper = {**message, "name": ["finger"], **own}
            writer.write_message("/joint_states", schema, gripper, stamp + 1000, stamp + 1000)
        writer.finish()


def mcap_json(path: Path, frame: pl.DataFrame) -> None:
    """An MCAP file of JSON messages."""
    import json

    from mcap.writer import Writer

    with open(path, "wb") as stream:
        writer = Writer(stream)
        writer.start()
        schema = writer.register_schema("drive", "jsonschema", b'{"type": "object"}')
        channel = writer.register_channel("/drive", "json", schema)
        rows = zip(
            stamps(frame), *(frame[c] for c in ("position", "velocity", "torque")), strict=True
        )
        for stamp, q, v, tau in rows:
            content = {"axis": {"position": q, "velocity": v}, "torque": tau, "mode": "run"}
            writer.add_message(channel, stamp, json.dumps(content).encode(), stamp)
        writer.finish()


def ros_bag(path: Path, frame: pl.DataFrame, kind: str) -> Path:
    """A bag of ROS 1 (``bag``), or of ROS 2 (``db3``, ``mcap``); returns the file to read."""
    from rosbags.rosbag1 import Writer as Writer1
    from rosbags.rosbag2 import StoragePlugin
    from rosbags.rosbag2 import Writer as Writer2
    from rosbags.typesys import Stores, get_typestore

    first = kind == "bag"
    store = get_typestore(Stores.ROS1_NOETIC if first else Stores.ROS2_HUMBLE)
    types = store.types
    time, header = types["builtin_interfaces/msg/Time"], types["std_msgs/msg/Header"]
    make = types["sensor_msgs/msg/JointState"]
    both, extra = joints(frame), {"seq": 0} if first else {}
    plugin = {"db3": StoragePlugin.SQLITE3, "mcap": StoragePlugin.MCAP}.get(kind)
    made = Writer1(path) if first else Writer2(path, version=9, storage_plugin=plugin)
    with made as writer:
        name = "sensor_msgs/msg/JointState"
        connection = writer.add_connection("/joint_states", name, typestore=store)
        for i, stamp in enumerate(stamps(frame)):
            own = header(stamp=time(stamp // 10**9, stamp % 10**9), frame_id="", **extra)
            values = [both[c][i].copy() for c in ("position", "velocity", "torque")]
            message = make(own, list(NAMES), *values)
            pack = store.serialize_ros1 if first else store.serialize_cdr
            writer.write(connection, stamp, pack(message, name))
    return path if first else next(path.glob(f"*.{kind}"))


def tdms(path: Path, frame: pl.DataFrame, waveform: bool = True) -> None:
    """A TDMS file with a group of fast channels, and one of slow ones."""
    from nptdms import ChannelObject, TdmsWriter

    step = float(frame["time"][1] - frame["time"][0])
    fast = {"wf_increment": step, "wf_start_offset": 0.0} if waveform else {}
    units = {"position": "rad", "velocity": "rad/s", "torque": "N.m"}
    with TdmsWriter(path) as writer:
        # In two segments, as LabVIEW writes while it measures.
        half = frame.height // 2
        for rows in (frame[:half], frame[half:]):
            writer.write_segment(
                [
                    ChannelObject(
                        "drive", name, rows[name].to_numpy(), {"unit_string": unit} | fast
                    )
                    for name, unit in units.items()
                ]
            )
        slow = {"wf_increment": 10 * step, "wf_start_offset": 0.0} if waveform else {}
        values = frame["temperature"].to_numpy()[::10]
        writer.write_segment([ChannelObject("slow", "temperature", values, slow)])


def scope(frame: pl.DataFrame, mark: str = "\t", comma: bool = True, one: bool = False) -> str:
    """An export of TwinCAT Scope after Beckhoff's description of the format.

    `one` is a time column for all channels, else each channel has its own.
    """
    names = ["ActPos", "ActVelo", "ActTorque"]
    keys = {
        "Name": names,
        "SymbolComment": [""] * 3,
        "Data-Type": ["REAL64"] * 3,
        "SampleTime[ms]": ["5"] * 3,
        "VariableSize": ["8"] * 3,
        "SymbolName": [f"MAIN.f{n}" for n in names],
        "Port": ["851"] * 3,
        "ScaleFactor": ["1"] * 3,
        "Unit": ["rad", "rad/s", "Nm"],
    }
    lines = ["Name|Bench", "File|C:\\bench.tcscopex", "Starttime of export|133964386997165000", ""]
    for key, cells in keys.items():
        lines.append("|".join([key, *cells] if one else [c for v in cells for c in (key, v)]))
    lines.append("")
    for t, q, v, tau in frame.select("time", "position", "velocity", "torque").rows():
        time = repr(t * 1e3)
        cells = [repr(q), repr(v), repr(tau)]
        row = [time, *cells] if one else [c for value in cells for c in (time, value)]
        lines.append("|".join(row).replace(".", "," if comma else "."))
    return "\n".join(["\r\n".join(lines).replace("|", mark), "EOF", ""])
