"""Files made to exhaust or to run something are refused with one short line."""

from __future__ import annotations

import gzip
import io
import os
import pickle
import socket
import struct
import subprocess
import sys
import textwrap
import zipfile
import zlib

import numpy as np
import polars as pl
import pytest
from stribeck.base.errors import RecordingError
from stribeck.recording.load import read

posix = pytest.mark.skipif(sys.platform == "win32", reason="pipes, devices and limits of POSIX")
HEADER = "time,position,velocity,torque\n"
ROWS = "".join(f"{i / 100},{i},1.0,{i % 3}\n" for i in range(50))


def _refused(path, sentence, **options):
    with pytest.raises(RecordingError, match=sentence) as refused:
        read(path, **options)
    text = str(refused.value)
    assert len(text) <= 500 and "\n" not in text and str(path) in text
    return text


@posix
def test_what_is_no_regular_file(tmp_path):
    os.mkfifo(tmp_path / "pipe.csv")
    _refused(tmp_path / "pipe.csv", "not a regular file")
    os.symlink("/dev/zero", tmp_path / "zero.csv")
    _refused(tmp_path / "zero.csv", "not a regular file")
    own = socket.socket(socket.AF_UNIX)
    own.bind(str(tmp_path / "s.csv"))
    _refused(tmp_path / "s.csv", "not a regular file")
    own.close()
    os.symlink(tmp_path / "round.csv", tmp_path / "round.csv")
    _refused(tmp_path / "round.csv", "cannot be read")
    with pytest.raises(RecordingError):
        read(tmp_path / ("a" * 300 + ".csv"))
    with pytest.raises(RecordingError):
        read("a\0b.csv")


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("1" * 50_000_000, "line 1 has more than 1000000 characters"),
        (HEADER + ROWS + "1" * 50_000_000, "line 52 has more than 1000000 characters"),
        (",".join(f"c{i}" for i in range(120_000)) + "\n", "120000 columns, at most 10000"),
        (HEADER + ROWS + '0.5,"1,1,1\n0.6,1,1,1\n', r"line 52 has a quote that is not closed"),
        (HEADER + ROWS + '0.5,1,"' + "x" * 140_000 + '",1\n', "more than 131072 characters"),
        (HEADER + ROWS + "0.5,1,1," + "x" * 140_000 + "\n", "'x{40}' is not a number"),
        ("x" * 140_000 + "," + HEADER + "1," + ROWS, "name of a column has 140000 characters"),
        (HEADER + ROWS + "0.5,1\n0.6,1,1,1\n", r"row 51 \(line 52\) has 2 cells"),
        (HEADER + ROWS * 9 + "0.5,1,1,1\0\n", "holds NUL characters"),
        (HEADER + "\n" * 100_000, "no rows of data"),
    ],
    ids="line last-line columns quote quoted-cell cell name short nul blank".split(),
)
def test_text(write, content, sentence):
    _refused(write(content, "d.csv"), sentence)


def test_a_wide_file_is_refused_at_once_with_a_short_line(write):
    line = ",".join(f"c{i}" for i in range(300_000)) + "\n"
    _refused(write(line + "1," * 299_999 + "1\n", "wide.csv"), "line 1 has more than 1000000")
    frame = pl.DataFrame({f"c{i}": [1.0] for i in range(11_000)})
    path = write(frame, "wide.parquet")
    _refused(path, "has 11000 columns, at most 10000 are read")


def test_messages_do_not_list_thousands_of_columns(write):
    frame = pl.DataFrame({f"c{i}": [1.0, 2.0] for i in range(5000)})
    path = write(frame, "many.parquet")
    _refused(path, "no time column")
    _refused(path, "no column 'x'", map="velocity=x")
    _refused(path, "no column 'x'", unit="x=rpm")
    _refused(path, "zz", derive="torque=zz*2")


def test_a_line_that_was_cut_off_is_left_out_and_said(write):
    recording = read(write(HEADER + ROWS + "0.5,1", "d.csv"))
    assert recording.rows == 50
    assert "the last line is cut off after 2 cells and left out" in recording.notes


