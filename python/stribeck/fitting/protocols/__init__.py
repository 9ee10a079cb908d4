"""Test-bench protocols in a recording: one file each, pure functions from recording to results."""
