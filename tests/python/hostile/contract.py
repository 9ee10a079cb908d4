"""What every hostile input must be answered with, and how a row of the tables is run.

Code 2, one line of at most 500 characters on stderr beside the notes, nothing on stdout, no
traceback, no warning of a library, and no file made, changed or removed.
"""

from __future__ import annotations

import io
import os
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import stribeck as sb
from stribeck.cli.main import main
from synthetic import joint

#: Characters of a sentence.
MOST = 500


@dataclass(frozen=True)
class Answer:
    """What a command said."""

    code: int
    out: str
    err: str
    warned: tuple[str, ...] = ()

    @property
    def lines(self) -> list[str]:
        """The lines on stderr that are no notes."""
        return [x for x in self.err.splitlines() if not x.startswith("note: ")]


def run(words: Sequence[str]) -> Answer:
    """Run the command in this process."""
    streams = [io.TextIOWrapper(io.BytesIO(), "utf-8") for _ in range(2)]
    before = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = streams
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            main(list(words))
            code = 0
    except SystemExit as done:
        code = done.code if isinstance(done.code, int) else 0
    finally:
        sys.stdout, sys.stderr = before
    texts = []
    for stream in streams:
        stream.flush()
        buffer = stream.buffer
        assert isinstance(buffer, io.BytesIO)
        texts.append(buffer.getvalue().decode())
    return Answer(code, *texts, tuple(str(warning.message) for warning in caught))


def check_refused(answer: Answer, said: str = "") -> None:
    """Code 2, and one clear line."""
    assert answer.code == 2, answer
    assert answer.out == ""
    assert len(answer.lines) == 1, answer.err[-2000:]
    (line,) = answer.lines
    check_sentence(line.removeprefix("stribeck: "), said)
    assert line.startswith("stribeck: ") and len(line) <= MOST, (len(line), line)
    assert answer.warned == ()


def check_sentence(sentence: str, said: str = "") -> None:
    """One line in our words."""
    assert 8 < len(sentence) <= MOST, sentence
    assert sentence.isprintable(), sentence
    for word in ("Traceback", "this is a defect", "object at 0x", "NoneType", "Errno"):
        assert word not in sentence, sentence
    assert said in sentence, sentence


Tree = dict[str, tuple[int, int, int]]


def tree(folder: Path) -> Tree:
    """Every file below a folder with its size, time of change and inode."""
    found: Tree = {}
    for place, _, names in os.walk(folder):
        found[place] = (0, 0, 0)
        for name in names:
            state = os.lstat(path := os.path.join(place, name))
            found[path] = (state.st_size, state.st_mtime_ns, state.st_ino)
    return found


@contextmanager
def nothing_written(folder: Path) -> Iterator[None]:
    """Assert that no file is made, changed or removed."""
    before = tree(folder)
    yield
    assert tree(folder) == before


def make_workspace(folder: Path) -> None:
    """The files that the rows name."""
    joint(rows=1200).write_csv(folder / "log.csv")
    joint(rows=1200, seed=2).write_csv(folder / "other.csv")
    sidecar = 'kind = "recording"\njoint_kind = "revolute"\n'
    (folder / "log.csv.sidecar.toml").write_text(sidecar)
    recording = sb.read(str(folder / "log.csv"))
    fitted = sb.fit("coulomb", recording, starts=1)
    sb.ModelFile.of(fitted).write(folder / "m.toml")
    sb.model("coulomb+temperature_viscous", a1=0.5, a2=2.0, sv=0.01, kv=0.0).save(
        folder / "warm.toml"
    )
    sb.Project.new(folder / "p.toml", folder / "log.csv", "coulomb", starts=1).save()
    (folder / "page.html").write_text("<!doctype html><p>mine</p>")
    (folder / "notes.txt").write_text("mine")
    (folder / "photo.png").write_bytes(b"\x89PNG mine")
    (folder / "folder").mkdir()
    (folder / "folder" / "kept.txt").write_text("mine")
    (folder / "folder" / "own.c").write_text("int main(void) { return 0; }")


#: A call from Python that must raise one of our errors.
Call = Callable[[], object]