def test_damaged_gzip(write, tmp_path):
    whole = gzip.compress((HEADER + ROWS * 50).encode())
    for name, content in {
        "cut.csv.gz": whole[: len(whole) // 2],
        "flipped.csv.gz": whole[:60] + bytes(b ^ 255 for b in whole[60:80]) + whole[80:],
        "none.csv.gz": b"time,position\n",
        "tail.csv.gz": whole + b"rubbish",
    }.items():
        _refused(write(content, name), "is not a whole gzip file")
    good = tmp_path / "good.csv.gz"
    good.write_bytes(gzip.compress((HEADER + ROWS).encode()))
    assert read(good).rows == 50


def test_pickles_are_not_read(tmp_path):
    victim = tmp_path / "ran"

    class Evil:
        def __reduce__(self):
            return (open, (str(victim), "w"))

    path = tmp_path / "evil.npz"
    np.savez(path, time=np.array([Evil()], dtype=object))
    _refused(path, "holds Python objects, which can run code")
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("time.npy", pickle.dumps(Evil()))
    _refused(path, "is not a whole .npz file")
    assert not victim.exists()


def _npy(shape: str, data: bytes) -> bytes:
    header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}"
    header = header.ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + data


def test_an_array_that_says_it_is_larger_than_it_is(tmp_path):
    path = tmp_path / "d.npz"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("time.npy", _npy("(1000000000000,)", b"\0" * 80))
    _refused(path, "shorter than its header says")
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("time.npy", _npy("(" * 3000, b""))
    _refused(path, "is not a whole .npz file")


def _mat(inner: bytes) -> bytes:
    packed = zlib.compress(inner)
    header = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
    return header + struct.pack("<II", 15, len(packed)) + packed


#: Run under a limit of memory: writes each bomb, reads it, prints what was said.
BOMBS = """
import gzip, io, os, resource, struct, sys, zipfile, zlib
import numpy as np, polars as pl, h5py
from stribeck.base.errors import RecordingError
from stribeck.recording.load import read

os.chdir(sys.argv[1])
rows = b"0.001,1,1,1\\n" * 100_000
with gzip.open("text.csv.gz", "wb", compresslevel=1) as stream:
    stream.write(b"time,position,velocity,torque\\n")
    for _ in range(2000):
        stream.write(rows)
zeros = bytes(1 << 24)
with zipfile.ZipFile("zeros.npz", "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
    with archive.open("time.npy", "w", force_zip64=True) as stream:
        np.lib.format.write_array_header_1_0(
            stream, {"descr": "<f8", "fortran_order": False, "shape": (128 << 21,)})
        for _ in range(128):
            stream.write(zeros)
inner = struct.pack("<IIIIIIIIII", 14, (1 << 31) - 64, 6, 8, 6, 0, 5, 8, 1, (1 << 28) - 16)
inner += struct.pack("<II", 4, 0x656D6974) [4:] + struct.pack("<II", 9, (1 << 31) - 128)
made = zlib.compressobj(1)
packed = made.compress(inner) + b"".join(made.compress(zeros) for _ in range(127)) + made.flush()
with open("zeros.mat", "wb") as stream:
    stream.write(b"MATLAB 5.0 MAT-file".ljust(124) + b"\\x00\\x01IM")
    stream.write(struct.pack("<II", 15, len(packed)) + packed)
with h5py.File("fill.h5", "w") as file:
    file.create_dataset("time", shape=(1 << 40,), dtype="f8", chunks=(1024,), fillvalue=1.0)
with h5py.File("fill.mat", "w", userblock_size=512) as file:
    file.create_dataset("time", shape=(1 << 20, 1 << 20), dtype="f8", chunks=(64, 64))
with open("fill.mat", "r+b") as file:
    file.write(b"MATLAB 7.3 MAT-file")
constant = pl.select(pl.repeat(1.0, 1 << 24).alias("time"))
pl.concat([constant.lazy()] * 20).sink_parquet("constant.parquet", compression="zstd")

limit = 3 << 30
resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
for name in ("text.csv.gz", "zeros.npz", "zeros.mat", "fill.h5", "fill.mat", "constant.parquet"):
    try:
        read(name)
        print(name, "READ")
    except RecordingError as error:
        print(error)
"""


