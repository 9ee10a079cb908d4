"""The hidden friction: hysteresis against a sample-by-sample solution, and its physics."""

from __future__ import annotations

import numpy as np
import pytest
from stribeck.motion.generate.true_friction import TrueFriction, stop_operator
from stribeck.motion.generate.ur5e import RobotRecording

STILL = np.zeros(1)


@pytest.fixture(scope="module")
def friction() -> TrueFriction:
    return RobotRecording(test=1, repeats=1).drives[0].friction


def test_the_stop_operator_is_that_of_its_definition() -> None:
    """z += dq, kept within the slip, one sample after the other."""
    rng = np.random.default_rng(0)
    position = np.cumsum(rng.standard_normal(2000) * rng.choice([0.0, 0.1, 1.0], 2000))
    z, expected = 0.3, []
    for step in np.diff(position, prepend=position[0]):
        z = float(np.clip(z + step, -0.8, 0.8))
        expected.append(z)
    np.testing.assert_allclose(stop_operator(position, 0.8, 0.3), expected, atol=1e-12)


def test_a_loop_within_a_loop_is_remembered(friction: TrueFriction) -> None:
    """Nonlocal memory: after a small reversal the outer branch goes on where it was left."""
    slips = friction.slips
    out = np.linspace(-1e-2, 1e-3, 400)
    inner = np.concatenate([np.linspace(1e-3, 8e-4, 50)[1:], np.linspace(8e-4, 1e-3, 50)[1:]])
    there = np.concatenate([out, inner])

    def torque(position: np.ndarray) -> float:
        at = np.full(position.size, 24.0)
        still = np.zeros_like(position)
        found, _ = friction.torque(position, still, at, still, [0.0] * len(slips))
        return float(found[-1])

    assert torque(there) == pytest.approx(torque(out), rel=1e-12)


def test_friction_opposes_motion_and_dissipates_over_a_cycle(friction: TrueFriction) -> None:
    t = np.linspace(0.0, 4.0 * np.pi, 20001)
    q, v = 0.5 * np.sin(t), 0.5 * np.cos(t)
    load, at = 20.0 * np.cos(q), np.full(t.size, 30.0)
    torque, _ = friction.torque(q, v, at, load, [0.0] * len(friction.slips))
    second = t >= 2.0 * np.pi
    assert np.trapezoid((torque * v)[second], t[second]) > 0.0
    fast = np.abs(v) > 0.1
    assert np.all(torque[fast] * v[fast] > 0.0)


def test_each_cause_has_its_sign(friction: TrueFriction) -> None:
    def at(velocity: float, temperature: float = 24.0, load: float = 0.0) -> float:
        v, T, tl = np.array([velocity]), np.array([temperature]), np.array([load])
        return float((friction.dry(v, T, tl) + friction.viscous(v, T))[0])

    assert friction.dry(STILL, STILL + 24, STILL) > friction.dry(STILL + 0.5, STILL + 24, STILL)
    assert at(3.0, temperature=40.0) < at(3.0)
    assert at(1.0, load=60.0) > at(1.0, load=10.0) > at(1.0)
    assert at(3.0) - at(2.0) < at(2.0) - at(1.0)
