"""Effects beside structure that no effect explains."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.trials.known_size import has_known_size
from stribeck.diagnosis.trials.remainder import (
    BESIDE_STRUCTURE,
    LEAST_PART,
    REASON,
    imitations,
    part_explained,
    unknown_structure,
)
from synthetic import Array, joint, joint_with_stribeck_curve, motion, record

V = motion()[2]


def gap(slowest: float, fastest: float, size: float = 0.3) -> Array:
    """Friction that is smaller in a band of speeds, which no effect of the catalog has."""
    speed = np.abs(V)
    return -size * ((speed > slowest) & (speed < fastest)) * np.sign(V)


def load_dependence(share: float) -> Array:
    """Dry friction in proportion to the load."""
    return share * np.abs(joint()["load_torque"].to_numpy()) * np.sign(V)


@pytest.mark.parametrize(
    ("gain", "unknown", "part"),
    [(0.3, 0.3, 0.5), (3.0, 1.0, 0.75), (0.0, 0.2, 0.0), (-0.1, 0.2, 0.0), (None, 0.9, 1.0)],
)
def test_the_part_is_a_share_of_both(gain: float | None, unknown: float, part: float) -> None:
    assert part_explained(gain, unknown, Unexplained(unknown, "everywhere", unknown)) == part


def test_more_structure_than_is_explained_limits_the_part() -> None:
    """Even where nothing shows what the structure depends on."""
    remains = Unexplained(0.8, "everywhere")
    assert part_explained(0.5, 0.0, remains) == BESIDE_STRUCTURE
    assert part_explained(0.9, 0.0, remains) == 1.0
    assert part_explained(0.01, 0.0, Unexplained(0.05, None)) == 1.0
    assert part_explained(0.01, 0.0, Unexplained(None, None)) == 1.0


@pytest.mark.parametrize(("drive_train", "part"), [(False, 0.25), (True, 0.6)])
def test_a_drive_train_has_the_shocks_that_others_may_imitate(
    drive_train: bool, part: float
) -> None:
    remains = Unexplained(0.9, "after changes of the load", 0.9, 0.7)
    assert part_explained(0.3, 0.9, remains, drive_train=drive_train) == pytest.approx(part)


@pytest.fixture(scope="module")
def fitted(tmp_path_factory: pytest.TempPathFactory) -> sb.Fit:
    """A model beside a gap in the friction curve."""
    recording = record(tmp_path_factory.mktemp("remainder"), joint(gap(0.3, 0.6)))
    return sb.fit("coulomb", recording, starts=1)


def test_noise_and_vibration_are_no_unknown_structure(fitted: sb.Fit) -> None:
    """Neither what counts as noise, nor what no recorded channel shows."""
    for remains in (
        Unexplained(0.05, None, 0.05),
        Unexplained(0.8, "vibration"),
        Unexplained(None, None),
    ):
        assert unknown_structure(fitted, remains) == 0.0


def test_what_the_measurement_explains_is_not_unknown(fitted: sb.Fit, tmp_path: Path) -> None:
    """A gap is; what a torque leaves that is read two samples late is not."""
    remains = Unexplained(0.5, "everywhere", 0.5)
    assert unknown_structure(fitted, remains) > 0.3
    frame = joint()
    late = frame.with_columns(torque=np.roll(frame["torque"].to_numpy(), 2))
    read_late = sb.fit("coulomb", record(tmp_path, late), starts=1)
    assert unknown_structure(read_late, remains) == 0.0


def test_friction_must_explain_as_much_as_remains_and_other_effects_half(fitted: sb.Fit) -> None:
    (found, *_) = sb.diagnose(fitted, brief=True, least_fall=1e-4).findings

    def demoted(effect: str, part: float) -> bool:
        return imitations([replace(found, effect=effect, part=part)]) == [effect]

    assert demoted("load", 0.49) and not demoted("load", 0.51)
    assert demoted("delay", 0.32) and not demoted("delay", 0.34)


@pytest.mark.slow
def test_what_explains_less_than_what_remains_is_demoted(tmp_path: Path) -> None:
    """A Stribeck curve follows a part of a gap at low speed."""
    extra = gap(0.3, 0.6) + load_dependence(0.15)
    found = sb.improve("coulomb", record(tmp_path, joint(extra)), starts=2)
    assert found.final.model.spec == "coulomb+load"
    assert found.last.verdict == "unexplained" and found.unexplained.shown > 0.3
    doubted = {finding.effect: finding for finding in found.last.demoted}
    assert doubted["stribeck"].demoted == REASON
    assert doubted["stribeck"].confidence < LEAST_PART
    assert found.to_dict()["demoted"] == [finding.to_dict() for finding in found.last.demoted]
    # The load, which is as large as the gap and no part of it, stays as it is.
    (step,) = found.steps
    assert step.finding.effect == "load" and step.finding.confidence > 0.9


@pytest.mark.slow
def test_what_explains_hardly_more_than_what_remains_is_not_certain(tmp_path: Path) -> None:
    extra = gap(0.6, 0.9) + load_dependence(0.06)
    found = sb.improve("coulomb", record(tmp_path, joint(extra)), starts=2)
    (step,) = found.steps
    assert step.finding.effect == "load"
    assert LEAST_PART < step.finding.confidence == step.finding.part < 0.8
    assert step.finding.weight > 0.99
    assert "The structure that remains limits this confidence." in str(found)


def test_without_structure_nothing_changes(tmp_path: Path) -> None:
    found = sb.improve("coulomb", record(tmp_path, joint_with_stribeck_curve()), starts=2)
    assert [(step.finding.effect, step.finding.part) for step in found.steps] == [("stribeck", 1.0)]


def test_the_size_of_an_effect_is_of_the_parameters_that_the_model_has(tmp_path: Path) -> None:
    """The temperature of dry friction has one for the Stribeck height, if there is such a curve."""
    fitted = sb.fit("coulomb+temperature_dry", record(tmp_path, joint()), starts=1)
    assert "temperature_dry_height" not in fitted.estimates
    assert not has_known_size("temperature_dry", fitted)  # no temperature acts on this joint


def test_one_step_says_less_beside_an_unknown_torque_than_beside_another_effect(
    tmp_path: Path,
) -> None:
    """A torque of the time alone, and a Stribeck curve that the next step finds."""
    t, _, v, _ = motion()

    def first(extra: Array, name: str) -> sb.Finding:
        recording = record(tmp_path, joint(0.6 + extra), name)
        finding = sb.diagnose(sb.fit("coulomb", recording, starts=1)).findings[0]
        assert finding.effect == "offset"
        return finding

    unknown = first(0.9 * np.sin(2.0 * np.pi * 0.31 * t), "unknown")
    other = first(0.9 * np.exp(-np.abs(v) / 0.15) * np.sign(v), "other")
    assert unknown.part < 0.75 and unknown.confidence == min(unknown.part, unknown.weight)
    assert other.part > 0.9
