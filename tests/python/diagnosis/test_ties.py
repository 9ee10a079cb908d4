"""The ties of the findings are judged again in the last model."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from made_paths import path_through
from scipy.signal import lfilter
from stribeck.diagnosis.loop.path import ImprovementPath
from stribeck.diagnosis.loop.ties import settled
from stribeck.diagnosis.result import Finding
from stribeck.diagnosis.trials.imitations import NARROW
from stribeck.diagnosis.trials.proxies import alike_in_form, fits_exactly
from synthetic import joint, motion, record


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> ImprovementPath:
    """A Stribeck curve and a wrong inertia, both found."""
    _, _, v, a = motion()
    extra = 0.2 * a + 1.5 * np.exp(-((v / 0.15) ** 2)) * np.sign(v)
    base = sb.fit("coulomb", record(tmp_path_factory.mktemp("ties"), joint(extra)), starts=1)
    made = path_through(base, ("stribeck", "inertia"))
    for step in made.steps:
        plain = replace(step.finding, weight=0.5, certainty=1.0, indistinguishable_from=())
        made = made.with_instead(plain)
    return made


def first_with(path: ImprovementPath, *ties: str, least: float = 0.01) -> Finding:
    """The first finding as it is settled, where it had some ties at its step."""
    tied = replace(path.steps[0].finding, indistinguishable_from=ties)
    return settled(path.with_instead(tied), least, seed=0).steps[0].finding


def test_findings_without_ties_stay(path: ImprovementPath) -> None:
    assert settled(path, 0.01, seed=0) is path


@pytest.mark.parametrize("ties", [("inertia",), ("load",), ("inertia", "load")])
def test_ties_in_the_model_or_that_predict_worse_are_lost(
    path: ImprovementPath, ties: tuple[str, ...]
) -> None:
    finding = first_with(path, *ties)
    assert finding.indistinguishable_from == ()
    assert finding.weight == NARROW


def test_an_effect_that_does_not_pass_gains_nothing(path: ImprovementPath) -> None:
    finding = first_with(path, "inertia", "load", least=2.0)
    assert finding.indistinguishable_from == ("load",)
    assert finding.weight == 0.5


def test_friction_ties_with_a_cause_whose_free_form_explains_as_much(tmp_path: Path) -> None:
    """A torque constant that falls up to a torque: the formula of the catalog fits badly."""
    frame = joint(rows=8000)
    torque = frame["torque"].to_numpy()
    shown = torque * (1.0 + 0.3 * np.minimum((torque / 12.0) ** 2, 0.2))
    recording = record(tmp_path, frame.with_columns(torque=shown))
    path = path_through(sb.fit("coulomb", recording, starts=1), ("load", "quadrant"))
    load, quadrant = path.steps
    found = replace(quadrant.finding, weight=1.0, indistinguishable_from=())
    rivals = ("saturation", "spring", "stribeck")
    path = replace(path, steps=(load, replace(quadrant, finding=found, rivals=rivals)))
    ended = settled(path, 0.01, seed=0).steps[1].finding
    assert ended.indistinguishable_from == ("saturation",)
    assert ended.weight == pytest.approx(0.5)


def spring(folder: Path, extra: np.ndarray) -> sb.Fit:
    """Gravity fitted to a torque of position."""
    recording = record(folder, joint(extra, rows=8000))
    return sb.fit("coulomb+gravity", recording, starts=1)


def test_gravity_is_alike_to_a_spring_only_where_its_form_does_not_fit(tmp_path: Path) -> None:
    q = motion(8000)[1]
    weight = spring(tmp_path, 0.8 * np.sin(q + 0.2))
    assert fits_exactly("gravity", weight) and alike_in_form("gravity", weight) == ()
    soft = spring(tmp_path, 0.8 * np.arctan(1.3 * (q - 0.1)))
    assert not fits_exactly("gravity", soft)
    assert alike_in_form("gravity", soft) == ("spring",)


def test_a_torque_that_rises_and_falls_again_is_no_spring(tmp_path: Path) -> None:
    q = motion(8000)[1]
    wave = spring(tmp_path, 0.8 * np.cos(q) + 0.02 * np.cos(3.0 * q))
    assert not fits_exactly("gravity", wave)
    assert alike_in_form("gravity", wave) == ()


def test_fewer_points_than_intervals_are_averaged_one_by_one(tmp_path: Path) -> None:
    frame = joint(rows=3000)[::100]
    recording = record(tmp_path, frame, moving_above=0.01)
    fitted = sb.fit("coulomb+gravity", recording, starts=1)
    assert fitted.rows.size < 40
    assert alike_in_form("gravity", fitted) == ()


def test_a_stribeck_curve_and_a_late_torque_tie_with_a_lag_of_the_curve(tmp_path: Path) -> None:
    """All torque is late by two samples."""
    v = motion(6000)[2]
    frame = joint(2.0 * np.exp(-np.abs(v) / 0.3) * np.sign(v), rows=6000)
    late = frame.with_columns(torque=np.roll(frame["torque"].to_numpy(), 2))[2:]
    base = sb.fit("coulomb", record(tmp_path, late), starts=1)
    path = path_through(base, ("frictional_lag",))
    plain = replace(path.steps[0].finding, weight=1.0, certainty=1.0, indistinguishable_from=())
    found = settled(path.with_instead(plain), 0.01, seed=0).steps[0].finding
    assert found.indistinguishable_from == ("delay",)
    assert found.weight == pytest.approx(0.5, abs=0.01)


def test_a_lag_of_the_curve_alone_is_no_late_torque(tmp_path: Path) -> None:
    """A curve that follows the speed by 50 ms."""
    v = motion(6000)[2]
    curve = 2.0 * np.exp(-np.abs(v) / 0.3)
    share = 0.01 / 0.05
    lagging = lfilter([share], [1.0, share - 1.0], curve, zi=[(1.0 - share) * curve[0]])[0]
    base = sb.fit("coulomb", record(tmp_path, joint(lagging * np.sign(v), rows=6000)), starts=1)
    path = path_through(base, ("frictional_lag",))
    plain = replace(path.steps[0].finding, weight=1.0, certainty=1.0, indistinguishable_from=())
    found = settled(path.with_instead(plain), 0.01, seed=0).steps[0].finding
    assert "delay" not in found.indistinguishable_from
