"""Files are written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from stribeck.base.errors import ModelFileError, StribeckError
from stribeck.base.files import write_bytes_whole, write_whole


def test_text_and_bytes_replace_a_file(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    write_whole(path, "first\n")
    write_whole(str(path), "zwölf\n")
    assert path.read_text(encoding="utf-8") == "zwölf\n"
    write_bytes_whole(path, b"\x00\xff")
    assert path.read_bytes() == b"\x00\xff"
    assert path.stat().st_mode & 0o777 == 0o644
    assert os.listdir(tmp_path) == ["a.txt"]


@pytest.mark.parametrize("error", [StribeckError, ModelFileError])
def test_what_cannot_be_written_raises_the_error_asked_for(
    tmp_path: Path, error: type[StribeckError]
) -> None:
    (tmp_path / "folder").mkdir()
    for path in (tmp_path / "nowhere" / "a.txt", tmp_path / "folder"):
        with pytest.raises(StribeckError, match=r"cannot write .*give a path") as caught:
            write_whole(path, "text", error)
        assert type(caught.value) is error
    assert os.listdir(tmp_path) == ["folder"]


def test_a_failure_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.txt"
    write_whole(path, "old")

    def fails(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", fails)
    with pytest.raises(StribeckError, match="No space left"):
        write_whole(path, "new")
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]
