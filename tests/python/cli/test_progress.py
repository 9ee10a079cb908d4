"""Progress: a bar on a terminal, a line now and then in a file."""

from __future__ import annotations

import pytest
from stribeck.cli import progress
from stribeck.cli.progress import Progress


def test_a_file_gets_a_line_now_and_then_with_the_time_left(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pieces of 15 s, lines at least 20 s apart; the first piece gives no estimate."""
    now = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    with Progress() as bar:
        for done in range(2, 11):
            now[0] = 30.0 + 15.0 * (done - 2)
            bar.show(done, 10)
    assert capsys.readouterr().err.splitlines() == [
        "note: 2 of 10 fits",
        "note: 4 of 10 fits, about 2 min left",
        "note: 6 of 10 fits, about 60 s left",
        "note: 8 of 10 fits, about 30 s left",
    ]
