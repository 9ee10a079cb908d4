"""A lag of friction shows in moves that pass the slow speeds quickly, however long others creep."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb


def untestable(every: float) -> list[str]:
    """What keeps a lag from being tested: a joint creeps, and moves to and fro quickly at times."""
    t = np.arange(20000) / 200.0
    v = 0.04 * np.sin(2.0 * np.pi * t / 40.0)
    fast = (t % every) < 2.0
    v[fast] = np.sin(np.pi * (t[fast] % every))
    rng = np.random.default_rng(0)
    torque = 2.0 * np.sign(v) + 0.5 * v + 0.02 * rng.standard_normal(t.size)
    r = sb.Recording.from_columns(time=t, velocity=v, torque=torque, load_torque=0.0 * t)
    rows = sb.diagnose(sb.fit("coulomb+stribeck", r, starts=2)).untestable
    return [row.why for row in rows if row.effect == "frictional_lag"]


def test_a_few_quick_moves_suffice() -> None:
    assert not any("pass its slow speeds" in why for why in untestable(25.0))


@pytest.mark.parametrize(("every", "number"), [(50.0, "only 4"), (1e3, "only 2")])
def test_fewer_do_not(every: float, number: str) -> None:
    (why,) = untestable(every)
    assert why.startswith(f"in {number} of the moves the joint speeds up enough") or why.startswith(
        f"in {number} of the moves the joint slows down enough"
    )
    assert why.endswith("to pass its slow speeds in 2 s, so that no lag of friction shows")
