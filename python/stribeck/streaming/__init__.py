"""Data sets larger than memory: Parquet files read in passes, a window at a time."""

from stribeck.streaming.dataset import DataSet, is_data_set
from stribeck.streaming.result import StreamedFit
from stribeck.streaming.stream import Stream, stream

__all__ = ["DataSet", "Stream", "StreamedFit", "is_data_set", "stream"]
