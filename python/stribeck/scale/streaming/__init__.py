"""Data sets larger than memory: Parquet files read in passes, one window at a time."""
