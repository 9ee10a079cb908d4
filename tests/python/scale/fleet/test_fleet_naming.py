"""Robot, day and joint from a path."""

from __future__ import annotations

from datetime import date

import pytest
from stribeck.base.errors import RecordingError, SpecError
from stribeck.scale.fleet.naming import Name, Naming

DAY = date(2026, 3, 9)


@pytest.mark.parametrize(
    ("pattern", "path", "name"),
    [
        (None, "/logs/cell_7/2026-03-09.parquet", Name("cell_7", DAY)),
        (None, "/logs/2025-01-01/r1/log_20260309_a.csv", Name("r1", DAY)),
        (None, "/logs/r1/monday.csv", Name("r1", None)),
        (None, "/logs/r1/2026-13-45.csv", Name("r1", None)),
        ("{robot}/{day}.parquet", "/a/b/r1/2026.03.09.parquet", Name("r1", DAY)),
        ("{robot}/{joint}/*_{day}.csv", "/r1/J2/x_y_2026_03_09.csv", Name("r1", DAY, "J2")),
        ("{robot}-{joint}.csv", "/logs/ur-1.csv", Name("ur", None, "1")),
        ("{robot}.csv", "/logs/a+b(1).csv", Name("a+b(1)", None)),
    ],
)
def test_what_a_path_says(pattern: str | None, path: str, name: Name) -> None:
    assert Naming(pattern).name(path) == name


@pytest.mark.parametrize(
    ("pattern", "sentence"),
    [
        ("{robo}/{day}.csv", "did you mean 'robot'"),
        ("{robot}/{robot}.csv", "twice"),
        ("{robot/{day}.csv", "is unknown"),
    ],
)
def test_a_wrong_pattern_is_refused(pattern: str, sentence: str) -> None:
    with pytest.raises(SpecError, match=sentence):
        Naming(pattern)


def test_a_path_that_says_something_else_is_refused() -> None:
    with pytest.raises(RecordingError, match="does not match"):
        Naming("{robot}/{day}.csv").name("/r1/monday.csv")
    with pytest.raises(RecordingError, match="does not match"):
        Naming("{robot}/{day}.parquet").name("/r1/2026-03-09.csv")
    with pytest.raises(RecordingError, match="its day 2026-13-45 is not in the calendar"):
        Naming("{robot}/{day}.csv").name("/r1/2026-13-45.csv")
