"""The black-box bound: what a regressor that knows no physics could do from the same channels."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from made_fits import Array, Moved, left
from stribeck.diagnosis.residual import explainable as module
from stribeck.diagnosis.residual.explainable import FOLDS, ROWS, Explainable, explainable
from stribeck.motion.generate.hidden import generate


@pytest.fixture(scope="module")
def with_load(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint whose friction grows with the load."""
    frame, _ = generate(["load"], seed=3)
    path: Path = tmp_path_factory.mktemp("bound") / "load.parquet"
    frame.write_parquet(path)
    return sb.read(path)


def test_what_a_model_misses_the_regressor_finds(with_load: sb.Recording) -> None:
    fitted = sb.fit("coulomb", with_load)
    could = explainable(fitted)
    assert could is not None and fitted.rmse_held_out is not None
    assert could.rmse < 0.9 * fitted.rmse_held_out
    assert could.share < 0.99


def test_beside_the_true_model_it_finds_nothing(with_load: sb.Recording) -> None:
    fitted = sb.fit("coulomb+load", with_load)
    could = explainable(fitted)
    assert could is not None and fitted.rmse_held_out is not None
    # It may predict a little worse, as it has many more parameters.
    assert 0.99 * fitted.rmse_held_out < could.rmse < 1.02 * fitted.rmse_held_out
    assert could.share > 0.999


def test_same_answer_every_time(with_load: sb.Recording) -> None:
    fitted = sb.fit("coulomb", with_load)
    assert explainable(fitted) == explainable(fitted)


def test_nothing_is_said_where_nothing_can_be_held_out(with_load: sb.Recording) -> None:
    fitted = sb.fit("coulomb", with_load)
    one_block = replace(with_load, block=np.zeros_like(with_load.block))
    assert explainable(replace(fitted, recording=one_block)) is None


SIZE = 400
SIGNS = np.where(np.arange(SIZE) % 2, 1.0, -1.0)
BLOCKS = np.arange(SIZE) * 10 // SIZE


def learns(monkeypatch: pytest.MonkeyPatch, learned: Array) -> None:
    """Make the regressor predict this."""
    monkeypatch.setattr(module, "_held_out", lambda features, residual, block: learned)


def alternating(torque: float, missed: float) -> sb.Fit:
    """A torque of alternating sign, of which a part is missed in a pattern of its own."""
    pairs = np.where(np.arange(SIZE) // 2 % 2, 1.0, -1.0)
    recording = Moved(1.0 + np.arange(float(SIZE)), torque=torque * SIGNS, block=BLOCKS)
    return left(recording, missed * pairs)


def test_shares_follow_from_the_squared_errors(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a torque of variance 25, 9 are missed by one model, 4 by another, 1 by the regressor."""
    fitted, best = alternating(5.0, 3.0), alternating(5.0, 2.0)
    # Half of what is left is learned, and is not scaled up.
    learns(monkeypatch, 0.5 * best.held_out_residual)
    found = explainable(fitted, best)
    assert found is not None
    assert found.rmse == pytest.approx(1.0)
    assert found.left == pytest.approx(0.75)
    assert found.share == pytest.approx(1.0 - (9.0 - 1.0) / (25.0 - 1.0))
    assert found.to_dict() == {"rmse": found.rmse, "share": found.share}
    assert explainable(best) == Explainable(
        found.rmse, pytest.approx(1.0 - (4.0 - 1.0) / (25.0 - 1.0)), found.left
    )


def test_a_prediction_that_fails_is_scaled_down(monkeypatch: pytest.MonkeyPatch) -> None:
    best = alternating(5.0, 2.0)
    for factor, scale in ((2.0, 0.5), (-1.0, 0.0), (0.0, 0.0)):
        learns(monkeypatch, factor * best.held_out_residual)
        found = explainable(best)
        assert found is not None
        assert found.rmse == pytest.approx(2.0 * (1.0 - factor * scale), abs=1e-12)
        assert found.left == pytest.approx(1.0 - (1.0 - factor * scale) ** 2)


def test_where_the_torque_is_no_larger_than_the_error_nothing_is_said(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    learns(monkeypatch, np.zeros(SIZE))
    assert explainable(alternating(2.0, 2.0)) is None
    assert explainable(alternating(1.0, 2.0)) is None
    # A model that is worse than none explains no negative share.
    found = explainable(alternating(5.0, 9.0), alternating(5.0, 2.0))
    assert found is not None and found.share == 0.0
    perfect = explainable(alternating(5.0, 0.0))
    assert perfect is not None and (perfect.share, perfect.left) == (1.0, 0.0)


def test_a_block_is_predicted_by_the_others() -> None:
    """Where no feature tells anything, that is their mean."""
    residual = BLOCKS.astype(float)
    predicted = module._held_out(np.ones((SIZE, 1)), residual, BLOCKS)
    for fold in np.array_split(np.arange(10), FOLDS):
        others = np.setdiff1d(np.arange(10), fold)
        assert predicted[np.isin(BLOCKS, fold)] == pytest.approx(others.mean())


def test_of_a_long_recording_every_second_sample_is_learned(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seen = []
    size = ROWS + 2

    def counted(features: Array, residual: Array, block: Array) -> Array:
        seen.append(residual)
        return np.zeros_like(residual)

    monkeypatch.setattr(module, "_held_out", counted)
    for rows in (ROWS, size):
        torque = np.arange(float(rows))
        moved = Moved(1.0 + torque, torque=torque, block=np.arange(rows) * 10 // rows)
        explainable(left(moved, 1e-3 * torque))
    assert [residual.size for residual in seen] == [ROWS, size // 2]
    assert seen[1][1] == pytest.approx(2e-3)
