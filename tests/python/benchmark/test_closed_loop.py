"""Recordings of a controlled joint: it sticks and slips, and effects have their size."""

from __future__ import annotations

import numpy as np
import pytest
from stribeck.benchmark import closed_loop
from stribeck.benchmark.closed_loop.contact import Iwan
from stribeck.benchmark.draws import root_mean_square
from stribeck.benchmark.sample import Sample

#: One of every kind: of speed, of load, lagging, of the actuator, and outside the library.
QUICK = ("stribeck", "quadrant", "frictional_lag", "saturation", "restart")
SLOW = [e for e in (*closed_loop.EFFECTS, *closed_loop.OUTSIDE) if e not in QUICK]


def moving(made: Sample) -> np.ndarray:
    speed = np.abs(made.frame["velocity"].to_numpy())
    settled = made.frame["time"].to_numpy() > 1.0
    return (speed > 5 * made.truth["velocity_noise"]) & settled


def test_the_same_seed_gives_the_same_bytes() -> None:
    first, again = (closed_loop.sample(("none",), 5) for _ in range(2))
    assert first.frame.equals(again.frame)
    assert first.truth == again.truth


def test_the_joint_sticks_and_follows() -> None:
    """Slow motion stops and goes although the reference moves; fast motion is followed."""
    made = closed_loop.sample(("stribeck",), 6, 5.0)
    q = made.frame["position"].to_numpy()
    assert 8_000 <= q.size <= 12_000
    at_rest = np.diff(q) == 0.0
    assert 0.02 < at_rest.mean() < 0.6
    counts = q[1:][~at_rest]
    steps = np.unique(np.round(np.diff(np.sort(np.unique(counts))), 15))
    assert np.allclose(np.round(steps / steps[0]), steps / steps[0], atol=1e-3)


@pytest.mark.parametrize(
    "effect", [*QUICK, *[pytest.param(e, marks=pytest.mark.slow) for e in SLOW]]
)
def test_an_effect_has_the_size_asked_for(effect: str) -> None:
    made = closed_loop.sample((effect,), 7, 3.0)
    size = made.truth["sizes"][effect]
    # A presliding distance or a gap that rows can resolve is never a small effect.
    largest = np.inf if effect in ("presliding", "backlash") else 3.1
    assert 2.7 < size < largest
    left = (made.frame["torque"].to_numpy() - made.oracle.prediction)[moving(made)]
    assert root_mean_square(left) == pytest.approx(made.truth["noise_rms"], rel=1e-6)


def test_without_an_effect_the_true_formula_leaves_noise() -> None:
    made = closed_loop.sample(("none",), 8)
    assert made.truth["hidden"] == ["none"]
    # What filters and the encoder add at reversals stays below the current's noise.
    assert made.truth["unmodelled_rms"] < 0.5 * made.truth["noise_rms"]


def test_two_effects_are_near_their_sizes() -> None:
    made = closed_loop.sample(("load", "temperature_viscous"), 9, (2.0, 1.0))
    assert made.truth["sizes"]["load"] == pytest.approx(2.0, rel=0.3)
    assert made.truth["sizes"]["temperature_viscous"] == pytest.approx(1.0, rel=0.3)


@pytest.mark.parametrize("limit", closed_loop.LIMITS)
def test_a_limited_motion_says_what_it_cannot_show(limit: str) -> None:
    made = closed_loop.sample(("none",), 10, **{limit: True})
    assert made.truth["cannot_show"] == closed_loop.LIMITS[limit]
    temperature = made.frame["temperature"].to_numpy()
    if limit == "isothermal":
        assert np.ptp(temperature) < 0.6
    else:
        smooth = np.convolve(temperature, np.ones(200) / 200, mode="valid")[::200]
        assert np.all(np.diff(smooth) > 0)


def test_presliding_remembers_reversals() -> None:
    """A small loop closes on itself (return-point memory), and long slides saturate."""
    contact = Iwan(reach=1.0)
    for _ in range(200):
        top = contact.move(0.1)
    assert top == pytest.approx(1.0)
    contact.move(-1.0)
    inside = contact.move(-0.2)
    contact.move(0.15)
    assert contact.move(-0.15) == pytest.approx(inside, abs=1e-12)


def test_a_wrong_request_is_refused() -> None:
    with pytest.raises(ValueError, match="unknown effect"):
        closed_loop.sample(("gremlins",), 1)
    with pytest.raises(ValueError, match="zip"):
        closed_loop.sample(("load",), 1, (1.0, 2.0))
