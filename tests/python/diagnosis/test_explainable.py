"""The black-box bound: what a regressor that knows no physics could do from the same channels."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.residual.explainable import explainable
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
    assert could.rmse == pytest.approx(fitted.rmse_held_out, rel=0.01)
    assert could.share > 0.999


def test_same_answer_every_time(with_load: sb.Recording) -> None:
    fitted = sb.fit("coulomb", with_load)
    assert explainable(fitted) == explainable(fitted)


def test_nothing_is_said_where_nothing_can_be_held_out(with_load: sb.Recording) -> None:
    fitted = sb.fit("coulomb", with_load)
    one_block = replace(with_load, block=np.zeros_like(with_load.block))
    assert explainable(replace(fitted, recording=one_block)) is None
