"""Arrays of several lengths, nested structs and units in MATLAB, NumPy and HDF5 files."""

from __future__ import annotations

import numpy as np
import pytest
from stribeck.base.errors import RecordingError
from stribeck.recording.load import read

h5py = pytest.importorskip("h5py")
savemat = pytest.importorskip("scipy.io").savemat


def _log(frame, rows: int) -> dict[str, np.ndarray]:
    names = {"t": "time", "q": "position", "dq": "velocity", "tau": "torque"}
    return {short: frame[long].to_numpy()[:rows] for short, long in names.items()}


def test_longer_arrays_without_a_clock_are_named(tmp_path, frame):
    path = tmp_path / "d.mat"
    savemat(path, {**_log(frame, 500), "scope": np.arange(5000.0), "image": np.zeros((3, 4, 5))})
    recording = read(path)
    assert recording.rows == 500
    assert any("left out, not 500 long: scope (5000)" in note for note in recording.notes)
    assert any("no columns of numbers: image (3 x 4 x 5)" in note for note in recording.notes)


def test_two_recordings_of_a_file_are_asked_about(tmp_path, frame):
    path = tmp_path / "d.mat"
    savemat(path, {"slow": _log(frame, 500), "fast": _log(frame, 2000)})
    with pytest.raises(RecordingError, match="holds 2 recordings with rows of their own") as asked:
        read(path)
    assert 'choose one with `map="time=t"` or `map="time=fast.t"`' in str(asked.value)
    assert read(path, map="time=t").rows == 500
    fast = read(path, map=[f"{c}=fast.{n}" for c, n in
                           [("time", "t"), ("position", "q"), ("velocity", "dq"),
                            ("torque", "tau")]])  # fmt: skip
    np.testing.assert_array_equal(fast.torque, frame["torque"].to_numpy())
    assert read(path, map="time=fast.t").rows == 2000
    with pytest.raises(RecordingError, match="name columns of the same length"):
        read(path, map=["time=fast.t", "torque=tau"])


def test_nested_structs_and_cells(tmp_path, frame):
    path = tmp_path / "d.mat"
    own = _log(frame, 400)
    run = {"meta": {"robot": "arm", "gains": [1.0, 2.0]}, "axis": {"signals": own}}
    cells = np.empty(2, dtype=object)
    cells[:] = ["a", "b"]
    savemat(path, {"run": run, "names": cells})
    np.testing.assert_array_equal(read(path).torque, own["tau"])


@pytest.mark.parametrize("user", [0, 512])
def test_hdf5(tmp_path, frame, user):
    path = tmp_path / ("d.mat" if user else "d.h5")
    with h5py.File(path, "w", userblock_size=user) as file:
        group = file.create_group("log/axis_1")
        for name, values in _log(frame, 400).items():
            group.create_dataset(name, data=values.reshape(1, -1), compression="gzip")
        group["dq"].attrs["units"] = "deg/s"
        file["names"] = ["a", "b"]
        file["link"] = h5py.ExternalLink("/etc/passwd", "/")
        file["empty"] = h5py.Empty("f8")
    if user:
        with open(path, "r+b") as file:
            file.write(b"MATLAB 7.3 MAT-file")
    recording = read(path, trust=True)
    np.testing.assert_array_equal(recording.torque, _log(frame, 400)["tau"])
    assert recording.columns["velocity"].source == "dq [deg/s]"
    np.testing.assert_allclose(recording.velocity, np.deg2rad(_log(frame, 400)["dq"]))


def test_values_of_another_file_are_not_read(tmp_path, frame):
    other = tmp_path / "secret.bin"
    other.write_bytes(b"\0" * 3200)
    path = tmp_path / "d.h5"
    with h5py.File(path, "w") as file:
        for name, values in _log(frame, 400).items():
            file[name] = values
        file.create_dataset("z", shape=(400,), dtype="f8", external=[(str(other), 0, 3200)])
    recording = read(path)
    assert any("z (in another file)" in note for note in recording.notes)


def test_a_table_without_a_header(write, frame):
    columns = ("time", "position", "velocity", "torque")
    text = frame.select(columns).head(300).write_csv(include_header=False)
    path = write(text, "d.csv")
    with pytest.raises(RecordingError, match="name the 4 columns with `columns="):
        read(path)
    np.testing.assert_array_equal(
        read(path, columns="t,q,dq,tau").torque, frame["torque"].to_numpy()[:300]
    )
    with pytest.raises(RecordingError, match="gives 3 names, line 1 has 4 cells"):
        read(path, columns="t,q,dq")
    with pytest.raises(RecordingError, match="give each column a name of its own"):
        read(path, columns="t,q,q,tau")
    with pytest.raises(RecordingError, match="line 1 has the names of the columns"):
        read(write("time,position,velocity,torque\n" + text, "h.csv"), columns="t,q,dq,tau")
    sidecar = write('kind = "recording"\ncolumns = "t,q,dq,tau"\n', "d.csv.sidecar.toml")
    assert read(path).rows == 300 and sidecar.exists()
