"""Models without one of their effects, which several tests of the last model of a path compare."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import stribeck as sb
from stribeck.diagnosis.diagnose import diagnose
from stribeck.diagnosis.loop import superfluous
from stribeck.diagnosis.loop.superfluous import fit_without
from synthetic import joint, motion, record


def test_a_model_without_an_effect_is_fitted_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    start = sb.fit("coulomb", record(tmp_path, joint(0.2 * motion()[3])), starts=1)
    finding = replace(diagnose(start, brief=True).findings[0], effect="inertia")
    current = sb.add(start, "inertia", starts=1)
    wider = sb.add(current, "direction", starts=1)
    finding = replace(finding, before=start, fit=current)
    alone = fit_without(current, finding, 0)
    assert alone is not None and alone.model.spec == start.model.spec

    monkeypatch.setattr(superfluous, "fit", pytest.fail)
    assert fit_without(current, finding, 0) is alone
    # Another model is another question.
    monkeypatch.undo()
    beside = fit_without(wider, finding, 0)
    assert beside is not None and beside.model.spec == "coulomb+direction"
