"""Every row of `calls.py`: one of our errors, in one line, with no file touched."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest
import stribeck as sb

from hostile.calls import Kit, calls
from hostile.contract import check_sentence, nothing_written


def test_rows(workspace: Path) -> None:
    wrong: list[str] = []
    number = 0
    for name, call in calls(Kit(workspace)):
        number += 1
        try:
            with nothing_written(workspace), warnings.catch_warnings():
                warnings.simplefilter("error")
                result = call()
            wrong.append(f"{name}: accepted, {type(result).__name__}")
        except sb.StribeckError as error:
            try:
                check_sentence(str(error))
            except AssertionError as failure:
                wrong.append(f"{name}: {failure}"[:200])
        except Exception as error:
            wrong.append(f"{name}: {type(error).__name__}: {error}"[:200])
    assert wrong == [], "\n".join(wrong)
    assert number >= 300


def test_a_model_cannot_be_written_to(workspace: Path) -> None:
    kit = Kit(workspace)
    for model in (kit.model, kit.fit.model):
        before = model.values.copy()
        with pytest.raises(ValueError, match="read-only"):
            model.values[0] = 5.0
        assert (model.values == before).all()
