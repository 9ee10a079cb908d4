"""Every row of `unread.py`: one line that names what reads the option, code 2, no file touched."""

from __future__ import annotations

from pathlib import Path

import pytest

from hostile import unread
from hostile.contract import check_refused, nothing_written, run


@pytest.mark.parametrize(("words", "said"), unread.ROWS, ids=[row[0] for row in unread.ROWS])
def test_row(workspace: Path, words: str, said: str) -> None:
    with nothing_written(workspace):
        check_refused(run(words.split()), said)
