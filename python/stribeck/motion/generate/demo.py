"""The recording that ships with the package, for `stribeck demo`."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import Any

import polars as pl

from stribeck.motion.generate.hidden import generate

#: How the shipped recording of `stribeck demo` was made. The joint hardly warms up, as in any
#: recording this short, so that the demo also meets effects that its data cannot show.
DEMO: dict[str, Any] = {
    "effects": ("load", "stribeck"),
    "seed": 1,
    "seconds": 80.0,
    "rate": 100.0,
    "noise": 0.03,
    "warming": 2.5,
}


def demo_recording() -> tuple[pl.DataFrame, dict[str, Any]]:
    """Make the shipped recording again, with what is hidden in it."""
    made = dict(DEMO)
    return generate(made.pop("effects"), **made)


def demo_path() -> Path:
    """Where the shipped recording is."""
    return Path(str(resources.files("stribeck") / "data" / "demo.parquet"))
