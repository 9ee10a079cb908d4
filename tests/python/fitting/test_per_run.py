"""Parameters with a value of their own in each run."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from click.testing import CliRunner
from stribeck.cli.main import cli
from stribeck.report.numbers import MINUS
from synthetic import COULOMB, VISCOUS, joint, motion

OFFSETS = (-0.8, 0.1, 0.6)


def runs(offsets: tuple[float, ...] = OFFSETS, rows: int = 1200) -> list[sb.Recording]:
    """One joint whose torque sensor has another zero in each run."""
    return [
        sb.read(joint(extra=offset, rows=rows, seed=k, noise=0.05), moving_above=1e-3)
        for k, offset in enumerate(offsets)
    ]


def test_the_offsets_of_the_runs_are_recovered() -> None:
    fitted = sb.fit("coulomb+offset", runs(), per_run="offset")
    for found, truth in zip(fitted.per_run["offset"].values(), OFFSETS, strict=True):
        assert found.stderr is not None and 0.0005 < found.stderr < 0.005
        assert abs(found.value - truth) < 4.0 * found.stderr
    assert fitted.model.value("coulomb_friction") == pytest.approx(COULOMB, abs=0.01)
    assert fitted.model.value("viscous_friction") == pytest.approx(VISCOUS, abs=0.01)
    assert fitted.model.value("offset") == pytest.approx(np.mean(OFFSETS), abs=0.01)
    assert fitted.rmse == pytest.approx(0.05, rel=0.03)
    shared = sb.fit("coulomb+offset", runs())
    assert fitted.rmse < 0.15 * shared.rmse and shared.per_run == {}


def test_with_all_parameters_each_run_is_fitted_alone() -> None:
    """Factors of all runs together against a fit of each."""
    each = runs()
    together = sb.fit("coulomb+stribeck", each, per_run=list(sb.model("coulomb+stribeck").names))
    for k, alone in enumerate(each):
        one = sb.fit("coulomb", alone)
        own = together.residual[together.recording.run == k]
        # The wider model is at least as good on every run, and no better than the noise.
        assert np.sqrt(np.mean(own**2)) <= one.rmse * (1.0 + 1e-9)
    linear = sb.fit("coulomb", each, per_run=["a1", "a2"])
    for k, alone in enumerate(each):
        one = sb.fit("coulomb", alone)
        for name, of_runs in linear.per_run.items():
            assert list(of_runs.values())[k].value == pytest.approx(one.model.value(name), rel=1e-9)


@pytest.mark.slow
def test_errors_are_those_of_repeated_measurements() -> None:
    """The scatter of the offsets found over 30 draws of the noise is their standard error."""
    found = []
    for draw in range(30):
        each = [
            sb.read(joint(extra=offset, rows=600, seed=100 * draw + k), moving_above=1e-3)
            for k, offset in enumerate(OFFSETS)
        ]
        of_runs = sb.fit("coulomb+offset", each, per_run="offset").per_run["offset"].values()
        found.append([(e.value, e.stderr) for e in of_runs])
    values, errors = np.array(found).transpose(2, 0, 1)
    assert np.std(values, axis=0, ddof=1) == pytest.approx(errors.mean(axis=0), rel=0.45)


def test_a_run_held_out_as_a_whole_has_the_mean_of_the_others() -> None:
    offsets = (-1.0, -0.5, 0.0, 0.5, 1.0)
    fitted = sb.fit("coulomb+offset", runs(offsets, rows=600), per_run="offset")
    assert fitted.recording.block_count == 5
    expected = [offset - (sum(offsets) - offset) / 4.0 for offset in offsets]
    errors = [
        fitted.held_out_residual[fitted.recording.run == k].mean() for k in range(len(offsets))
    ]
    assert errors == pytest.approx(expected, abs=0.02)
    assert any("held-out runs are predicted" in note for note in fitted.notes)


def test_a_law_with_a_state() -> None:
    """The offsets of the runs cost nothing: the error is that of the same joint without them."""
    own = sb.fit("lugre+offset", runs(), starts=2, per_run="offset")
    without = sb.fit("lugre+offset", runs((0.0, 0.0, 0.0)), starts=2)
    assert own.rmse == pytest.approx(without.rmse, rel=1e-3)
    found = [e.value for e in own.per_run["offset"].values()]
    assert found == pytest.approx(OFFSETS, abs=0.02)


@pytest.mark.slow
def test_shared_values_far_from_the_solution_do_not_matter() -> None:
    """From the values that all runs share, this search ends at twice the error.

    Minima of this law are found to a thousandth.
    """
    v = motion(1200)[2]
    stribeck = 1.5 * np.sign(v) * np.exp(-((v / 0.1) ** 2))

    def error(size: float) -> float:
        each = [
            sb.read(joint(stribeck + size * offset, rows=1200, seed=k), moving_above=1e-3)
            for k, offset in enumerate(OFFSETS)
        ]
        return sb.fit("tadese_t+offset", each, starts=5, per_run="offset").rmse

    assert error(5.0) == pytest.approx(error(0.5), rel=1e-3)


def test_text_json_and_model_file(tmp_path: Path) -> None:
    for k, offset in enumerate(OFFSETS):
        joint(extra=offset, rows=800, seed=k).write_csv(tmp_path / f"day {k}.csv")
    target = tmp_path / "m.toml"
    words = ["fit", str(tmp_path), "--model", "coulomb+offset", "--per-run", "t0"]
    said = CliRunner().invoke(cli, [*words, "--json", "-o", str(target)])
    assert said.exit_code == 0, said.output
    values = json.loads(said.stdout)["per_run"]["offset"]
    assert list(values) == ["day 0", "day 1", "day 2"]
    for run, truth in zip(values.values(), OFFSETS, strict=True):
        assert run["value"] == pytest.approx(truth, abs=0.02) and run["stderr"] > 0.0
        assert run["ci95"][0] < run["value"] < run["ci95"][1] and run["unit"] == "N m"
    text = CliRunner().invoke(cli, words).stdout
    assert "Values of each run; offset above: the mean." in text
    assert f"day 0  {MINUS}0.80" in text
    stored = sb.read_model_file(target)
    assert stored.per_run["offset"]["day 1"] == (
        values["day 1"]["value"],
        values["day 1"]["stderr"],
    )
    assert stored.to_toml() == target.read_text(encoding="utf-8")
    wrong = target.read_text(encoding="utf-8").replace('"day 1" = {value', '"day 1" = {valeu')
    target.write_text(wrong, encoding="utf-8")
    with pytest.raises(sb.ModelFileError, match="run 'day 1'"):
        sb.read_model_file(target)


def test_what_needs_one_value_is_refused() -> None:
    each = runs(rows=400)
    for options, said in (
        ({"per_run": "ofset"}, "did you mean 'offset'"),
        ({"per_run": 3}, "`per_run` is 3: give the name"),
        ({"per_run": [3]}, "give the name of a parameter"),
        ({"per_run": "offset", "fix": {"offset": 0.1}}, "offset is held"),
        ({"per_run": "offset", "prior": {"offset": (0.0, 1.0)}}, "does not take .*prior"),
        ({"per_run": "offset", "passive": True}, "passive=.*|passive.* one value"),
        ({"per_run": "offset", "errors": "profile"}, "profile.* one value of each parameter"),
    ):
        with pytest.raises(sb.SpecError, match=said):
            sb.fit("coulomb+offset", each, **options)
    with pytest.raises(sb.FitError, match="needs several runs, there is one"):
        sb.fit("coulomb+offset", each[0], per_run="offset")
    fitted = sb.fit("coulomb+offset", each, per_run="offset")
    with pytest.raises(sb.FitError, match="fit without"):
        sb.diagnose(fitted)
    still = joint(rows=400).with_columns(
        pl.lit(0.0).alias("velocity"), pl.lit(0.1).alias("position")
    )
    resting = sb.read(still, standstill=True, moving_above=1e-3, trust=True)
    with pytest.raises(sb.FitError, match="run '3' has 0 moving samples"):
        sb.fit("coulomb+offset", sb.concat([*each[:2], resting]), per_run="offset")
