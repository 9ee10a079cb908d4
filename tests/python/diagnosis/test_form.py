"""Friction effects whose torque has another form than their law."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
import stribeck as sb
from stribeck.benchmark.cases import Case
from stribeck.diagnosis.loop import form
from stribeck.diagnosis.loop.form import of_other_form
from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.result import Finding
from stribeck.diagnosis.trials.imitations import explained_by_causes
from synthetic import joint, joint_with_stribeck_curve, motion, record

V = motion()[2]
#: Enough to pass each part of the stroke at many speeds.
ROWS = 12000
#: Structure that remains, as a diagnosis says it.
REMAINS = Unexplained(0.5, "everywhere", 0.5)


def test_a_curve_in_the_place_of_a_gap_is_demoted(tmp_path: Path) -> None:
    """Friction that is smaller in a band of speeds is no effect of the speed, though two follow it.

    The second takes the place of the first once that is demoted.
    """
    speed = np.abs(V)
    gap = -0.3 * ((speed > 0.6) & (speed < 0.9)) * np.sign(V)
    found = sb.improve("coulomb", record(tmp_path, joint(gap)), starts=2)
    assert not found.steps and found.last.verdict == "unexplained"
    doubted = {finding.effect: finding for finding in found.last.demoted}
    assert set(doubted) == {"stribeck", "nonlinear_viscous"}
    assert all("free function of the speed" in str(f.demoted) for f in doubted.values())
    assert all(finding.confidence <= 0.5 for finding in doubted.values())


def test_tight_spots_that_move_with_the_speed_are_no_function_of_the_position(
    tmp_path: Path,
) -> None:
    """Fast motion meets them where slow motion does not: `position` is in part an imitation."""
    _, q, v, _ = motion(ROWS)
    spots = 0.2 * np.cos(5.0 * q) * (1.0 + np.tanh(2.0 * np.log(np.abs(v) / 0.5))) * np.sign(v)
    found = sb.improve("coulomb", record(tmp_path, joint(spots, rows=ROWS)), starts=2)
    assert not found.steps and found.last.verdict == "unexplained"
    (doubted,) = (finding for finding in found.last.demoted if finding.effect == "position")
    assert "position and speed" in str(doubted.demoted)


def test_two_effects_of_the_same_variable_are_found(tmp_path: Path) -> None:
    """Each has another form than its law until the other is in the model."""
    speed = np.abs(V)
    extra = np.sign(V) * (np.exp(-speed / 0.1) + 0.5 * speed**2)
    found = sb.improve("coulomb", record(tmp_path, joint(extra)), starts=2)
    assert {step.finding.effect for step in found.steps} == {"stribeck", "nonlinear_viscous"}
    assert not found.last.demoted and found.last.verdict == "none"


def test_an_effect_with_the_form_of_its_law_stays(tmp_path: Path) -> None:
    """Also beside structure of another variable."""
    found = sb.improve("coulomb", record(tmp_path, joint_with_stribeck_curve()), starts=2)
    findings = [step.finding for step in found.steps]
    assert [finding.effect for finding in findings] == ["stribeck"]
    assert of_other_form(findings, found.final, REMAINS, 0) == {}


def test_an_effect_of_a_channel_of_its_own_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A free function of the load that explains more confirms that friction depends on it."""
    fitted = sb.fit("coulomb+load+stribeck", record(tmp_path, joint()), starts=1)
    monkeypatch.setattr(form, "_beyond", lambda *_: 1.0)
    both = [SimpleNamespace(effect=effect) for effect in ("load", "stribeck")]
    assert of_other_form(cast("list[Finding]", both), fitted, REMAINS, 0).keys() == {"stribeck"}


def test_other_causes_are_not_judged_by_their_form(tmp_path: Path) -> None:
    found = sb.improve("coulomb", record(tmp_path, joint(0.5)), starts=2)
    findings = [step.finding for step in found.steps]
    assert [finding.effect for finding in findings] == ["offset"]
    assert of_other_form(findings, found.final, REMAINS, 0) == {}


@pytest.mark.parametrize(("share", "doubted"), [(0.3, True), (0.6, False)])
def test_the_form_is_not_in_doubt_where_the_measurement_explains_what_remains(
    share: float, doubted: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A filter of the torque acts where the speed is low, as a function of it does."""
    fitted = sb.fit("coulomb+stribeck", record(tmp_path, joint()), starts=1)
    monkeypatch.setattr(form, "_beyond", lambda *_: 1.0)
    monkeypatch.setattr(form, "explained_by_causes", lambda _: share)
    curve = [SimpleNamespace(effect="stribeck")]
    found = of_other_form(cast("list[Finding]", curve), fitted, REMAINS, 0)
    assert bool(found) == doubted


@pytest.mark.slow
def test_a_curve_behind_a_filter_of_the_torque_stays(tmp_path: Path) -> None:
    """Causes in the measurement explain most of what remains beside it."""
    behind = ("amplifier_warm_up", "current_filter")
    hidden = ("stribeck", "temperature_viscous")
    case = Case("two", "open_loop", hidden, 452155000, 2.0, nuisances=behind)
    case.make().frame.write_parquet(tmp_path / "recording.parquet")
    found = sb.improve("coulomb", sb.read(tmp_path / "recording.parquet"))
    assert found.unexplained.is_structure
    assert explained_by_causes(found.final) > form.MOST
    assert set(hidden) <= {step.finding.effect for step in found.steps}
