"""A study by an algorithm of nlopt."""

from __future__ import annotations

from pathlib import Path

import pytest
import stribeck as sb
from stribeck.scale.study.study import study
from synthetic import joint


def test_a_study_searches_by_the_algorithm(tmp_path: Path) -> None:
    path = tmp_path / "joint.parquet"
    joint(rows=2000).write_parquet(path)
    done = study(path, tmp_path / "s", ["dong"], starts=3, workers=1, algorithm="slsqp")
    fitted = sb.fit("dong", sb.read(path), starts=3, algorithm="slsqp")
    assert done.frame["rmse"].min() == pytest.approx(fitted.rmse, rel=1e-9)


def test_a_study_takes_no_algorithm_without_starts(tmp_path: Path) -> None:
    path = tmp_path / "joint.parquet"
    joint(rows=2000).write_parquet(path)
    with pytest.raises(sb.SpecError, match="a study searches from each start, crs2 does not"):
        study(path, tmp_path / "s", ["dong"], algorithm="crs2")
    assert not (tmp_path / "s").exists()
