"""Every row of `flags.py`: one line, code 2, no file touched."""

from __future__ import annotations

from pathlib import Path

import pytest

from hostile import flags
from hostile.contract import check_refused, nothing_written, run

ROWS = [*flags.numbers(), *flags.outputs(), *flags.texts(), *flags.OTHER]


def _name(words: flags.Row) -> str:
    return " ".join(words)[:60].encode("unicode_escape").decode()


@pytest.mark.parametrize("words", ROWS, ids=_name)
def test_row(workspace: Path, words: flags.Row) -> None:
    with nothing_written(workspace):
        check_refused(run(words))


def test_there_are_many_rows() -> None:
    assert len(ROWS) >= 400
