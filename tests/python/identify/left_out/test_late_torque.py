"""A torque that is late shows the friction of a rest in the first samples of a move."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from stribeck.identify.left_out.late_torque import friction_of_rest, friction_of_slow_motion
from stribeck.identify.left_out.torque_shift import torque_shift
from stribeck.motion.generate.hidden import generate

COULOMB, VISCOUS, LOAD = 2.0, 0.8, 0.25
RATE, LATE = 1000, 11


def moves_with_rests(late: int) -> sb.Recording:
    """Moves of random length, at rest a brake holds any torque, which is `late` samples late."""
    rng = np.random.default_rng(1)
    pieces, held, side = [np.zeros(300)], [np.zeros(300)], 1.0
    for _ in range(24):
        a = rng.uniform(4.0, 10.0)
        ramp, cruise, rest = (int(n) for n in rng.integers((80, 50, 300), (160, 250, 600)))
        pieces += [np.full(ramp, side * a), np.zeros(cruise), np.full(ramp, -side * a)]
        held += [np.zeros(2 * ramp + cruise), np.full(rest, rng.uniform(-COULOMB, COULOMB))]
        pieces += [np.zeros(rest)]
        side = -side
    a, brake = np.concatenate(pieces), np.concatenate(held)
    v = np.cumsum(a) / RATE
    v[np.abs(v) < 1e-9] = 0.0
    torque = np.where(v == 0.0, brake, COULOMB * np.sign(v) + VISCOUS * v) + LOAD * a
    return sb.Recording.from_columns(
        joint_kind="revolute",
        time=np.arange(a.size) / RATE,
        position=np.cumsum(v) / RATE,
        velocity=v + 1e-3 * rng.standard_normal(a.size),
        acceleration=a,
        torque=np.roll(torque, late) + 0.05 * rng.standard_normal(a.size),
        load_torque=LOAD * a,
    )


@pytest.fixture(scope="module")
def recording() -> sb.Recording:
    return moves_with_rests(LATE)


def test_the_delay_and_the_friction_are_exact(recording: sb.Recording) -> None:
    found = sb.fit("coulomb+delay", recording, starts=4)
    assert found.model.value("delay") == pytest.approx(LATE / RATE, rel=0.01)
    assert found.model.value("coulomb_friction") == pytest.approx(COULOMB, rel=0.01)
    assert found.model.value("viscous_friction") == pytest.approx(VISCOUS, rel=0.03)


def test_the_shift_follows_from_the_recording(recording: sb.Recording) -> None:
    assert torque_shift(recording) == LATE
    in_time = moves_with_rests(0)
    assert torque_shift(in_time) == 0
    assert not friction_of_rest(in_time).any()


def test_a_torque_that_leads(recording: sb.Recording) -> None:
    assert torque_shift(moves_with_rests(-LATE)) == -LATE


def test_friction_that_builds_up_is_in_time() -> None:
    """After a reversal presliding looks like a torque that is late."""
    frame, _ = generate(["presliding"], seconds=20.0, rate=200.0, seed=8)
    assert torque_shift(sb.read(frame)) == 0


def test_a_note_counts_the_samples_left_out(recording: sb.Recording) -> None:
    found = sb.fit("coulomb", recording, starts=1)
    left_out = int(recording.moving.sum()) - found.rows.size
    assert left_out == int(friction_of_rest(recording).sum()) > 0
    assert any(f"about 11 ms: {left_out} samples beside a rest" in note for note in found.notes)
    assert found.to_dict()["transients"] == []


def test_the_torque_of_slow_samples_is_in_doubt() -> None:
    """At a reversal they are few; those between the two changes of sign show the delay."""
    t = np.arange(0.0, 40.0, 0.005)
    v = np.sin(1.3 * t) + 0.4 * np.sin(14.0 * t) + 0.2 * np.sin(37.0 * t)
    late = 3
    torque = np.roll(2.0 * np.sign(v) + v, late)
    v = v + 0.004 * np.random.default_rng(5).standard_normal(t.size)
    r = sb.Recording.from_columns(time=t, velocity=v, torque=torque)
    assert torque_shift(r) == late
    left_out = friction_of_slow_motion(r)
    slow = ~r.moving
    shown = np.zeros(t.size, dtype=bool)
    for ahead in (late - 1, late, late + 1):
        shown[np.flatnonzero(slow[:-ahead]) + ahead] = True
    inside = slice(late + 1, None)
    assert np.array_equal(left_out[inside], (shown & r.moving)[inside])
    wrong = r.moving & ~left_out & (np.sign(torque) != np.sign(v))
    assert wrong.sum() > 20


@pytest.mark.slow
def test_nothing_else_is_named(recording: sb.Recording) -> None:
    found = sb.improve("coulomb", recording)
    assert [step.finding.effect for step in found.steps] == ["delay"]
    assert found.steps[0].finding.confidence > 0.9


def test_samples_in_doubt_are_not_scored(recording: sb.Recording) -> None:
    """Beside a rest any torque may be shown: the error does not count it."""
    found = sb.fit("coulomb+delay", recording, starts=1)
    doubtful = friction_of_rest(recording)
    assert found.scored.sum() == recording.moving.sum() - doubtful.sum()
    assert found.rmse == pytest.approx(0.05, rel=0.1)
    kept = np.sqrt(np.mean(found.residual[doubtful] ** 2))
    assert kept > 10.0 * found.rmse
    assert found.to_dict()["scored"]["rows"] == found.scored.sum()
    compared = sb.compare([found], recording).models[0]
    assert compared.rmse == found.rmse
