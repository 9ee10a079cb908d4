"""Data sets larger than memory: Parquet files read in passes, a window at a time."""

from stribeck.streaming.dataset import DataSet, is_data_set
from stribeck.streaming.diagnosis import StreamedDiagnosis
from stribeck.streaming.improvement import StreamedImprovement
from stribeck.streaming.result import StreamedFit
from stribeck.streaming.stream import Stream, stream

__all__ = [
    "DataSet", "Stream", "StreamedDiagnosis", "StreamedFit", "StreamedImprovement", "is_data_set",
    "stream",
]  # fmt: skip
