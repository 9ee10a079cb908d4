"""A torque that is late shows the friction of a rest in the first samples of a move."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb

COULOMB, VISCOUS, LOAD = 2.0, 0.8, 0.25
RATE, LATE = 1000, 11


def moves_with_rests(path: Path) -> sb.Recording:
    """Moves of random length; at rest a brake holds any torque. The torque is 11 ms late."""
    rng = np.random.default_rng(1)
    pieces, held, side = [], [], 1.0
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
    late = np.concatenate([np.full(LATE, torque[0]), torque[:-LATE]])
    pl.DataFrame(
        {
            "time": np.arange(a.size) / RATE,
            "position": np.cumsum(v) / RATE,
            "velocity": v + 1e-3 * rng.standard_normal(a.size),
            "acceleration": a,
            "torque": late + 0.05 * rng.standard_normal(a.size),
            "load_torque": LOAD * a,
        }
    ).write_parquet(path)
    return sb.read(path, joint_kind="revolute")


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    return moves_with_rests(tmp_path_factory.mktemp("late") / "late.parquet")


def test_the_delay_and_the_friction_are_exact(recording: sb.Recording) -> None:
    found = sb.fit("coulomb+delay", recording, starts=4)
    assert found.model.value("delay") == pytest.approx(LATE / RATE, rel=0.01)
    assert found.model.value("coulomb_friction") == pytest.approx(COULOMB, rel=0.01)
    assert found.model.value("viscous_friction") == pytest.approx(VISCOUS, rel=0.03)


def test_a_note_counts_the_samples_left_out(recording: sb.Recording) -> None:
    with_delay, without = (
        sb.fit(spec, recording, starts=1) for spec in ("coulomb+delay", "coulomb")
    )
    left_out = without.rows.size - with_delay.rows.size
    assert left_out > 0
    assert any(f"the friction of {left_out} samples beside a rest" in n for n in with_delay.notes)
    assert not any("beside a rest" in note for note in without.notes)


@pytest.mark.slow
def test_nothing_else_is_named(recording: sb.Recording) -> None:
    found = sb.improve("coulomb", recording)
    assert [step.finding.effect for step in found.steps] == ["delay"]
    assert found.steps[0].finding.confidence > 0.9
