"""Every row of `files.py`: one line, code 2, no file touched."""

from __future__ import annotations

from pathlib import Path

from hostile.contract import check_refused, nothing_written, run
from hostile.files import READ_BY, changes


def test_rows(workspace: Path) -> None:
    wrong: list[str] = []
    number = 0
    for row, name, content in changes(workspace):
        number += 1
        path = workspace / name
        good = path.read_bytes()
        path.write_bytes(content)
        try:
            with nothing_written(workspace):
                check_refused(run(READ_BY[name]))
        except AssertionError as failure:
            wrong.append(f"{row}: {failure}"[:300])
        finally:
            path.write_bytes(good)
    assert wrong == [], "\n".join(wrong)
    assert number >= 200
