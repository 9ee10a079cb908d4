"""Logs of robots and controllers, as their own libraries write them."""

from __future__ import annotations

import sys

import numpy as np
import polars as pl
import pytest
from stribeck.base.errors import RecordingError
from stribeck.recording.load import read
from stribeck.recording.whole_file.scan import scan

from . import written


@pytest.fixture
def small(frame) -> pl.DataFrame:
    return frame.head(400)


def _same(recording, frame) -> None:
    """The channels are those of the frame, bit by bit; the time is to a nanosecond."""
    for channel in ("position", "velocity", "torque"):
        np.testing.assert_array_equal(getattr(recording, channel), frame[channel].to_numpy())
    time = frame["time"].to_numpy() - frame["time"][0]
    np.testing.assert_allclose(recording.time - recording.time[0], time, atol=2e-9)
    assert recording.gaps == 0


@pytest.mark.parametrize("compression", ["ZSTD", "LZ4", "NONE"])
def test_mcap(tmp_path, small, compression):
    path = tmp_path / "log.mcap"
    written.mcap_ros2(path, small, compression)
    with pytest.raises(RecordingError, match="2 joints side by side"):
        read(path)
    by_name = read(path, joint="elbow")
    _same(by_name, small)
    assert "joints: 0 shoulder, 1 elbow" in by_name.notes
    assert any("topics that are not read: /motor" in note for note in by_name.notes)
    ends = {"position": "position", "velocity": "velocity", "torque": "effort"}
    paths = {channel: f"/joint_states.{end}[1]" for channel, end in ends.items()}
    _same(read(path, map=paths), small)
    table = scan(path)
    assert table.joints == ("0", "1") and table.rows == 400


def test_a_topic_of_another_rate_is_put_on_the_clock_of_the_torque(tmp_path, small):
    path = tmp_path / "log.mcap"
    written.mcap_ros2(path, small)
    maps = ["torque=/joint_states.effort[1]", "velocity=/joint_states.velocity[1]"]
    recording = read(path, map=[*maps, "temperature=/motor.temperature"])
    np.testing.assert_array_equal(recording.torque[:391], small["torque"].to_numpy()[:391])
    # The temperature rises by 0.01 a row; its topic has no header and so another stamp.
    assert recording.temperature[200] == pytest.approx(22.0, abs=0.02)
    assert any("/motor.temperature (40 rows) at the times of /joint_states" in note
               for note in recording.notes)  # fmt: skip


def test_the_publisher_of_a_joint_is_chosen(tmp_path, small):
    """An arm and its gripper publish on one topic, each its own joints."""
    path = tmp_path / "log.mcap"
    written.mcap_of_two_publishers(path, small)
    with pytest.raises(RecordingError, match='`joint="shoulder"` or `joint="finger"`'):
        read(path)
    _same(read(path, joint="elbow"), small)
    finger = read(path, joint="finger")
    np.testing.assert_array_equal(finger.position, 0.5 * small["position"].to_numpy())


def test_mcap_of_json(tmp_path, small):
    path = tmp_path / "log.mcap"
    written.mcap_json(path, small)
    _same(read(path), small)


@pytest.mark.parametrize("kind", ["bag", "db3", "mcap"])
def test_bags(tmp_path, small, kind):
    path = written.ros_bag(tmp_path / ("log.bag" if kind == "bag" else "log"), small, kind)
    _same(read(path, joint="elbow"), small)


@pytest.mark.parametrize("first", [True, False])
def test_a_bag_whose_definitions_are_python(tmp_path, monkeypatch, first):
    from rosbags.rosbag1 import Writer as Writer1
    from rosbags.rosbag2 import StoragePlugin
    from rosbags.rosbag2 import Writer as Writer2

    victim = tmp_path / "ran"
    name = f"sensor_msgs/msg/A:\n    open('{victim}','w')\nclass B"
    path = tmp_path / ("log.bag" if first else "log")
    made = (
        Writer1(path) if first else Writer2(path, version=9, storage_plugin=StoragePlugin.SQLITE3)
    )
    with made as writer:
        checks = {"md5sum": "0" * 32} if first else {"rihs01": "RIHS01_" + "0" * 64}
        connection = writer.add_connection("/a", name, msgdef="float64 value", **checks)
        writer.write(connection, 1, b"\0" * 8)
    file = path if first else next(path.glob("*.db3"))
    with pytest.raises(RecordingError, match=r"no name of a type|Could not parse") as refused:
        read(file)
    assert not victim.exists() and len(str(refused.value)) < 500 and "\n" not in str(refused.value)


def test_tdms(tmp_path, small):
    path = tmp_path / "log.tdms"
    written.tdms(path, small)
    maps = ["velocity=velocity [rad/s]", "temperature=temperature"]
    recording = read(path, map=maps, unit="torque=Nm")
    np.testing.assert_array_equal(recording.velocity, small["velocity"].to_numpy()[:391])
    assert recording.temperature[100] == pytest.approx(small["temperature"][100])
    written.tdms(path, small, waveform=False)
    with pytest.raises(RecordingError, match="no time column"):
        read(path)


