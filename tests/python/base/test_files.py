"""Files are written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from stribeck.base.errors import ModelFileError, StribeckError
from stribeck.base.files import write_bytes_whole, write_whole
from stribeck.base.replaceable import check_replaceable, kind_of


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


def test_a_picture_does_not_replace_a_robot(tmp_path: Path) -> None:
    """Both may begin with the declaration of XML."""
    picture = b'<?xml version="1.0"?>\n<!-- made by hand -->\n<svg xmlns="http://www.w3.org">'
    robot = b'<?xml version="1.0"?>\n<robot name="arm"><link name="svg"/></robot>'
    assert [kind_of(one) for one in (picture, picture[22:], robot)] == ["SVG", "text", "XML"]
    assert kind_of(b"<svg width='9'>") == "SVG"
    path = tmp_path / "arm.urdf"
    path.write_bytes(robot)
    with pytest.raises(StribeckError, match=r"a file of another kind is there \(XML, not SVG\)"):
        check_replaceable(path, kind_of(picture))
    path.write_bytes(picture)
    check_replaceable(path, "SVG")
