"""Each rule catches a made claim that cannot be right, and leaves a true one alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.carrying import fewest
from stribeck.diagnosis.plausibility.cancelling import cancelling
from stribeck.diagnosis.plausibility.carried import Carried, move_of
from stribeck.diagnosis.plausibility.claim import Claim, term_torques
from stribeck.diagnosis.plausibility.few_events import few_events, one_event
from stribeck.diagnosis.plausibility.negative import (
    negative_friction,
    negative_inertia,
    negative_under_load,
)
from stribeck.diagnosis.plausibility.other_joints import other_joints
from stribeck.diagnosis.plausibility.rules import IMPOSSIBLE, WEAK, impossible, weak
from stribeck.diagnosis.plausibility.same_curve import same_curve
from stribeck.diagnosis.plausibility.shape import few_samples, shape_at_bound
from stribeck.diagnosis.plausibility.steady import steady
from stribeck.diagnosis.plausibility.too_large import too_large
from stribeck.diagnosis.plausibility.uneven import uneven
from stribeck.diagnosis.plausibility.unresolved import out_of_reach, unresolved
from stribeck.diagnosis.plausibility.worsened import worsened
from stribeck.identify.problem import Problem
from stribeck.recording.check import Check
from synthetic import Array, joint, motion, record

#: Torque of a made offset, N m.
OFFSET = 0.5


def made(folder: Path, extra: Array | float, effect: str, name: str = "made") -> Claim:
    """The claim of `effect` on a recording that holds `extra` torque."""
    recording = record(folder, joint(extra), name)
    before = sb.fit("coulomb", recording, starts=1)
    return Claim(effect, before, sb.add(before, effect, starts=4), 0.01)


def with_values(claim: Claim, **values: float) -> Claim:
    """The same claim with other values, and what the model then predicts."""
    fit = claim.after
    model = fit.model.with_values([values.get(n, fit.model.value(n)) for n in fit.model.names])
    predicted = Problem(fit.recording, model, fit.rows, fit.load).predict(model.values)
    return replace(claim, after=replace(fit, model=model, prediction=predicted))


@pytest.fixture(scope="module")
def offset(tmp_path_factory: pytest.TempPathFactory) -> Claim:
    return made(tmp_path_factory.mktemp("offset"), OFFSET, "offset")


@pytest.fixture(scope="module")
def direction(tmp_path_factory: pytest.TempPathFactory) -> Claim:
    _, _, v, _ = motion()
    return made(tmp_path_factory.mktemp("direction"), 0.5 + 0.2 * np.abs(v), "direction")


@pytest.fixture(scope="module")
def stribeck_curve(tmp_path_factory: pytest.TempPathFactory) -> Claim:
    _, _, v, _ = motion()
    extra = 1.5 * np.exp(-np.abs(v) / 0.15) * np.sign(v)
    return made(tmp_path_factory.mktemp("stribeck"), extra, "stribeck")


@pytest.mark.parametrize("name", ["offset", "direction", "stribeck_curve"])
def test_a_true_effect_breaks_no_rule(name: str, request: pytest.FixtureRequest) -> None:
    claim = request.getfixturevalue(name)
    assert [rule(claim) for rule in (*IMPOSSIBLE, *WEAK)] == [None] * len((*IMPOSSIBLE, *WEAK))
    assert impossible(claim) is None and weak(claim) is None


def test_a_stribeck_curve_beside_viscous_friction_of_the_same_form(stribeck_curve: Claim) -> None:
    """Without Coulomb friction below it, it is a curve of the speed as viscous friction is."""
    viscous = sb.add(stribeck_curve.before, "nonlinear_viscous", starts=2)
    claim = Claim("stribeck", viscous, sb.add(viscous, "stribeck", starts=2), 0.01)
    assert same_curve(with_values(claim, coulomb_friction=3.0, stribeck_height=1.5)) is None
    reason = same_curve(with_values(claim, coulomb_friction=0.0, stribeck_height=4.5))
    assert reason == "the motion cannot tell it from nonlinear_viscous, which the model has"
    alone = with_values(stribeck_curve, coulomb_friction=0.0, stribeck_height=4.5)
    assert same_curve(alone) is None


def test_what_other_joints_do_looks_like_an_effect_of_the_position(tmp_path: Path) -> None:
    """Unless the load torque is known."""
    _, q, _, _ = motion()
    claim = made(tmp_path, 0.5 * q, "spring")
    assert other_joints(claim) is None
    check = Check("others", True, "joint 2 moves as well")
    known = replace(claim.after.recording, checks=(check,))
    assert other_joints(replace(claim, after=replace(claim.after, recording=known))) is None
    beside = replace(known, load_torque=None)
    moved = replace(claim, after=replace(claim.after, recording=beside))
    reason = other_joints(moved)
    assert reason is not None and reason.startswith("other joints move as well")
    # Friction that depends on the speed alone is not what they carry.
    assert other_joints(replace(moved, effect="stribeck")) is None


def test_a_torque_beyond_all_that_was_measured(offset: Claim) -> None:
    r = offset.before.recording
    span = float(np.ptp((r.torque - r.load_torque)[offset.rows]))
    reason = too_large(with_values(offset, offset=1.01 * span))
    assert reason is not None and reason.startswith("its torque would be")
    assert too_large(with_values(offset, offset=0.99 * span)) is None


def test_a_constant_load_may_exceed_all_changes_of_the_torque(tmp_path: Path) -> None:
    """As on a vertical axis: the torque never comes near zero."""
    before = sb.fit("coulomb", record(tmp_path, joint(100.0)), starts=1)
    claim = Claim("offset", before, sb.add(before, "offset", starts=1), 0.01)
    r = before.recording
    assert np.ptp((r.torque - r.known_torque)[claim.rows]) < 20.0
    assert too_large(claim) is None
    assert too_large(with_values(claim, offset=120.0)) is not None


def test_terms_that_cancel(tmp_path: Path) -> None:
    """A difference between the directions of 40 N m, and an offset that takes it back."""
    recording = record(tmp_path, joint(OFFSET))
    before = sb.add(sb.fit("coulomb", recording, starts=1), "push = c", starts=1)
    claim = Claim("direction", before, sb.add(before, "direction", starts=1), 0.01)
    assert cancelling(claim) is None
    large = with_values(claim, direction_coulomb=40.0, push=OFFSET - 40.0)
    assert np.abs(large.after.residual[large.rows]).max() < 0.5
    reason = cancelling(large)
    assert reason is not None and "times their sum" in reason


def test_gravity_and_inertia_of_a_pendulum_may_cancel(tmp_path: Path) -> None:
    """They did so before the effect, which is not blamed."""
    t = np.arange(4000) / 100.0
    w = 2.0 * np.pi * 0.8
    q = 0.5 * np.sin(w * t) * np.exp(-t / 40.0)
    v, a = np.gradient(q, t), np.gradient(np.gradient(q, t), t)
    friction = 0.05 * np.sign(v) + 0.02 * v
    torque = 0.1 * a + 0.1 * w**2 * np.sin(q) + friction + 0.02
    noise = 0.005 * np.random.default_rng(1).standard_normal(t.size)
    frame = joint(rows=t.size).with_columns(
        time=t, position=q, velocity=v, acceleration=a, torque=torque + noise
    )
    recording = record(tmp_path, frame.drop("load_torque"))
    before = sb.fit("coulomb", recording, starts=1)
    terms = term_torques(before)
    assert np.std(terms["inertia"]) > 5.0 * np.std(terms["inertia"] + terms["gravity"])
    assert cancelling(Claim("offset", before, sb.add(before, "offset", starts=1))) is None


def test_dry_friction_below_zero(direction: Claim) -> None:
    reason = negative_friction(with_values(direction, direction_coulomb=4.0))
    assert reason is not None and "negative" in reason
    # As large as Coulomb friction, within the interval.
    coulomb = direction.after.model.value("coulomb_friction")
    assert negative_friction(with_values(direction, direction_coulomb=coulomb)) is None


def test_a_base_term_may_go_to_zero(tmp_path: Path) -> None:
    """Friction in proportion to the load replaces the Coulomb term, and stays positive."""
    frame = joint()
    load, v = frame["load_torque"].to_numpy(), frame["velocity"].to_numpy()
    extra = (0.4 * np.abs(load) - 3.0) * np.sign(v)
    claim = made(tmp_path, extra, "load")
    assert claim.after.model.value("coulomb_friction") < 0.1
    assert impossible(claim) is None


def test_inertia_below_zero(tmp_path: Path) -> None:
    """The load torque holds 0.3 kg m2; an error of it may be negative, but not more than all."""
    _, _, _, a = motion()
    claim = made(tmp_path, -0.1 * a, "inertia")
    assert claim.after.model.value("inertia") == pytest.approx(-0.1, abs=0.02)
    assert negative_inertia(claim) is None
    reason = negative_inertia(made(tmp_path, -0.8 * a, "inertia", "less"))
    assert reason is not None and "inertia would be negative" in reason


@pytest.mark.parametrize(
    ("per_load", "uneven", "is_negative"), [(0.1, 0.6, False), (0.01, 5.0, True)]
)
def test_friction_under_load_is_positive_in_each_quadrant(
    tmp_path: Path, per_load: float, uneven: float, is_negative: bool
) -> None:
    """A difference of the quadrants larger than their mean is a load on another scale."""
    _, _, v, _ = motion()
    load = joint(0.0)["load_torque"].to_numpy()
    extra = per_load * np.abs(load) * np.sign(v) * (1.0 + uneven * np.sign(v * load))
    reason = negative_under_load(made(tmp_path, extra, "quadrant"))
    assert (reason is not None) is is_negative
    assert reason is None or "in one quadrant" in reason


def test_a_stribeck_curve_that_never_ends_or_never_begins(stribeck_curve: Claim) -> None:
    r = stribeck_curve.before.recording
    top = float(np.quantile(np.abs(r.velocity[stribeck_curve.rows]), 0.99))
    beyond = out_of_reach(with_values(stribeck_curve, stribeck_velocity=3.0 * top))
    assert beyond is not None and "reaches only" in beyond
    exponential = with_values(stribeck_curve, stribeck_exponent=1.0)
    # exp(-2), 14 % of the height, is left at the slowest speed; or exp(-3), 5 %.
    half, third = r.velocity_threshold / 2.0, r.velocity_threshold / 3.0
    assert unresolved(with_values(exponential, stribeck_velocity=half)) is None
    slow = unresolved(with_values(exponential, stribeck_velocity=third))
    assert slow is not None and "slower than what is scored" in slow


def test_a_lag_beyond_a_move_or_far_below_a_sample(stribeck_curve: Claim) -> None:
    lagging = sb.add(stribeck_curve.after, "frictional_lag", starts=2)
    claim = Claim("frictional_lag", stribeck_curve.after, lagging, 0.01)
    seen = with_values(claim, frictional_lag=0.03)
    assert unresolved(seen) is None and out_of_reach(seen) is None
    long = out_of_reach(with_values(claim, frictional_lag=1.8))
    assert long is not None and "typical move" in long
    short = unresolved(with_values(claim, frictional_lag=1e-4))
    assert short is not None and "less than a quarter of a sample" in short
    r = claim.after.recording
    derived = replace(r.columns["velocity"], derived=True)
    filtered = replace(r, cutoff_hz=5.0, columns={**r.columns, "velocity": derived})
    blurred = replace(claim, after=replace(claim.after, recording=filtered))
    assert unresolved(with_values(blurred, frictional_lag=0.06)) is None
    low_pass = unresolved(with_values(blurred, frictional_lag=0.04))
    assert low_pass is not None and "low-pass of the velocity" in low_pass


def test_a_lag_below_the_low_pass_of_the_acceleration_of_an_inertia(
    stribeck_curve: Claim,
) -> None:
    lagging = sb.add(stribeck_curve.after, "frictional_lag", starts=2)
    claim = Claim("frictional_lag", stribeck_curve.after, lagging, 0.01)
    r = claim.after.recording
    derived = replace(r.columns["acceleration"], derived=True)
    filtered = replace(r, cutoff_hz=5.0, columns={**r.columns, "acceleration": derived})
    known = replace(claim, after=replace(claim.after, recording=filtered))
    # The load torque was recorded: no torque needs the acceleration.
    assert unresolved(with_values(known, frictional_lag=0.03)) is None
    read = replace(r.columns["load_torque"], derived=True)
    of_inertia = replace(filtered, columns={**filtered.columns, "load_torque": read})
    blurred = replace(claim, after=replace(claim.after, recording=of_inertia))
    reason = unresolved(with_values(blurred, frictional_lag=0.03))
    assert reason is not None and "low-pass of the acceleration" in reason
    assert unresolved(with_values(blurred, frictional_lag=0.06)) is None


def test_presliding_within_a_sample(tmp_path: Path) -> None:
    claim = made(tmp_path, 0.0, "presliding")
    dry = claim.after.model.value("coulomb_friction")
    assert unresolved(with_values(claim, presliding_stiffness=dry / 0.05)) is None
    reason = unresolved(with_values(claim, presliding_stiffness=dry / 9e-6))
    assert reason is not None and "within a sample" in reason


def test_one_move_carries_what_one_move_shows(tmp_path: Path) -> None:
    """A torque that halves the error of one move, and does nothing in the others."""
    claim = made(tmp_path, 0.0, "offset")
    before = claim.before
    rows = claim.rows[move_of(claim) == 3]
    added = np.zeros_like(before.prediction)
    added[rows] = 0.5 * before.held_out_residual[rows]
    after = replace(
        claim.after, prediction=before.prediction + added, held_out=before.held_out + added
    )
    only = replace(claim, after=after)
    reason = few_events(only)
    assert reason is not None and "90 % of what it gains" in reason
    lost = one_event(only)
    assert lost is not None and "would not be found" in lost
    assert weak(only) == reason


def test_all_moves_carry_an_offset(offset: Claim) -> None:
    found = Carried.of(offset)
    assert found.share == pytest.approx(0.9, abs=0.02)
    assert found.events >= 10


def test_the_fewest() -> None:
    assert fewest(np.zeros(4)) == 0
    assert fewest(np.ones(10)) == 9
    assert fewest(np.array([0.0, 100.0, 1.0])) == 1


def test_single_samples_of_each_move_show_no_shape(tmp_path: Path) -> None:
    """A peak of three samples after each reversal is no Stribeck curve; a wide one is."""

    def claim(name: str, shape: Callable[[Array], Array]) -> Claim:
        v = motion(20000, 1000.0)[2]
        recording = record(tmp_path, joint(shape(v) * np.sign(v), rows=20000, rate=1000.0), name)
        before = sb.fit("coulomb", recording, starts=1)
        return Claim("stribeck", before, sb.add(before, "stribeck", starts=4), 0.01)

    reason = few_samples(claim("peak", lambda v: 8.0 * (np.abs(v) < 0.003)))
    assert reason is not None and "samples a move carry" in reason
    assert few_samples(claim("curve", lambda v: 1.5 * np.exp(-np.abs(v) / 0.15))) is None


def test_an_effect_of_few_samples(tmp_path: Path, offset: Claim) -> None:
    """Twenty large errors of a recording of 20 000 samples, in as many moves, show no delay."""
    v = motion(20000, 1000.0)[2]
    turns = np.flatnonzero(np.diff(np.sign(v)))[:20]
    extra = np.zeros(v.size)
    extra[turns + 1] = -6.0 * np.sign(v[turns + 1])
    recording = record(tmp_path, joint(extra, rows=v.size, rate=1000.0))
    before = sb.fit("coulomb", recording, starts=1)
    after = replace(before, prediction=before.prediction + extra, held_out=before.held_out + extra)
    claim = Claim("delay", before, after, 0.01)
    reason = few_samples(claim)
    assert reason is not None and f"of {before.rows.size} samples carry 90 %" in reason
    assert few_samples(replace(offset, effect="delay")) is None


def test_an_effect_that_few_samples_decide(offset: Claim) -> None:
    """It takes 3 N m from one sample of a hundred, and adds 1 N m to the error of four."""
    rows, drawn = offset.rows, np.random.default_rng(1).random(offset.rows.size)
    along = offset.after.held_out.copy()
    away = -1.0 * np.sign(offset.after.held_out_residual[rows])
    along[rows] += np.where((drawn > 0.01) & (drawn < 0.05), away, 0.0)
    without = offset.after.held_out.copy()
    without[rows] -= np.where(drawn < 0.01, 3.0, 0.0)
    before = replace(offset.before, prediction=without, held_out=without)
    after = replace(offset.after, prediction=along, held_out=along)
    squares = [np.sum(fit.held_out_residual[rows] ** 2) for fit in (before, after)]
    assert squares[1] < 0.6 * squares[0]
    reason = worsened(Claim("offset", before, after, 0.01))
    assert reason is not None and reason.startswith("the mean absolute error of the samples")
    assert worsened(Claim("backlash", before, after, 0.01)) is None
    assert worsened(offset) is None


def test_a_gain_and_an_offset_that_do_not_change_are_no_warm_up(tmp_path: Path) -> None:
    frame = joint()
    torque, t = frame["torque"].to_numpy(), frame["time"].to_numpy()
    reason = steady(made(tmp_path, 0.05 * torque + 0.4, "warm_up", "steady"))
    assert reason == "offset and gain that do not change with time explain as much"
    settles = np.exp(-3.0 * t / t[-1])
    assert steady(made(tmp_path, (0.1 * torque + 0.4) * settles, "warm_up", "settles")) is None


def test_a_shape_that_is_needed_at_its_bound(tmp_path: Path) -> None:
    """Friction with the tenth power of the load; one with its size is not at a bound."""
    frame = joint()
    load, v = frame["load_torque"].to_numpy(), frame["velocity"].to_numpy()
    share = np.abs(load) / np.abs(load).max()
    steep = made(tmp_path, 4.0 * share**10 * np.sign(v), "load", "steep")
    reason = shape_at_bound(steep)
    assert reason is not None and reason.startswith("load_exponent is at its bound 2.5")
    assert shape_at_bound(made(tmp_path, 2.0 * share * np.sign(v), "load", "plain")) is None


@pytest.mark.parametrize("condition", ["speed", "time"])
def test_a_torque_that_acts_in_one_condition_alone(tmp_path: Path, condition: str) -> None:
    """What acts in fast motion alone is not friction that depends on the position."""
    t, q, v, _ = motion()
    place = 1.5 * np.sin(2.0 * q) * np.sign(v)
    share = np.abs(v) > np.median(np.abs(v)) if condition == "speed" else t > 0.6 * t[-1]
    reason = uneven(made(tmp_path, place * share, "position"))
    words = {"speed": "in fast motion", "time": "in the last part"}
    assert reason is not None and words[condition] in reason.split("it is")[0], reason
    assert uneven(made(tmp_path, place, "position", "all")) is None


def test_a_tight_spot_is_uneven_along_the_stroke(tmp_path: Path) -> None:
    """It is a function of the position: its waves are wrong in one half of the stroke."""
    _, q, v, _ = motion()
    spot = 2.0 * np.exp(-(((q - 0.5) / 0.08) ** 2)) * np.sign(v)
    assert uneven(made(tmp_path, spot, "position")) is None


def test_a_torque_of_twice_the_size_is_claimed(tmp_path: Path) -> None:
    """Effects are not exact: up to three times as large is allowed."""
    _, q, v, _ = motion()
    place = 1.5 * np.sin(2.0 * q) * np.sign(v)
    fast = np.abs(v) > np.median(np.abs(v))
    assert uneven(made(tmp_path, place * np.where(fast, 1.0, 0.5), "position")) is None


def test_friction_that_would_drive_the_joint_backward(direction: Claim) -> None:
    """Dry friction is positive, and at speed viscous friction in one direction exceeds it."""
    viscous = direction.after.model.value("viscous_friction")
    reason = negative_friction(with_values(direction, direction_viscous=viscous + 6.0))
    assert reason is not None and reason.startswith("friction would be negative")
    assert negative_friction(with_values(direction, direction_viscous=viscous)) is None
