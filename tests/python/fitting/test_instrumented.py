"""Instrumental variables: true intervals where the noise of the encoder biases least squares."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from closed_loop import TRUE, closed_loop
from stribeck.base.errors import FitError, SpecError

MODEL, FIXED = "coulomb+stribeck", {"stribeck_exponent": 2.0}


def recording(frame: pl.DataFrame, folder: Path) -> sb.Recording:
    path = folder / "joint.parquet"
    frame.write_parquet(path)
    return sb.read(path, joint_kind="revolute")


def words(fitted: sb.Fit) -> str:
    return " ".join(repr(fitted).split())


def covered(fitted: sb.Fit) -> list[bool]:
    """Whether the 95 % interval of each parameter holds its true value."""
    intervals = {name: fitted.estimates[name].ci95 for name in TRUE}
    return [
        interval is not None and interval[0] <= TRUE[name] <= interval[1]
        for name, interval in intervals.items()
    ]


@pytest.fixture(scope="module")
def noisy(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    return recording(closed_loop([3], seconds=20.0)[0], tmp_path_factory.mktemp("noisy"))


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    frame = closed_loop([3], noisy=False, seconds=20.0)[0]
    return recording(frame, tmp_path_factory.mktemp("clean"))


def test_instruments_remove_the_bias_of_least_squares(noisy: sb.Recording) -> None:
    squares = sb.fit(MODEL, noisy, fix=FIXED)
    instrumental = sb.fit(MODEL, noisy, fix=FIXED, estimator="iv")
    assert (squares.estimator, instrumental.estimator) == ("ls", "iv")
    assert squares.model.value("inertia") < 0.2 * TRUE["inertia"]
    for name, true in TRUE.items():
        estimate = instrumental.estimates[name]
        assert estimate.stderr is not None
        assert abs(estimate.value - true) < 4.0 * estimate.stderr
    test = squares.exogeneity
    assert test is not None and test.biased
    assert instrumental.exogeneity is not None
    assert instrumental.exogeneity.statistic == test.statistic
    expected = squares.model.value("inertia") - instrumental.model.value("inertia")
    assert instrumental.exogeneity.bias["inertia"] == pytest.approx(expected)
    # To first order; the model is linear in the inertia.
    assert test.bias["inertia"] == pytest.approx(expected, rel=0.05)
    assert "its inertia is about 0.4" in words(squares)
    assert "use the estimator iv" in words(squares)
    assert "use the estimator iv" not in words(instrumental)
    assert squares.to_dict()["exogeneity"] == test.to_dict()


def test_on_exact_motion_both_agree(clean: sb.Recording) -> None:
    squares = sb.fit(MODEL, clean, fix=FIXED)
    instrumental = sb.fit(MODEL, clean, fix=FIXED, estimator="iv")
    assert squares.exogeneity is not None and not squares.exogeneity.biased
    assert "No bias of least squares" in words(squares)
    for name in TRUE:
        one, other = squares.estimates[name], instrumental.estimates[name]
        assert one.stderr is not None
        assert abs(one.value - other.value) < one.stderr
    assert instrumental.rmse == pytest.approx(squares.rmse, rel=0.01)
    assert instrumental.rmse_held_out == pytest.approx(squares.rmse_held_out, rel=0.01)


def test_bounds_and_fixed_values_hold(noisy: sb.Recording) -> None:
    """The inertia would exceed its bound."""
    fitted = sb.fit(MODEL, noisy, fix=FIXED, bounds={"inertia": (0.0, 0.3)}, estimator="iv")
    assert fitted.model.value("inertia") == 0.3
    assert fitted.estimates["inertia"].at_bound
    assert fitted.model.value("stribeck_exponent") == 2.0


def test_a_load_that_friction_reads_is_identified_with_it(clean: sb.Recording) -> None:
    fitted = sb.fit("coulomb+load", clean, fix={"load_exponent": 1.0}, estimator="iv")
    squares = sb.fit("coulomb+load", clean, fix={"load_exponent": 1.0})
    assert fitted.load is not None
    assert fitted.model.value("inertia") == pytest.approx(squares.model.value("inertia"), rel=0.05)


def test_a_model_with_a_state(clean: sb.Recording) -> None:
    """Its state evolves along the reference too."""
    fitted = sb.fit("coulomb+presliding", clean, starts=2, estimator="iv")
    assert fitted.model.value("inertia") == pytest.approx(TRUE["inertia"], rel=0.1)


def test_no_reference_is_refused(noisy: sb.Recording) -> None:
    without = replace(noisy, reference_velocity=None)
    assert sb.fit("coulomb", without).exogeneity is None
    with pytest.raises(FitError, match=r"no reference trajectory.*reference_position=COLUMN"):
        sb.fit("coulomb", without, estimator="iv")


def test_a_reference_of_another_motion_is_refused(noisy: sb.Recording) -> None:
    assert noisy.reference_velocity is not None
    other = replace(noisy, reference_velocity=noisy.reference_velocity[::-1] * 100.0)
    assert sb.fit("coulomb", other).exogeneity is None
    with pytest.raises(FitError, match="does not follow its reference"):
        sb.fit("coulomb", other, estimator="iv")


def test_a_law_that_is_not_finite_along_the_reference_is_refused(noisy: sb.Recording) -> None:
    assert noisy.reference_position is not None
    shifted = replace(noisy, reference_position=noisy.reference_position - 10.0)
    law = sb.law("c1*v + c2*sgn(v) + c3*sqrt(q + 3)")
    assert sb.fit(law, shifted).exogeneity is None
    with pytest.raises(FitError, match=r"along the reference trajectory .* is not finite"):
        sb.fit(law, shifted, estimator="iv")


def test_options_that_exclude_each_other(noisy: sb.Recording) -> None:
    with pytest.raises(SpecError, match="estimator"):
        sb.fit("coulomb", noisy, estimator="gmm")  # type: ignore[arg-type]
    with pytest.raises(SpecError, match="passivity"):
        sb.fit("coulomb", noisy, estimator="iv", passive=True)


@pytest.mark.long
def test_intervals_cover_the_true_values(tmp_path: Path) -> None:
    """200 recordings under feedback from a noisy encoder; least squares on the first 50."""
    squares, instrumental, found = [], [], []
    for first in range(0, 200, 50):
        for frame in closed_loop(range(first, first + 50)):
            made = recording(frame, tmp_path)
            if first == 0:
                squares.append(covered(sb.fit(MODEL, made, starts=4, fix=FIXED)))
            fitted = sb.fit(MODEL, made, starts=4, fix=FIXED, estimator="iv")
            instrumental.append(covered(fitted))
            found.append(fitted.exogeneity is not None and fitted.exogeneity.biased)
    by_name = dict(zip(TRUE, np.mean(instrumental, axis=0), strict=True))
    print("instrumental variables:", by_name)
    print("least squares:", dict(zip(TRUE, np.mean(squares, axis=0), strict=True)))
    print("found biased:", np.mean(found))
    assert all(0.90 <= share <= 0.98 for share in by_name.values()), by_name
    assert np.mean(squares, axis=0).min() < 0.05
    assert np.mean(found) >= 0.95


@pytest.mark.long
def test_exact_motion_is_seldom_called_biased(tmp_path: Path) -> None:
    """The test keeps its level: at most 7 % of 200 recordings below p = 0.05."""
    p = []
    for first in range(0, 200, 50):
        for frame in closed_loop(range(first, first + 50), noisy=False):
            test = sb.fit(MODEL, recording(frame, tmp_path), starts=4, fix=FIXED).exogeneity
            assert test is not None
            p.append(test.p)
    print("below 0.05:", np.mean(np.array(p) < 0.05), "below 0.01:", np.mean(np.array(p) < 0.01))
    assert np.mean(np.array(p) < 0.05) <= 0.07
    assert np.mean(np.array(p) < 0.01) <= 0.03
