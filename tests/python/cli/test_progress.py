"""Progress: a bar for who watches, a line now and then for a file."""

from __future__ import annotations

import pytest
from stribeck.cli import progress
from stribeck.cli.progress import Progress


def test_a_file_gets_a_line_now_and_then_with_the_time_left(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pieces of 15 s, lines at least 20 s apart; nothing is guessed from the first piece."""
    clock = iter([0.0, 30.0, *(30.0 + 15.0 * k for k in range(1, 9))])
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(clock))
    with Progress() as bar:
        for done in range(2, 11):
            bar.show(done, 10)
    assert capsys.readouterr().err.splitlines() == [
        "note: 2 of 10 fits",
        "note: 4 of 10 fits, about 2 min left",
        "note: 6 of 10 fits, about 60 s left",
        "note: 8 of 10 fits, about 30 s left",
    ]
