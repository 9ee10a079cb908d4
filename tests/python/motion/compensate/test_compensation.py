"""Compensation: the controller, the loop, the observer, direct teaching."""

from __future__ import annotations

import math

import numpy as np
import pytest
import stribeck as sb
from stribeck.base.errors import SpecError
from stribeck.motion.compensate.controller import HInfinity
from stribeck.motion.compensate.loop import Compensator
from stribeck.motion.compensate.teaching import Guidance, Teaching, teach
from stribeck.motion.compensate.tracking import compensate
from stribeck.motion.simulate.drive import Follow
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.run import simulate
from stribeck.motion.simulate.trajectory import Quintic, Trapezoid

COULOMB = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
NONE = COULOMB.with_values([0.0, 0.0])
BRISTLE = sb.model(
    "lugre",
    bristle_stiffness=2e4,
    bristle_damping=20.0,
    viscous_friction=0.5,
    coulomb_friction=2.0,
    static_friction=3.0,
    stribeck_velocity=0.05,
    stribeck_exponent=2.0,
)
PATH = Quintic(0.0, 1.0, 2.0)
JOINT = Joint.revolute(0.5, gravity_cos=4.0)


def test_the_loop_without_friction_follows_its_poles() -> None:
    gains = HInfinity.with_bandwidth(0.5, hertz=1.0)
    loop = gains.on(0.5)
    pole = math.tau
    # J D^2 + kd D + kp + ki/D has the three poles (D + w)^3.
    polynomial = [0.5, loop.derivative, loop.proportional, loop.integral]
    np.testing.assert_allclose(polynomial, 0.5 * np.poly([-pole] * 3), rtol=1e-12)


def test_the_pid_is_eqs_23_to_25_as_meant() -> None:
    gains, inertia = HInfinity(7.0, 11.0, 3.0, 0.5), 0.7
    error, slope, total, acceleration = 0.3, -0.2, 0.1, 1.3
    s = slope + gains.proportional * error + gains.integral * total
    reference = acceleration + gains.proportional * slope + gains.integral * error
    meant = inertia * reference + (gains.gain + 1.0 / gains.attenuation**2) * s
    pid = gains.on(inertia)
    given = pid.proportional * error + pid.integral * total + pid.derivative * slope
    assert inertia * acceleration + given == pytest.approx(meant, rel=1e-14)


def test_without_compensation_it_is_the_simulated_closed_loop() -> None:
    # Without gravity: the simulator compensates that of the desired position.
    joint = Joint.revolute(0.5)
    gains = HInfinity.with_bandwidth(0.5)
    motion = compensate(BRISTLE, joint, PATH, [], controller=gains).motions[0]
    other = simulate(BRISTLE, joint, Follow(PATH, gains.on(0.5), feedforward=True))
    assert other.tracking_error is not None
    rms = float(np.sqrt(np.mean(other.tracking_error**2)))
    # The inertial torque is that at the start of a step here, and that of its middle there.
    assert motion.rmse == pytest.approx(rms, rel=0.01)


@pytest.mark.parametrize("friction", [COULOMB, BRISTLE], ids=lambda model: model.law)
@pytest.mark.parametrize("feedback", [True, False])
def test_the_right_model_takes_nearly_all_of_the_error(friction: sb.Model, feedback: bool) -> None:
    moved = compensate(friction, JOINT, PATH, [Compensator(friction, feedback=feedback)])
    # A law without a memory gives nothing at rest: by feedback it cannot help to break loose.
    least = 0.7 if feedback and not friction.has_state else 0.95
    assert moved.reduction(moved.motions[1]) > least


def test_half_of_it_takes_half_of_the_error() -> None:
    # Of viscous friction alone, in which everything is linear.
    viscous = COULOMB.with_values([5.0 if "viscous" in n else 0.0 for n in COULOMB.names])
    half = Compensator(viscous, 0.5, feedback=False)
    moved = compensate(viscous, Joint.revolute(0.5), PATH, [half], step=1e-4)
    assert moved.reduction(moved.motions[1]) == pytest.approx(0.5, abs=0.02)


