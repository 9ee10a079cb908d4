"""The recording that ships with the package, for `stribeck demo`."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import TypedDict

import polars as pl

from stribeck.motion.generate.hidden import Truth, generate


class _Made(TypedDict):
    effects: tuple[str, ...]
    seed: int
    seconds: float
    rate: float
    noise: float
    warming: float


#: How the shipped recording of `stribeck demo` was made. The joint hardly warms up, as in any
#: recording this short, so that the demo has effects that cannot be tested with its data.
DEMO: _Made = {
    "effects": ("load", "stribeck"),
    "seed": 1,
    "seconds": 80.0,
    "rate": 100.0,
    "noise": 0.03,
    "warming": 2.5,
}


def demo_recording() -> tuple[pl.DataFrame, Truth]:
    """Make the shipped recording again, and what is hidden in it."""
    return generate(**DEMO)


def demo_path() -> Path:
    """Where the shipped recording is."""
    return Path(str(resources.files("stribeck") / "data" / "demo.parquet"))
