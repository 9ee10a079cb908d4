"""Recordings of analytic motion: the same each time, effects of the size asked for, fair."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest
import stribeck
from stribeck.benchmark import open_loop
from stribeck.benchmark.draws import root_mean_square

GENERATORS = Path(stribeck.__file__).parent / "benchmark"
#: Of the package, generators may know each other's tools only.
ALLOWED = ("stribeck.benchmark.",)


@pytest.mark.parametrize("name", ["open_loop", "closed_loop"])
def test_a_generator_knows_nothing_of_the_laws(name: str) -> None:
    for path in [*(GENERATORS / name).glob("*.py"), GENERATORS / "draws.py"]:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                names = [f"{node.module}."]
            for imported in names:
                if imported.startswith("stribeck"):
                    assert imported.startswith(ALLOWED), f"{path.name} imports {imported}"


@pytest.mark.parametrize("name", ["open_loop", "closed_loop"])
def test_the_generators_share_no_formula(name: str) -> None:
    """Neither imports the other."""
    other = {"open_loop": "closed_loop", "closed_loop": "open_loop"}[name]
    for path in (GENERATORS / name).glob("*.py"):
        assert f"benchmark.{other}" not in path.read_text(encoding="utf-8")


def test_the_same_seed_gives_the_same_bytes() -> None:
    first, again = (open_loop.record(("load", "stribeck"), 3) for _ in range(2))
    assert first.frame.equals(again.frame)
    assert first.truth == again.truth
    assert not first.frame.equals(open_loop.record(("load", "stribeck"), 4).frame)


@pytest.mark.parametrize("effect", [*open_loop.EFFECTS, *open_loop.OUTSIDE])
def test_an_effect_has_the_size_asked_for(effect: str) -> None:
    made = open_loop.record((effect,), 90, 2.0)
    size = made.truth["sizes"][effect]
    if effect in ("quadrant", "direction"):
        # Beyond the base alone the load effect or the offset that they contain counts too.
        assert size > 2.0
    else:
        assert size == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize("effect", ["none", "stribeck", "saturation", "quadrant", "restart"])
def test_the_oracle_leaves_the_noise(effect: str) -> None:
    made = open_loop.record((effect,), 91, 1.0)
    left = (made.frame["torque"].to_numpy() - made.oracle.prediction)[made.moving]
    assert root_mean_square(left) == pytest.approx(made.truth["noise_rms"], rel=0.02)
    assert set(made.oracle.tangents) == {"coulomb", "viscous", effect} - {"none"}


@pytest.mark.parametrize("limit", open_loop.LIMITS)
def test_a_limited_motion_cannot_show_its_effects(limit: str) -> None:
    """What the motion cannot show changes nothing that Coulomb and viscous friction leave."""
    frame, truth = open_loop.make(("none",), 92, **{limit: True})
    assert truth["cannot_show"] == open_loop.LIMITS[limit]
    v, temperature = frame["velocity"].to_numpy(), frame["temperature"].to_numpy()
    if limit == "isothermal":
        assert np.ptp(temperature) < 0.5
    if limit == "one_direction":
        assert np.mean(v > -5 * truth["velocity_noise"]) == 1.0
    if limit == "constant_load":
        assert np.ptp(frame["load_torque"].to_numpy()) < 1e-9
    if limit == "no_slow_motion":
        assert np.abs(v).min() > 0.6 * np.abs(v).max()
    if limit == "short_range":
        assert np.ptp(frame["position"].to_numpy()) < 0.3


def test_a_wrong_request_is_refused() -> None:
    with pytest.raises(ValueError, match="unknown effect"):
        open_loop.make(("gremlins",), 1)
    with pytest.raises(ValueError, match="one limit at a time"):
        open_loop.make(("load",), 1, isothermal=True, short_range=True)
    with pytest.raises(ValueError, match="one size for each"):
        open_loop.make(("load",), 1, (1.0, 2.0))