@posix
@pytest.mark.slow
def test_bombs_are_refused_within_3_gigabytes(tmp_path):
    pytest.importorskip("h5py")
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(BOMBS), str(tmp_path)],
        capture_output=True, text=True, timeout=600, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    lines = done.stdout.splitlines()
    assert len(lines) == 6 and not done.stderr
    for line in lines:
        assert "GB of memory, the limit: give `memory_limit" in line and len(line) <= 500, line


def test_the_limit_is_raised_and_lowered_by_an_option(write, tmp_path):
    path = write(HEADER + ROWS, "d.csv")
    _refused(path, "needs more than 1e-06 GB of memory", memory_limit=1e-6)
    assert read(path, memory_limit=1.0).rows == 50
    packed = tmp_path / "d.csv.gz"
    packed.write_bytes(gzip.compress((HEADER + ROWS * 1000).encode()))
    _refused(packed, "the decompressed file needs more", memory_limit=1e-4)
    np.savez_compressed(tmp_path / "d.npz", time=np.zeros(100_000))
    _refused(tmp_path / "d.npz", "what the arrays hold needs more", memory_limit=1e-4)
    for name in ("d.parquet", "d.arrow"):
        frame = pl.DataFrame({"time": np.zeros(100_000)})
        (frame.write_parquet if name.endswith("t") else frame.write_ipc)(tmp_path / name)
        _refused(tmp_path / name, "GB of memory", memory_limit=1e-4)


def test_a_compressed_mat_file_is_measured_before_it_is_read(tmp_path):
    from scipy.io import savemat

    path = tmp_path / "d.mat"
    savemat(path, {"time": np.zeros(1_000_000)}, do_compression=True)
    assert path.stat().st_size < 50_000
    _refused(path, "what the arrays hold needs more", memory_limit=1e-3)
    path.write_bytes(_mat(struct.pack("<II", 14, 0xFFFFFFF0) + b"\0" * 100))
    _refused(path, "is not a whole .mat file|holds no arrays")


@pytest.mark.parametrize("suffix", [".parquet", ".arrow", ".mat", ".npz", ".h5", ".tdms", ".mcap",
                                    ".bag", ".db3", ".csv", ".arrows"])  # fmt: skip
def test_random_bytes_and_nothing_on_the_terminal(tmp_path, suffix, capfd):
    rng = np.random.default_rng(7)
    starts = {
        ".parquet": b"PAR1",
        ".arrow": b"ARROW1\0\0",
        ".mat": b"MATLAB 5.0 MAT-file".ljust(124) + b"\0\1IM",
        ".npz": b"PK\3\4",
        ".h5": b"\x89HDF\r\n\x1a\n",
        ".tdms": b"TDSm",
        ".mcap": b"\x89MCAP0\r\n",
        ".bag": b"#ROSBAG V2.0\n",
        ".db3": b"SQLite format 3\0",
    }
    path = tmp_path / f"d{suffix}"
    for _ in range(5):
        body = rng.integers(0, 256, 3000, dtype=np.uint8).tobytes()
        path.write_bytes(starts.get(suffix, b"") + body + starts.get(suffix, b"")[:4])
        _refused(path, ".")
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("kind", ["parquet", "arrow"])
def test_lists(tmp_path, kind):
    ragged = pl.DataFrame({
        "time": [0.0, 0.1, 0.2], "velocity": [1.0, 1.0, 1.0], "torque": [[1.0], [1.0, 2.0], []],
        "nested": [[[1.0]], [[2.0]], [[3.0]]], "pair": [{"a": 1.0, "b": [1, 2]}] * 3,
        "raw": [b"a", b"b", b"c"],
    })  # fmt: skip
    path = tmp_path / f"d.{kind}"
    (ragged.write_parquet if kind == "parquet" else ragged.write_ipc)(path)
    _refused(path, "no torque column.*pair.a, pair.b\\[0\\], pair.b\\[1\\]")


def test_a_parquet_file_that_lies_about_its_footer(write):
    stream = io.BytesIO()
    pl.DataFrame({"time": [1.0, 2.0]}).write_parquet(stream)
    data = bytearray(stream.getvalue())
    for at in range(4, len(data) - 8, 7):
        damaged = bytearray(data)
        damaged[at] ^= 0xFF
        path = write(bytes(damaged), "d.parquet")
        with pytest.raises(RecordingError) as refused:
            read(path)
        assert len(str(refused.value)) <= 500
