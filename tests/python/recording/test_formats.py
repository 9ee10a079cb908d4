"""Every format gives the same recording; damaged files are refused with one sentence."""

from __future__ import annotations

import hashlib

import numpy as np
import polars as pl
import pytest
from stribeck.base.errors import RecordingError, StribeckError
from stribeck.recording.load import read


def _save(frame, path):
    columns = {name: frame[name].to_numpy() for name in frame.columns}
    if path.suffix in (".csv", ".txt"):
        frame.write_csv(path)
    elif path.suffix == ".tsv":
        frame.write_csv(path, separator="\t")
    elif path.suffix == ".parquet":
        frame.write_parquet(path)
    elif path.suffix in (".arrow", ".feather"):
        frame.write_ipc(path)
    elif path.suffix == ".arrows":
        frame.write_ipc_stream(path)
    elif path.suffix == ".npz":
        np.savez(path, **columns)
    elif path.suffix == ".mat":
        from scipy.io import savemat

        savemat(path, {k: v.reshape(-1, 1) for k, v in columns.items()} | {"scalar": 3.0})


@pytest.mark.parametrize(
    "name",
    ["d.csv", "d.tsv", "d.txt", "d.parquet", "d.arrow", "d.feather", "d.arrows", "d.npz", "d.mat"],
)
def test_round_trip(tmp_path, frame, name):
    path = tmp_path / name
    _save(frame, path)
    recording = read(path)
    for channel in (
        "time",
        "position",
        "velocity",
        "acceleration",
        "torque",
        "load_torque",
        "temperature",
    ):
        values = getattr(recording, channel)
        np.testing.assert_array_equal(values, frame[channel].to_numpy())
        assert (
            values.dtype == np.float64 and values.flags.c_contiguous and not values.flags.writeable
        )
    assert recording.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    assert recording.rate_hz == pytest.approx(200.0)
    assert recording.gaps == 0 and recording.rows_dropped == 0


def test_struct_and_matrix_in_mat(tmp_path, frame):
    from scipy.io import savemat

    path = tmp_path / "s.mat"
    q = np.stack([frame["position"].to_numpy(), frame["position"].to_numpy() * 2], axis=1)
    savemat(
        path, {"log": {"t": frame["time"].to_numpy(), "q": q, "tau": frame["torque"].to_numpy()}}
    )
    with pytest.raises(RecordingError, match="2 joints side by side"):
        read(path)
    recording = read(path, map=("position=q_2",))
    np.testing.assert_array_equal(recording.position, q[:, 1])


def test_mat_73_needs_h5py_or_reads(tmp_path, frame):
    path = tmp_path / "v73.mat"
    try:
        import h5py
    except ImportError:
        path.write_bytes(b"MATLAB 7.3 MAT-file, Platform" + b" " * 600)
        with pytest.raises(RecordingError, match="needs h5py"):
            read(path)
        return
    with h5py.File(path, "w", userblock_size=512) as file:
        for name in frame.columns:
            file[name] = frame[name].to_numpy().reshape(1, -1)
    with open(path, "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file")
    np.testing.assert_array_equal(read(path).torque, frame["torque"].to_numpy())


def test_csv_dialects(write, frame):
    small = frame.head(200)
    expected = small["torque"].to_numpy()
    european = small.write_csv(separator=";").replace(".", ",")
    np.testing.assert_array_equal(read(write(european, "eu.csv")).torque, expected)
    commented = "# logged on bench 3\n" + small.write_csv()
    np.testing.assert_array_equal(read(write(commented, "c.csv")).torque, expected)
    header_in_comment = "# " + small.write_csv(separator="\t")
    np.testing.assert_array_equal(read(write(header_in_comment, "h.txt")).torque, expected)
    padded = small.write_csv().replace(",", ", ")
    np.testing.assert_array_equal(read(write(padded, "p.csv")).torque, expected)
    bom = b"\xef\xbb\xbf" + small.write_csv().replace("\n", "\r\n").encode()
    np.testing.assert_array_equal(read(write(bom, "b.csv")).torque, expected)
    blanks = small.write_csv(separator=" ")
    np.testing.assert_array_equal(read(write(blanks, "w.txt")).torque, expected)
    ended = small.write_csv(separator=" ", include_header=False).replace("\n", " \n")
    names = ",".join(small.columns)
    np.testing.assert_array_equal(read(write(ended, "e.txt"), columns=names).torque, expected)


@pytest.mark.parametrize("name", ["t.parquet", "t.arrow", "t.npz", "t.mat"])
def test_truncated(tmp_path, frame, name):
    path = tmp_path / name
    _save(frame, path)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    with pytest.raises(RecordingError, match=r"is not a whole .* file .*again") as refused:
        read(path)
    assert str(path) in str(refused.value) and "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("e.csv", b"", "the file is empty"),
        ("e.parquet", b"", "the file is empty"),
        ("h.csv", b"time,velocity,torque\n", "no rows of data"),
        ("n.csv", b"0.0,1.0,2.0\n0.1,1.0,2.0\n", "line 1 holds numbers where the column names"),
        ("d.csv", b"time,velocity,velocity,torque\n0,1,1,1\n", "both called 'velocity'"),
        ("r.csv", b"time,velocity,torque\n0,1,2\n1,2,3,4\n", r"row 2 \(line 3\) has 4 cells"),
        ("x.parquet", b"time,velocity,torque\n0,1,2\n", "not a whole Parquet"),
        ("x.csv", b"PAR1\0\0\0\0", "is a binary file"),
        ("x.xlsx", b"PK..", "'.xlsx' files are not known"),
        ("noext", b"time", "without an extension"),
        ("x.mcap", b"\x89MCAP", "not a whole MCAP file"),
        ("x.npz", b"PK nonsense", "not a whole .npz"),
    ],
)
def test_damaged(write, name, content, sentence):
    with pytest.raises(RecordingError, match=sentence) as refused:
        read(write(content, name))
    assert isinstance(refused.value, StribeckError) and isinstance(refused.value, ValueError)
    assert name in str(refused.value) and "\n" not in str(refused.value)


def test_no_such_file_and_directory(tmp_path, frame):
    frame.write_parquet(tmp_path / "joint_1.parquet")
    with pytest.raises(RecordingError, match=r"no such file; did you mean 'joint_1.parquet'\?"):
        read(tmp_path / "joint_l.parquet")
    # The same ending does not make a name similar.
    with pytest.raises(RecordingError, match=r"no such file$"):
        read(tmp_path / "arms.parquet")
    (tmp_path / "empty").mkdir()
    with pytest.raises(RecordingError, match="there are no recordings in this folder"):
        read(tmp_path / "empty")


def test_dates_are_time(write, frame):
    stamps = pl.from_epoch((frame["time"] * 1e6).round().cast(pl.Int64), time_unit="us")
    recording = read(write(frame.with_columns(stamps.alias("time"))))
    np.testing.assert_allclose(recording.time, frame["time"].to_numpy(), atol=1e-9)
