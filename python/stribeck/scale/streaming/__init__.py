"""Data sets larger than memory: Parquet files read in passes, a window at a time."""
