"""A diagnosis names the cause, its like, and what it cannot see."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.effect.describe import base_of
from stribeck.effect.registry import of_catalog
from stribeck.effect.ripple import ripple_period_of
from stribeck.models.catalog import effect_ids
from synthetic import joint, motion, record


@pytest.fixture(scope="module")
def loaded(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """Dry friction that grows with the load: 5 % of it, at any speed."""
    load, v = joint()["load_torque"].to_numpy(), motion()[2]
    frame = joint(0.05 * np.abs(load) * np.sign(v))
    return record(tmp_path_factory.mktemp("loaded"), frame.drop("temperature"))


@pytest.fixture(scope="module")
def diagnosis(loaded: sb.Recording) -> sb.Diagnosis:
    """What Coulomb and viscous friction miss on it."""
    return sb.diagnose(sb.fit("coulomb", loaded))


def test_load_is_found(diagnosis: sb.Diagnosis) -> None:
    assert diagnosis.verdict == "missing"
    first = diagnosis.findings[0]
    assert first.effect == "load" and first.indistinguishable_from == ()
    assert first.confidence > 0.9
    assert first.rmse_held_out_after == pytest.approx(0.03, rel=0.05)
    assert first.fit.model.value("load_coulomb") == pytest.approx(0.05, rel=0.1)
    assert "N m" in first.where and "load" in first.where
    before, after = first.rmse_held_out_before, first.rmse_held_out_after
    assert diagnosis.noise_floor.value is not None
    share = (before**2 - after**2) / (before**2 - diagnosis.noise_floor.value**2)
    assert first.share_of_unexplained == pytest.approx(min(share, 1.0))


def test_contract_keys(diagnosis: sb.Diagnosis) -> None:
    answer = json.loads(json.dumps(diagnosis.to_dict()))
    assert {
        "model",
        "rmse",
        "rmse_held_out",
        "noise_floor",
        "verdict",
        "findings",
        "untestable",
        "unexplained",
        "scored",
    } <= set(answer)
    assert answer["verdict"] in ("missing", "none", "unexplained")
    for row in answer["findings"]:
        assert {
            "effect",
            "confidence",
            "rmse_held_out_before",
            "rmse_held_out_after",
            "share_of_unexplained",
            "where",
            "indistinguishable_from",
        } <= set(row)
        assert 0.0 <= row["confidence"] <= 1.0 and 0.0 <= row["share_of_unexplained"] <= 1.0
        assert row["effect"] in effect_ids() and row["where"]
    unseen = {row["effect"] for row in answer["untestable"]}
    assert unseen == {"temperature_viscous", "temperature_dry", "thermometer_lag"}
    for row in answer["untestable"]:
        assert {"effect", "why", "do"} <= set(row)
    assert set(answer["unexplained"]) == {"share", "where"}


def test_nothing_is_missing_where_nothing_is(plain: sb.Recording) -> None:
    answer = sb.diagnose(sb.fit("coulomb", plain)).to_dict()
    assert answer["verdict"] == "none" and answer["findings"] == []


def test_an_effect_that_is_in_the_model_is_not_found_again(loaded: sb.Recording) -> None:
    answer = sb.diagnose(sb.fit("coulomb+load", loaded))
    assert answer.verdict == "none" and answer.findings == ()


def test_rejected_effects_are_not_tried(loaded: sb.Recording) -> None:
    found = sb.diagnose(sb.fit("coulomb", loaded), rejected=("load",))
    assert "load" not in [f.effect for f in found.findings]


@pytest.mark.parametrize("sample_rows", [1_000_000, 1000])
def test_findings_are_known_before_the_rest(loaded: sb.Recording, sample_rows: int) -> None:
    told: list[sb.Diagnosis] = []
    fitted = sb.fit("coulomb", loaded, starts=2)
    found = sb.diagnose(fitted, sample_rows=sample_rows, known=told.append)
    (first,) = told
    assert first.findings
    # What remains may limit their confidence, and is asked last.
    again = tuple(replace(finding, part=1.0) for finding in found.findings)
    assert again == first.findings
    assert first.explainable is None and found.explainable is not None
    brief = sb.diagnose(fitted, sample_rows=sample_rows, brief=True)
    assert brief.to_dict() == first.to_dict()
    assert "cannot be estimated" not in str(brief) and "remains" in str(found)


def test_another_recording_is_fitted_first(loaded: sb.Recording, plain: sb.Recording) -> None:
    fit = sb.fit("coulomb", loaded)
    assert sb.diagnose(fit, plain).verdict == "none"


def test_the_simplest_of_those_that_explain_the_same_comes_first(tmp_path: Path) -> None:
    """An offset is also a Coulomb force that differs by direction, or nearly a weight."""
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, joint(0.08)))).findings[0]
    assert found.effect == "offset"
    assert set(found.indistinguishable_from) <= {"direction", "gravity"}


def test_structure_that_no_effect_explains_is_called_unexplained(tmp_path: Path) -> None:
    """Two waves along the stroke that share no period, one of which is left."""
    q = motion()[1]
    recording = record(tmp_path, joint(0.6 * np.sin(14.0 * q) + 0.6 * np.sin(32.3 * q)))
    found = sb.diagnose(sb.fit("coulomb+ripple", recording))
    assert found.unexplained.is_structure or found.verdict == "missing"
    if not found.findings:
        assert found.verdict == "unexplained" and found.unexplained.share > 0.15


@pytest.mark.parametrize("effect", ["ripple", "spring", "gain", "drift", "saturation"])
def test_further_causes_are_found_and_said_not_to_be_friction(effect: str, tmp_path: Path) -> None:
    """Forms of their own: a narrow wave, a slack rope, a wrong constant, run-in, dull iron."""
    frame, (_, q, v, _) = joint(), motion()
    torque = frame["torque"].to_numpy()
    t = frame["time"].to_numpy()
    shown = {
        "ripple": torque + 0.2 * np.tanh(1.5 * np.sin(31.0 * q)),
        "spring": torque + 0.4 * np.maximum(q - 0.2, 0.0) - 0.1,
        "gain": torque / 0.97,
        "drift": torque - np.sign(v) * t / (t + 8.0),
        "saturation": 40.0 * np.arctanh(torque / 40.0),
    }[effect]
    recording = record(tmp_path, frame.with_columns(torque=pl.Series(shown)))
    first = sb.diagnose(sb.fit("coulomb", recording)).findings[0]
    assert first.effect == effect
    assert first.where.startswith("this is not friction: ") == (effect != "drift")


def test_the_period_of_a_ripple_is_found(tmp_path: Path) -> None:
    recording = record(tmp_path, joint(0.1 * np.sin(31.0 * motion()[1])))
    fit = sb.fit("coulomb+ripple", recording, starts=3)
    assert ripple_period_of(fit.model) == pytest.approx(2.0 * np.pi / 31.0, rel=1e-3)


@pytest.mark.parametrize("effect", effect_ids())
def test_sentences_hold_numbers_and_units(effect: str, plain: sb.Recording) -> None:
    before = sb.fit("+".join(["coulomb", *base_of(effect)]), plain)
    after = sb.add(before, effect, starts=1)
    sentence = of_catalog(effect).where(before, after)
    assert any(c.isdigit() for c in sentence) and "nan" not in sentence and "None" not in sentence
    assert sentence == sentence.strip() and not sentence.endswith(".")
