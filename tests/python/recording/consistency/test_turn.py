"""A position whose unit is not stated: a weight tells degrees and turns from radians."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb

#: Unit of the file over one radian.
PER_RADIAN = {"rad": 1.0, "deg": 180.0 / np.pi, "rev": 0.5 / np.pi}


def arm(logged: str, weight: float = 8.0, reach: float = 1.2, **stated: object) -> sb.Recording:
    """An arm with a weight, in columns without a unit, but for one that is `stated`."""
    t = np.arange(0.0, 40.0, 0.01)
    q = reach * (np.sin(0.9 * t) + 0.4 * np.sin(2.3 * t))
    v = np.gradient(q, t)
    torque = 2.0 * np.sign(v) + 0.8 * v + 0.2 * np.gradient(v, t) + weight * np.sin(q)
    torque += 0.05 * np.random.default_rng(2).standard_normal(t.size)
    factor = PER_RADIAN[logged]
    return sb.read({"t": t, "q": factor * q, "dq": factor * v, "tau": torque}, **stated)


def said(recording: sb.Recording) -> list[str]:
    """What is said of the unit."""
    return [check.said for check in recording.checks if check.check == "turn"]


@pytest.mark.parametrize("unit", ["deg", "rev"])
def test_a_weight_tells_the_unit(unit: str) -> None:
    (found,) = said(arm(unit))
    assert f"a weight in {unit} explains more of the torque than one in rad" in found
    assert f'unit=["q={unit}", "dq={unit}/s"]' in found or f'unit="q={unit}"' in found


def test_nothing_is_said_of_radians_a_stated_unit_or_no_weight() -> None:
    assert said(arm("rad")) == []
    assert said(arm("deg", weight=0.0)) == []
    assert said(arm("deg", unit=["q=rad", "dq=rad/s"])) == []


def test_a_small_motion_says_nothing() -> None:
    assert said(arm("deg", reach=0.1)) == []
