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


#: How the shipped recording of `stribeck demo` was made. The joint warms up by a few kelvin only,
#: as in any short recording. So the demo has effects that cannot be tested with its data.
DEMO: _Made = {
    "effects": ("load", "stribeck"),
    "seed": 1,
    "seconds": 80.0,
    "rate": 100.0,
    "noise": 0.03,
    "warming": 2.5,
}


def demo_recording() -> tuple[pl.DataFrame, Truth]:
    """Generate the shipped recording and its truth again."""
    return generate(**DEMO)


def demo_path() -> Path:
    """Path of the shipped recording."""
    return Path(str(resources.files("stribeck") / "data" / "demo.parquet"))
