"""Stretches that no friction model explains are found, and nothing else is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.identify.left_out.transients import (
    MOST,
    STRETCHES,
    WINDOWS,
    flexible_columns,
    of_one_size,
    stretches,
    transient_rows,
)
from synthetic import joint, motion, record


def blow() -> np.ndarray:
    """A blow of 40 N m between 12 and 12.4 s."""
    t = motion()[0]
    return np.where((t > 12.0) & (t < 12.4), 40.0 * np.sin(31.4 * (t - 12.0)), 0.0)


def test_an_ordinary_recording_has_none(plain: sb.Recording) -> None:
    assert not transient_rows(plain).any()
    v = motion()[2]
    assert stretches(plain, np.zeros(v.size, dtype=bool)) == []


def test_a_blow_is_found_reported_and_not_fitted_to(tmp_path: Path, plain: sb.Recording) -> None:
    recording = record(tmp_path, joint(blow()))
    marked = transient_rows(recording)
    t = recording.time
    assert marked[(t > 12.0) & (t < 12.4) & recording.moving].all()
    assert marked.mean() < 0.1
    ((start, end),) = stretches(recording, marked)
    assert start < 12.05 and end > 12.3
    fit = sb.fit("coulomb", recording)
    assert fit.to_dict()["transients"] == [[start, end]]
    # It is scored all the same: the rows are the same for every model.
    assert fit.rmse > 5.0 * sb.fit("coulomb", plain).rmse
    assert fit.estimates["coulomb_friction"].value == pytest.approx(3.0, rel=0.01)


def test_what_comes_again_and_again_is_no_transient(tmp_path: Path) -> None:
    """A torque of any size that repeats is something to be explained."""
    v = motion()[2]
    extra = 20.0 * np.exp(-((v / 0.05) ** 2)) * np.sign(v)
    assert not transient_rows(record(tmp_path, joint(extra))).any()


def bumps(times: tuple[float, ...], size: float, lasting: float = 0.3) -> np.ndarray:
    """Blows of `size` N m at some times."""
    t = motion()[0]
    return sum(np.where(np.abs(t - at) < lasting / 2, size, 0.0) for at in times)


def test_the_flexible_model_has_every_form_of_friction(plain: sb.Recording) -> None:
    """Each form that an effect has lies in the span of the columns; and none is there twice."""
    r = plain
    v, q, temperature, load = r.velocity, r.position, r.temperature, r.load_torque
    sign, speed = np.sign(v), np.abs(v)
    reference = r.scales()["speed"]
    u = (q - q.min()) / (q.max() - q.min())
    warmer = temperature - temperature.mean()
    forms = {
        "coulomb": sign, "viscous": v, "square root": sign * np.sqrt(speed),
        "quadratic": v * speed, "stribeck": sign * np.exp(-speed / reference / 0.05),
        "offset": np.ones_like(v), "direction": speed, "inertia": r.acceleration,
        "gravity": 2.0 * np.sin(q + 0.7), "position": sign * np.cos(3.0 * np.pi * u),
        "temperature": warmer * sign, "warm viscous": warmer * v,
        "load": load, "load friction": np.abs(load) * sign,
    }  # fmt: skip
    columns = np.column_stack(flexible_columns(r))
    for name, form in forms.items():
        left = form - columns @ np.linalg.lstsq(columns, form, rcond=None)[0]
        assert np.linalg.norm(left) < 1e-8 * np.linalg.norm(form), name
    scaled = columns / np.linalg.norm(columns, axis=0)
    # Without rest, `sign` squared is the offset: those two columns alone are the same.
    assert np.linalg.matrix_rank(scaled, 1e-7) >= columns.shape[1] - 1


def test_columns_follow_the_channels(plain: sb.Recording) -> None:
    every = len(flexible_columns(plain))
    missing = {"acceleration": 1, "position": 6, "temperature": 2, "load_torque": 2}
    for channel, count in missing.items():
        assert len(flexible_columns(replace(plain, **{channel: None}))) == every - count, channel
    # A slide has no gravity that turns with its position.
    assert len(flexible_columns(replace(plain, joint_kind="prismatic"))) == every - 2


def test_columns_are_scaled_and_zero_ones_left_out() -> None:
    moving = np.array([True, True, True, False])
    columns = [np.array([3.0, -3.0, 3.0, 9.0]), np.zeros(4), np.array([0.0, 0.0, 2.0, 1.0])]
    made = of_one_size([column.copy() for column in columns], moving)
    assert made.shape == (4, 2)
    np.testing.assert_allclose((made[moving] ** 2).mean(axis=0), 1.0)
    np.testing.assert_allclose(made[:, 0], columns[0] / 3.0)
    np.testing.assert_allclose(made[:, 1], columns[2] / np.sqrt(4.0 / 3.0))


def test_a_small_blow_shows_where_friction_is_complicated(tmp_path: Path) -> None:
    """It is a tenth of the friction, which depends on position, temperature and load."""
    t, q, v, _ = motion()
    extra = np.sign(v) * (0.8 * np.cos(4.0 * q) + 0.02 * (q - 1.0) ** 2) + 0.4 * np.sqrt(np.abs(v))
    # Three are transients ...
    times = (5.0, 12.0, 21.0)
    assert len(times) == STRETCHES
    recording = record(tmp_path, joint(extra + bumps(times, 1.5)), "few")
    marked = transient_rows(recording)
    found = [at for at in times if marked[np.abs(t - at) < 0.1].any()]
    assert found == list(times) and marked.mean() < MOST
    # ... a fourth would need an explanation.
    more = record(tmp_path, joint(extra + bumps((*times, 26.0), 1.5)), "more")
    assert not transient_rows(more).any()


def test_a_window_needs_twenty_samples(tmp_path: Path) -> None:
    """Fewer than that, and what is an outlier cannot be said."""
    recording = record(tmp_path, joint(blow()[900 : 900 + 20 * WINDOWS], rows=20 * WINDOWS))
    assert recording.moving.all() and transient_rows(recording).any()
    moving = recording.moving.copy()
    moving[0] = False
    assert not transient_rows(replace(recording, moving=moving)).any()


def test_stretches_are_merged_across_short_rests(plain: sb.Recording) -> None:
    t = plain.time
    marked = np.zeros(t.size, dtype=bool)
    for start, end in ((1.0, 2.0), (2.5, 3.0), (4.2, 4.4), (9.0, 9.0)):
        marked |= (t >= start - 1e-9) & (t <= end + 1e-9)
    expected = [(1.0, 3.0), (4.2, 4.4), (9.0, 9.0)]
    np.testing.assert_allclose(stretches(plain, marked), expected, atol=1e-9)


def test_a_hard_acceleration_is_no_transient(tmp_path: Path) -> None:
    """An error that grows with the acceleration is that of an inertia or of a drive train."""
    frame = joint()
    t = frame["time"].to_numpy()
    # Shaken hard twice; what accelerates hard has an error that no column explains.
    shaken = (np.abs(t - 9.0) < 0.5) | (np.abs(t - 21.0) < 0.5)
    shake = np.where(shaken, 0.05 * np.sin(40.0 * t), 0.0)
    torque = np.where(shaken, 3.0 * np.cos(97.0 * t), 0.0)
    still = frame.with_columns(torque=frame["torque"] + torque)
    moved = still.with_columns(
        position=still["position"] + shake,
        velocity=still["velocity"] + np.gradient(shake, t),
        acceleration=still["acceleration"] + np.gradient(np.gradient(shake, t), t),
    )
    # Where the joint moves as at other times, the same error is a transient.
    assert transient_rows(record(tmp_path, still, "still"))[shaken].any()
    assert not transient_rows(record(tmp_path, moved, "moved")).any()


def far_once(extra: float) -> sb.Recording:
    """A joint on a spring that moves ten times as far as usual once, under `extra` N m there."""
    t = np.arange(0.0, 60.0, 0.005)
    far = np.exp(-(((t - 31.0) / 1.2) ** 2))
    q = 0.2 * np.sin(2.1 * t) + 0.05 * np.sin(5.3 * t) + 2.0 * far
    v = np.gradient(q, t)
    torque = (
        0.5 * np.sign(v) + 0.2 * v + 0.4 * q + 0.3 * q**2 + extra * np.where(far > 0.3, 1.0, 0.0)
    )
    noise = 0.01 * np.random.default_rng(3).standard_normal(t.size)
    return sb.Recording.from_columns(time=t, position=q, velocity=v, torque=torque + noise)


def test_where_a_simple_model_holds_is_no_transient() -> None:
    """The flexible model is wrong beyond the usual stroke; the spring of the joint is not."""
    assert not transient_rows(far_once(0.0)).any()
    recording = far_once(3.0)
    marked = transient_rows(recording)
    assert marked[(np.abs(recording.time - 31.0) < 1.0) & recording.moving].all()


def test_a_stretch_ends_with_its_run(plain: sb.Recording) -> None:
    """The time of the next run may begin anywhere."""
    half = plain.rows // 2
    run = (np.arange(plain.rows) >= half).astype(np.int64)
    marked = np.zeros(plain.rows, dtype=bool)
    marked[half - 20 : half + 20] = True
    time = np.where(run == 0, plain.time, plain.time - plain.time[half])
    spans = stretches(replace(plain, run=run, time=time), marked)
    assert len(spans) == 2 and all(end > start for start, end in spans)