@pytest.mark.parametrize(
    ("mark", "comma", "one"), [("\t", True, False), ("\t", False, True), (";", True, False)]
)
def test_twincat_scope(write, small, mark, comma, one):
    path = write(written.scope(small, mark, comma, one), "scope.csv")
    maps = ["position=ActPos [rad]", "velocity=ActVelo [rad/s]", "torque=ActTorque [Nm]"]
    _same(read(path, map=maps), small)


def test_twincat_scope_with_two_sample_times(write, small):
    lines = written.scope(small, comma=False).splitlines()
    head = [line.split("\t") for line in lines]
    first = next(i for i, cells in enumerate(head) if cells[0].replace(".", "").isdigit())
    slow = [str(10.0 * i) + "\t" + str(20 + i) for i in range(200)]
    keys = {"Name": "fTemp", "SampleTime[ms]": "10", "SymbolName": "MAIN.fTemp"}
    made = []
    for i, line in enumerate(lines):
        if 3 < i < first - 1:
            made.append(f"{line}\t{head[i][0]}\t{keys.get(head[i][0], '')}")
        elif first <= i < first + 200:
            made.append(f"{line}\t{slow[i - first]}")
        else:
            made.append(line)
    path = write("\n".join(made) + "\n", "scope.csv")
    maps = ["position=ActPos [rad]", "velocity=ActVelo [rad/s]", "torque=ActTorque [Nm]"]
    recording = read(path, map=[*maps, "temperature=fTemp"])
    np.testing.assert_array_equal(recording.torque, small["torque"].to_numpy()[: len(recording)])
    assert recording.temperature[10] == pytest.approx(25.0)
    assert len(recording) == 400


@pytest.mark.parametrize("mark", [" ", ","])
def test_rtde(write, small, mark):
    rows = small.select("time", "position", "velocity", "torque").rows()
    names = [f"actual_{c}_{j}" for c in ("q", "qd", "current") for j in range(2)]
    lines = [mark.join(["timestamp", *names])]
    lines += [mark.join(map(repr, (t, 0.0, q, 0.0, v, 0.0, i))) for t, q, v, i in rows]
    path = write("\n".join(lines) + "\n", "rtde.csv")
    _same(read(path, joint="1", torque_constant=1.0), small)


def test_plotjuggler(write, small):
    rows = small.select("time", "position", "velocity", "torque").rows()
    names = ["position", "velocity", "effort"]
    lines = [",".join(["__time", *(f"/joint_states/elbow/{n}" for n in names), "/motor/temp"])]
    for i, (t, *values) in enumerate(rows):
        lines.append(
            ",".join(map(repr, (1.7e9 + t, *values))) + (f",{20 + i}" if i % 9 == 0 else ",")
        )
    path = write("\n".join(lines) + "\n", "plot.csv")
    recording = read(path, map=["temperature=/motor/temp"])
    np.testing.assert_array_equal(recording.torque, small["torque"].to_numpy())
    assert recording.gaps == 0


def test_lerobot(tmp_path, small):
    state = np.stack([small["position"], small["velocity"], small["torque"]], axis=1)
    table = pl.DataFrame(
        {
            "observation.state": pl.Series(state[:, :2].tolist(), dtype=pl.List(pl.Float64)),
            "observation.effort": pl.Series(state[:, 2:].tolist(), dtype=pl.Array(pl.Float64, 1)),
            "timestamp": small["time"],
            "episode_index": [0] * 200 + [1] * 200,
        }
    )
    path = tmp_path / "episode_000000.parquet"
    table.write_parquet(path)
    maps = ["position=observation.state[0]", "velocity=observation.state[1]"]
    recording = read(path, map=[*maps, "torque=observation.effort[0]"])
    np.testing.assert_array_equal(recording.torque, small["torque"].to_numpy())
    assert recording.runs == 2


@pytest.mark.parametrize(
    ("module", "name", "library"),
    [
        ("mcap_ros2", "log.mcap", "mcap and mcap-ros2-support"),
        ("rosbags.rosbag1", "log.bag", "rosbags"),
        ("nptdms", "log.tdms", "npTDMS"),
        ("h5py", "log.h5", "h5py"),
    ],
)
def test_a_missing_library_is_named(monkeypatch, tmp_path, module, name, library):
    for loaded in [m for m in sys.modules if m == module or m.startswith(f"{module}.")]:
        monkeypatch.delitem(sys.modules, loaded)
    monkeypatch.setitem(sys.modules, module, None)
    (tmp_path / name).write_bytes(b"anything")
    with pytest.raises(RecordingError) as refused:
        read(tmp_path / name)
    assert f"need {library}: install it with pip install 'stribeck[readers]'" in str(refused.value)
