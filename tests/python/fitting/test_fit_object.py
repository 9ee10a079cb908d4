"""A fit as an object: it predicts, says what it found, and saves what it knows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.models.model_file import ModelFile
from synthetic import joint, record


@pytest.fixture(scope="module")
def fitted(plain: sb.Recording) -> sb.Fit:
    return sb.fit("coulomb", plain)


def test_it_predicts_another_recording(fitted: sb.Fit, tmp_path: Path) -> None:
    other = record(tmp_path, joint(rows=400, seed=5))
    there = fitted.predict(other)
    assert there.shape == other.time.shape
    assert there.tobytes() == sb.evaluate(fitted.model, other).prediction.tobytes()
    assert fitted.predict(fitted.recording) == pytest.approx(fitted.prediction)
    with pytest.raises(sb.RecordingError, match="is not a recording"):
        fitted.predict("joint.csv")  # type: ignore[arg-type]


def test_its_summary_is_the_text_of_the_command(fitted: sb.Fit) -> None:
    assert fitted.summary() == repr(fitted) and "coulomb fitted to" in fitted.summary()


def test_its_model_saves_errors_and_provenance(fitted: sb.Fit, tmp_path: Path) -> None:
    paths = [tmp_path / name for name in ("fit.toml", "model.toml", "again.toml")]
    fitted.save(paths[0])
    fitted.model.save(paths[1])
    sb.load(paths[1]).save(paths[2])
    texts = {path.read_text() for path in paths}
    assert texts == {ModelFile.of(fitted).to_toml()}
    stored = sb.read_model_file(paths[0])
    assert set(stored.stderr) == set(fitted.model.names)
    assert stored.fitted_on["sha256"] == fitted.recording.sha256


def test_a_changed_model_has_no_errors(fitted: sb.Fit, tmp_path: Path) -> None:
    changed = [
        fitted.model.with_values(2.0 * fitted.model.values),
        fitted.model.with_effect("offset", {}).with_values([1.0, 2.0, 3.0]),
    ]
    for model in changed:
        model.save(tmp_path / "m.toml")
        stored = sb.read_model_file(tmp_path / "m.toml")
        assert stored.stderr == {} and stored.fitted_on == {}


def test_a_model_that_is_only_evaluated_keeps_its_origin(fitted: sb.Fit, tmp_path: Path) -> None:
    other = record(tmp_path, joint(rows=400, seed=5))
    sb.evaluate(fitted.model, other)
    fitted.model.save(tmp_path / "m.toml")
    assert sb.read_model_file(tmp_path / "m.toml").fitted_on["rmse"] == fitted.rmse


def test_values_share_what_is_compiled(fitted: sb.Fit) -> None:
    assert fitted.model.with_values(np.ones(2)).core is fitted.model.core


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda fit, rec: sb.fit(rec, "coulomb"), "are `spec` and `recording` swapped"),
        (lambda fit, rec: sb.evaluate(rec, fit.model), "are `model` and `recording` swapped"),
        (lambda fit, rec: sb.diagnose(rec, fit), "are `fitted` and `recording` swapped"),
        (lambda fit, rec: sb.improve(rec, "coulomb"), "are `base` and `recording` swapped"),
        (lambda fit, rec: sb.export("c", fit.model, "x"), "are `model` and `to` swapped"),
        (lambda fit, rec: sb.add("load", fit, rec), "are `fitted` and `effect` swapped"),
        (lambda fit, rec: sb.fleet("out", ["a.csv"]), "give a list of paths"),
        (lambda fit, rec: sb.measure_transmission(fit), "give a recording"),
        (lambda fit, rec: sb.found_protocols(fit), "give a recording"),
        (lambda fit, rec: sb.check(rec), "give a model"),
    ],
)
def test_wrong_arguments_are_named(
    call: object, said: str, fitted: sb.Fit, plain: sb.Recording
) -> None:
    with pytest.raises(sb.StribeckError, match=said):
        call(fitted, plain)  # type: ignore[operator]
