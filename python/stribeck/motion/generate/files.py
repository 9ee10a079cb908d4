"""Generated recordings as files."""

from __future__ import annotations

import io
import tempfile
from pathlib import Path

import polars as pl

from stribeck.base.files import place_table
from stribeck.base.replaceable import check_table
from stribeck.motion.generate.hidden import Truth
from stribeck.motion.generate.ur5e import JOINTS, RobotRecording


def file_bytes(frame: pl.DataFrame, suffix: str) -> bytes:
    """Return a recording as the bytes of a file, from which numbers are read back exactly."""
    if suffix == ".csv":
        return frame.write_csv().encode("utf-8")
    stream = io.BytesIO()
    frame.write_parquet(stream, compression="zstd", compression_level=19)
    return stream.getvalue()


def sidecar_text(truth: Truth) -> str:
    """Return the sidecar of a generated recording, which states the kind of joint."""
    return f'kind = "recording"\njoint_kind = "{truth["joint_kind"]}"\n'


def write_robot(recording: RobotRecording, target: Path) -> None:
    """Write the recording of a robot as Parquet or CSV, atomically.

    The full Test 2 has 16 million rows. Each joint is written to a file of its own first, so that
    one joint at a time is in memory; polars then joins the files as a stream. The sidecar is
    written beside it.
    """
    check_table(target)
    with tempfile.TemporaryDirectory(dir=target.parent, prefix=f".{target.name}.") as folder:
        parts = []
        for joint in JOINTS:
            part = Path(folder) / f"{joint}.parquet"
            recording.joint_frame(joint).write_parquet(part)
            parts.append(part)
        whole = Path(folder) / f"whole{target.suffix.lower()}"
        joined = pl.scan_parquet(parts)
        if target.suffix.lower() == ".csv":
            joined.sink_csv(whole)
        else:
            joined.sink_parquet(whole, compression="zstd")
        place_table(whole, target, recording.sidecar_text())
