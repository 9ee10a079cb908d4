"""Times and memory of each reader beside those of the library that it uses.

    python benches/readers/readers.py [--rows 1000000] [FORMAT ...]

Each file is written by its ecosystem's library (`tests/python/recording/formats/written.py`) and
read back in a process of its own: by the library alone, every value once, and by `read_table`, with
its checks and the hash of the file. What comes back is compared with what was written. Times are of
the processor: the load of the computer does not matter.
"""

from __future__ import annotations

import argparse
import io
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "python" / "recording"))

import numpy as np  # noqa: E402
import polars as pl  # noqa: E402
from formats import written  # noqa: E402

COLUMNS = ("time", "position", "velocity", "torque")


def frame(rows: int) -> pl.DataFrame:
    """A motion with noise: numbers with all their digits, as they are measured."""
    rng = np.random.default_rng(0)
    time_ = np.arange(rows) / 1000.0
    own = {name: np.sin(time_) + 1e-3 * rng.standard_normal(rows) for name in COLUMNS[1:]}
    return pl.DataFrame({"time": time_, **own, "temperature": 20.0 + time_ / 100})


def write(kind: str, folder: Path, rows: int) -> Path:
    """Write a file of a format; returns the file to read."""
    table = frame(rows)
    plain = table.select(COLUMNS)
    arrays = {name: plain[name].to_numpy() for name in COLUMNS}
    path = folder / f"data.{kind.partition(' ')[0]}"
    if kind == "csv":
        plain.write_csv(path)
    elif kind == "csv.gz":
        import gzip

        path.write_bytes(gzip.compress(plain.write_csv().encode(), compresslevel=3))
    elif kind == "csv (RTDE, blanks)":
        names = {"time": "timestamp", "position": "actual_q_0", "velocity": "actual_qd_0"}
        plain.rename({**names, "torque": "actual_current_0"}).write_csv(path, separator=" ")
    elif kind == "csv (TwinCAT Scope)":
        path.write_text(written.scope(table, one=True), newline="")
    elif kind == "parquet":
        plain.write_parquet(path)
    elif kind == "parquet (lists)":
        state = np.stack([arrays[c] for c in COLUMNS[1:]], axis=1)
        lists = pl.Series("observation.state", state).cast(pl.List(pl.Float64))
        pl.DataFrame([plain["time"].alias("timestamp"), lists]).write_parquet(path)
    elif kind == "arrow":
        plain.write_ipc(path)
    elif kind == "npz":
        np.savez(path, **arrays)
    elif kind in ("mat", "mat (compressed)"):
        from scipy.io import savemat

        savemat(path, {"log": arrays}, do_compression="compressed" in kind)
    elif kind == "h5":
        import h5py

        with h5py.File(path, "w") as file:
            for name, values in arrays.items():
                file.create_dataset(name, data=values, compression="gzip", compression_opts=1)
    elif kind == "tdms":
        written.tdms(path, table)
    elif kind == "mcap":
        written.mcap_ros2(path, table)
    else:
        path = written.ros_bag(path if kind == "bag" else folder / "bag", table, kind)
    return path


def _by_polars(kind: str) -> Callable[[Path], object]:
    return {
        "csv": pl.read_csv,
        "csv.gz": pl.read_csv,
        "csv (RTDE, blanks)": lambda p: pl.read_csv(p, separator=" "),
        "csv (TwinCAT Scope)": lambda p: pl.read_csv(
            p, separator="\t", decimal_comma=True, has_header=False, skip_lines=14,
            comment_prefix="EOF",
        ),
        "parquet": pl.read_parquet,
        "parquet (lists)": pl.read_parquet,
        "arrow": lambda p: pl.read_ipc(io.BytesIO(p.read_bytes())),
    }[kind]  # fmt: skip


