"""One law and one effect of the catalog, as text and as a figure."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from stribeck.base.errors import StribeckError
from stribeck.cli.main import cli
from stribeck.models.catalog import effect_ids, law_ids
from stribeck.report.effect_example import effect_example
from stribeck.report.law_curve import law_curve
from stribeck.report.layout import WIDTH
from stribeck.report.text_plot import text_plot


def said(*words: str) -> str:
    done = CliRunner().invoke(cli, words, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return done.stdout


@pytest.mark.parametrize("law", law_ids())
def test_every_law_has_a_curve_that_opposes_motion(law: str) -> None:
    curve = law_curve(law)
    fast = np.abs(curve.velocity) > 0.5 * np.abs(curve.velocity).max()
    for _, friction in curve.curves:
        assert np.isfinite(friction).all()
        assert (friction[fast] * curve.velocity[fast] > 0.0).all()


@pytest.mark.parametrize("effect", effect_ids())
def test_every_effect_has_an_example_that_shows_it(effect: str) -> None:
    example = effect_example(effect)
    assert example.without.rmse > 2.0 * example.with_it.rmse
    without = example.view.without
    assert without.at.size > 5 and np.isfinite(without.median).all()


def test_one_law_and_one_effect_as_text() -> None:
    law = said("models", "lugre")
    for words in (
        "Canudas de Wit",
        "presliding",
        "bristle_stiffness",
        "N m/rad",
        "velocity [rad/s]",
    ):
        assert words in law
    effect = said("effects", "load")
    for words in ("load_coulomb", "load magnitude [N m]", "stribeck add DATA MODEL load"):
        assert words in effect
    assert max(map(len, (law + effect).splitlines())) <= WIDTH
    assert "• 20 °C" not in said("models", "simoni"), "a curve for each of two equal conditions"


def test_json_is_the_row_of_the_list() -> None:
    rows = json.loads(said("models", "--json"))["models"]
    assert json.loads(said("models", "dahl", "--json")) in rows
    rows = json.loads(said("effects", "--json"))["effects"]
    assert json.loads(said("effects", "ripple", "--json")) in rows


def test_curves_as_figures(tmp_path: Path) -> None:
    said("models", "bittencourt_b", "-o", str(tmp_path / "law.svg"))
    said("effects", "temperature_dry", "-o", str(tmp_path / "effect.svg"))
    assert "<svg" in (tmp_path / "law.svg").read_text()
    assert "<svg" in (tmp_path / "effect.svg").read_text()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["models", "load"], "'load' is an effect: `stribeck effects load` shows it"),
        (["effects", "lugre"], "'lugre' is a law: `stribeck models lugre` shows it"),
        (["models", "lugree"], "did you mean 'lugre'"),
        (["models", "coulomb+load"], "give one law"),
        (["models", "-o", "x.svg"], "name it, as in"),
    ],
)
def test_refusals(words: list[str], sentence: str) -> None:
    with pytest.raises(StribeckError, match=sentence):
        CliRunner().invoke(cli, words, catch_exceptions=False)


def test_a_plot_of_text_places_its_marks() -> None:
    x = np.array([1.0, 10.0, 100.0])
    lines = text_plot([(x, x), (x, -x)], "speed", "torque", log=True).splitlines()
    assert lines[0] == "  torque" and "100" in lines[1] and lines[1].endswith("•")
    assert lines[-3].endswith("+") and lines[-1].split() == ["1.00", "speed", "100"]
    assert text_plot([(x, x * np.nan)], "x", "y") == ""