def test_a_compensator_without_friction_changes_nothing() -> None:
    moved = compensate(BRISTLE, JOINT, PATH, [Compensator(NONE)])
    np.testing.assert_array_equal(moved.motions[1].position, moved.motions[0].position)


def test_the_observer_finds_the_friction_that_is_left() -> None:
    path = Trapezoid(0.0, 1.0, 0.5, 5.0)
    alone = compensate(COULOMB, JOINT, path, [Compensator(COULOMB, 0.5)])
    observed = compensate(COULOMB, JOINT, path, [Compensator(COULOMB, 0.5)], observer=10.0)
    cruising = slice(1200, 1800)
    without, half = observed.motions
    # Friction at 0.5 rad/s is 2.25 N m.
    assert without.observed[cruising] == pytest.approx(2.25, rel=1e-3)
    assert half.observed[cruising] == pytest.approx(1.125, rel=1e-3)
    assert half.rmse < 0.5 * alone.motions[1].rmse


def test_an_encoder_is_seen_in_its_steps() -> None:
    moved = compensate(BRISTLE, JOINT, PATH, [], encoder=1e-3)
    exact = compensate(BRISTLE, JOINT, PATH, [], encoder=1e-9)
    plain = compensate(BRISTLE, JOINT, PATH, [])
    assert exact.motions[0].rmse == pytest.approx(plain.motions[0].rmse, rel=0.05)
    # A step of 1 mrad hides errors that the joint would otherwise correct.
    assert moved.motions[0].rmse > 1e-4 > 0.0
    assert not np.array_equal(moved.motions[0].position, plain.motions[0].position)


def test_a_hand_gives_what_compensation_leaves() -> None:
    guidance = Guidance.with_bandwidth(Trapezoid(-1.0, 1.0, 0.6, 2.0), 0.5)
    taught = teach(COULOMB, JOINT, guidance, [Compensator(COULOMB, a) for a in (0.35, 0.85)])
    without, little, much = (m.controller_torque[1500:2500].mean() for m in taught.motions)
    assert without == pytest.approx(2.3, rel=1e-3)
    assert little == pytest.approx(0.65 * 2.3, rel=1e-3)
    assert much == pytest.approx(0.15 * 2.3, rel=1e-3)
    # It is held over a step, and so for one step more than the motion at a reversal.
    assert taught.overcompensated(taught.motions[2]) * steps_of(taught) <= 2.0


def steps_of(taught: Teaching) -> int:
    """How many steps a motion has."""
    return taught.motions[0].error.size


def test_too_much_compensation_shows() -> None:
    guidance = Guidance.with_bandwidth(Trapezoid(-1.0, 1.0, 0.6, 2.0), 0.5)
    wrong = Compensator(COULOMB.with_values(1.5 * COULOMB.values))
    taught = teach(COULOMB, JOINT, guidance, [wrong])
    assert taught.overcompensated(taught.motions[1]) > 0.5


@pytest.mark.parametrize(
    ("ask", "sentence"),
    [
        (lambda: Compensator(COULOMB, 1.1), "give 0 to 1"),
        (lambda: HInfinity(1.0, 1.0, 1.0), "must exceed 2 KI"),
        (lambda: HInfinity(1.0, 0.1, math.nan), "gain is nan"),
        (lambda: compensate(COULOMB, None, PATH, []), "no inertia to move"),
        (lambda: compensate(COULOMB, JOINT, PATH, [], observer=-1.0), "bandwidth is -1"),
        (lambda: compensate(COULOMB, JOINT, PATH, [], step=0.0), "step 0 is invalid"),
        (
            lambda: compensate(COULOMB, JOINT, PATH, [], encoder=math.nan),
            "resolution of the encoder is nan",
        ),
        (lambda: compensate(sb.model("tadese_t"), JOINT, PATH, []), "has no value"),
        (
            lambda: teach(
                COULOMB, JOINT, Guidance(PATH, 1.0, 1.0), [Compensator(COULOMB, feedback=False)]
            ),
            "use feedback",
        ),
    ],
)
def test_what_cannot_be_is_refused(ask: object, sentence: str) -> None:
    with pytest.raises(SpecError, match=sentence):
        ask()  # type: ignore[operator]