def by_library(kind: str, path: Path) -> None:
    """Read every value of a file with its library alone."""
    if kind == "npz":
        with np.load(path) as archive:
            [archive[name] for name in archive.files]
    elif kind.startswith("mat"):
        import scipy.io

        scipy.io.loadmat(path)
    elif kind == "h5":
        import h5py

        with h5py.File(path) as file:
            [file[name][()] for name in file]
    elif kind == "tdms":
        import nptdms

        [c[:] for group in nptdms.TdmsFile.read(path).groups() for c in group.channels()]
    elif kind == "mcap":
        from mcap.reader import make_reader
        from mcap_ros2.decoder import DecoderFactory

        with path.open("rb") as stream:
            reader = make_reader(stream, decoder_factories=[DecoderFactory()])
            for _ in reader.iter_decoded_messages(topics=["/joint_states"], log_time_order=False):
                pass
    elif kind in ("bag", "db3"):
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore

        store = get_typestore(Stores.ROS2_HUMBLE)
        with AnyReader([path], default_typestore=store) as reader:
            for connection, _, data in reader.messages():
                reader.deserialize(data, connection.msgtype)
    else:
        _by_polars(kind)(path)


KINDS = (
    "csv", "csv.gz", "csv (RTDE, blanks)", "csv (TwinCAT Scope)", "parquet", "parquet (lists)",
    "arrow", "npz", "mat", "mat (compressed)", "h5", "tdms", "mcap", "bag", "db3",
)  # fmt: skip


def measure(kind: str, path: str, ours: bool, rows: int) -> None:
    """Read a file, print the shortest time [s] and the growth of memory [MB] as JSON."""
    import psutil
    from stribeck.recording.formats.door import Asked
    from stribeck.recording.tables.readers import read_table

    asked = Asked(memory_limit=8.0)
    small = write(kind, Path(tempfile.mkdtemp()), 200)
    # Libraries are imported, and their first calls done, before the clock runs.
    read_table(small, asked) if ours else by_library(kind, small)
    before, times, table = psutil.Process().memory_info().rss, [], None
    for _ in range(1 if kind in ("mcap", "bag", "db3") else 3):
        table = None
        start = time.process_time(), time.perf_counter()
        if ours:
            table = read_table(path, asked).table
        else:
            by_library(kind, Path(path))
        times.append((time.process_time() - start[0], time.perf_counter() - start[1]))
    grown = 0.0
    if sys.platform != "win32":
        import resource

        grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 - before
    if table is not None:
        torque = frame(rows)["torque"].to_numpy()
        same = any(
            len(c) == rows and c.dtype.is_float() and np.array_equal(c.to_numpy(), torque)
            for c in table.iter_columns()
        )
        assert same, f"{kind}: the torque that was read is not the one that was written"
    print(json.dumps({"cpu": min(t[0] for t in times), "wall": min(t[1] for t in times),
                      "memory": grown / 1e6}))  # fmt: skip


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("formats", nargs="*")
    parser.add_argument("--rows", type=int, default=1_000_000)
    parser.add_argument("--measure", nargs=2, metavar=("PATH", "BY"), help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.measure:
        measure(given.formats[0], given.measure[0], given.measure[1] == "reader", given.rows)
        return
    print(f"{given.rows} rows | MB | library s | reader s | ratio | memory of the reader, MB")
    for kind in given.formats or KINDS:
        with tempfile.TemporaryDirectory() as folder:
            path = write(kind, Path(folder), given.rows)
            found = {}
            for by in ("library", "reader"):
                command = [sys.executable, __file__, kind, "--rows", str(given.rows)]
                done = subprocess.run(
                    [*command, "--measure", str(path), by], capture_output=True, text=True,
                )  # fmt: skip
                if done.returncode:
                    raise SystemExit(done.stderr)
                found[by] = json.loads(done.stdout.splitlines()[-1])
            one, two = found["library"]["cpu"], found["reader"]["cpu"]
            size = path.stat().st_size / 1e6
            print(f"{kind} | {size:.0f} | {one:.2f} | {two:.2f} | {two / one:.2f} | "
                  f"{found['reader']['memory']:.0f}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
