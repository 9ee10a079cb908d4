"""A folder of a run: what a killed run leaves in it does not keep the next one out."""

from __future__ import annotations

import errno
import io
import os
from pathlib import Path
from typing import Any

import pytest
from stribeck.base.errors import StribeckError
from stribeck.base.run_folder import MANIFEST, claim

RUN = {"seed": 3}
IDENTITY = {"seed": "with another seed"}


def test_a_run_killed_before_its_manifest_was_whole_can_begin_again(
    tmp_path: Path,
) -> None:
    (tmp_path / ".lock").touch()
    (tmp_path / f".{MANIFEST}-0a1b2c3d").write_text('{"se')
    claim(tmp_path, RUN, IDENTITY, "study").release()
    assert (tmp_path / MANIFEST).exists()


def test_other_files_are_not_touched(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(StribeckError, match="is not empty and holds no study"):
        claim(tmp_path, RUN, IDENTITY, "study")
    assert os.listdir(tmp_path) == ["notes.txt"]


def test_a_folder_has_one_run_at_a_time(tmp_path: Path) -> None:
    held = claim(tmp_path, RUN, IDENTITY, "study")
    with pytest.raises(StribeckError, match="another run works in"):
        claim(tmp_path, RUN, IDENTITY, "study")
    held.release()
    with pytest.raises(StribeckError, match=r"with another seed \(3 there, 4 here\)"):
        claim(tmp_path, {"seed": 4}, IDENTITY, "study")
    claim(tmp_path, RUN, IDENTITY, "study").release()


def test_a_full_disk_leaves_no_manifest(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = os.fdopen

    def full(handle: int, *words: Any, **options: Any) -> io.IOBase:
        stream = real(handle, *words, **options)

        class Full(io.BytesIO):
            def write(self, content: Any) -> int:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

            def close(self) -> None:
                stream.close()

        return Full()

    monkeypatch.setattr("stribeck.base.files.os.fdopen", full)
    with pytest.raises(StribeckError, match="No space left on device"):
        claim(tmp_path / "run", RUN, IDENTITY, "study")
    monkeypatch.undo()
    claim(tmp_path / "run", RUN, IDENTITY, "study").release()
