"""The nine shared recordings with a hidden effect: each is found, nothing else is, noise is left.

The same holds when the machine is larger or slower: time and torque scaled by any factors.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
import stribeck as sb

CASES = Path(__file__).resolve().parents[3] / "shared" / "cases"

pytestmark = pytest.mark.skipif(
    not (CASES / "truth.json").is_file(), reason="the shared cases are not at ../shared/cases"
)

NAMES = tuple(f"joint_{k}" for k in range(1, 10))
#: Those that every run of the tests looks at; the others are slow.
QUICK = ("joint_2",)


def truth(name: str) -> dict[str, Any]:
    """What is hidden in one recording."""
    return dict(json.loads((CASES / "truth.json").read_text())[name])


def check(said: dict[str, Any], answer: dict[str, Any], noise: float) -> None:
    """Effects as hidden, each once; what cannot be shown is listed; noise is left."""
    hidden = [effect for effect in said["hidden"] if effect != "none"]
    found = [step["effect"] for step in answer["steps"]]
    assert sorted(found) == sorted(hidden)
    if said.get("limit") == "isothermal":
        listed = {row["effect"] for row in answer["untestable"]}
        assert {"temperature_viscous", "temperature_dry"} <= listed
    assert 0.97 <= answer["final"]["rmse_held_out"] / noise <= 1.05


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=[] if n in QUICK else [pytest.mark.slow]) for n in NAMES],
)
def test_hidden_effect_is_found(name: str) -> None:
    """The shared recordings as they are."""
    said = truth(name)
    improvement = sb.improve("coulomb", sb.read(CASES / f"{name}.parquet"))
    check(said, improvement.to_dict(), said["noise_rms_Nm"])


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_hidden_effect_is_found_on_any_scale(name: str, tmp_path: Path) -> None:
    """The same joint, a random number of times slower and stronger."""
    rng = np.random.default_rng([2026, NAMES.index(name)])
    c, k = np.exp(rng.uniform(-1.0, 1.0)), np.exp(rng.uniform(-3.0, 3.0))
    factors = {
        "time": c,
        "velocity": 1.0 / c,
        "acceleration": 1.0 / c**2,
        "torque": k,
        "load_torque": k,
    }
    frame = pl.read_parquet(CASES / f"{name}.parquet")
    path = tmp_path / "scaled.parquet"
    frame.with_columns(
        [pl.col(column) * factor for column, factor in factors.items() if column in frame.columns]
    ).write_parquet(path)
    said = truth(name)
    improvement = sb.improve("coulomb", sb.read(path))
    check(said, improvement.to_dict(), k * said["noise_rms_Nm"])
