"""The command on recordings with a hidden effect.

It names the cause, adds nothing else, and stops at the noise.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "hidden"))

import cases as hidden

#: Cases in which the effect is named but the error does not reach the noise, and why.
SHORT = {
    "temperature_dry-3-1501": "the curve over temperature bends twice, the fitted one once (1.051)",
    "drift+temperature_dry-4113": "the first tenth, where drift is fast, is extrapolated (1.36)",
    "presliding+load-4109": "the bristle is one, the contact has many (1.15)",
}


def _marks(case: hidden.Case) -> list:
    marks = [] if case.quick else [pytest.mark.slow]
    if case.name in SHORT:
        # Strict: a case that comes right must leave this list.
        marks.append(pytest.mark.xfail(reason=SHORT[case.name], strict=True))
    return marks


def _parameters() -> list:
    return [pytest.param(case, id=case.name, marks=_marks(case)) for case in hidden.cases()]


@pytest.mark.parametrize("case", _parameters())
def test_improve_names_what_is_hidden(case: hidden.Case, tmp_path: Path) -> None:
    """Effects found, untestable ones listed, and the final error, all against the truth."""
    frame, truth = case.make()
    path = tmp_path / "recording.parquet"
    frame.write_parquet(path)
    command = [sys.executable, "-m", "stribeck", "improve", str(path), "--base", "coulomb"]
    run = subprocess.run(
        [*command, "--json"], capture_output=True, text=True, timeout=600, cwd=tmp_path
    )
    assert run.returncode == 0, run.stderr
    answer = json.loads(run.stdout)
    verdict = hidden.judge(truth, answer)
    if truth["hidden"] == ["none"]:
        assert answer["steps"] == []
    assert not verdict.problems, (verdict.problems, truth)
