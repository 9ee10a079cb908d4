"""Generated recordings as files."""

from __future__ import annotations

import io
from typing import Any

import polars as pl


def file_bytes(frame: pl.DataFrame, suffix: str) -> bytes:
    """A recording as a file; numbers read back with the same bits."""
    if suffix == ".csv":
        return frame.write_csv().encode("utf-8")
    stream = io.BytesIO()
    frame.write_parquet(stream, compression="zstd", compression_level=19)
    return stream.getvalue()


def sidecar_text(truth: dict[str, Any]) -> str:
    """The sidecar of a generated recording: what its columns cannot say."""
    return f'kind = "recording"\njoint_kind = "{truth["joint_kind"]}"\n'
