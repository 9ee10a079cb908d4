"""What is checked of a file before it is read: that it is one, and that it fits into memory."""

from __future__ import annotations

import gzip
import hashlib
import io
import os
import stat
import sys
import zlib
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from threading import Event
from typing import BinaryIO

import psutil

from stribeck.base.errors import RecordingError, nearest, option

__all__ = ["MOST_COLUMNS", "Asked", "Entered", "enter", "missing_library", "short"]

#: No recording has more columns; a file that does is of another kind.
MOST_COLUMNS = 10_000
#: Default of the largest table, where the computer has at least twice as much memory free.
MOST_GIGABYTES = 4.0
#: Bytes that are hashed or decompressed at a time.
_PIECE = 1 << 22
#: Longest name of a column.
_LONGEST_NAME = 200
#: Longest reason of a library that is repeated.
_LONGEST_REASON = 120


@dataclass(frozen=True)
class Asked:
    """What was asked of a file, as far as it decides what is read from it.

    Attributes
    ----------
    columns
        Names for the columns of a table without a header.
    named
        Columns that options name.
    formulas
        Texts in which options may name columns.
    joint
        The joint that was named.
    memory_limit
        Largest table, GB.
    """

    columns: tuple[str, ...] = ()
    named: tuple[str, ...] = ()
    formulas: tuple[str, ...] = ()
    joint: str | None = None
    memory_limit: float | None = None

    def among(self, columns: Collection[str]) -> list[str]:
        """Those of `columns` that were asked for."""
        named = set(self.named)
        return [c for c in columns if c in named or any(c in text for text in self.formulas)]

    def mentions(self, prefix: str) -> bool:
        """Whether a column was asked for whose name begins like this."""
        return any(c.startswith(prefix) for c in self.named) or any(
            prefix in text for text in self.formulas
        )


@dataclass(frozen=True)
class Entered:
    """A regular file that may be read.

    Attributes
    ----------
    path, suffix
        As given; the suffix without ``.gz``, in lower case.
    size
        Bytes of the file.
    compressed
        Whether the whole file is compressed by gzip.
    most
        Bytes that its table may have.
    """

    path: Path
    suffix: str
    size: int
    compressed: bool
    most: int

    @property
    def name(self) -> str:
        """The path, as sentences begin with it."""
        return str(self.path)

    @contextmanager
    def hashing(self) -> Iterator[Callable[[], str]]:
        """Hash the bytes of the file while it is read; gives what waits for the hash."""
        stop = Event()

        def sha256() -> str:
            made = hashlib.sha256()
            with open(self.path, "rb") as stream:
                while not stop.is_set() and (piece := stream.read(_PIECE)):
                    made.update(piece)
            return made.hexdigest()

        with ThreadPoolExecutor(1) as beside:
            running = beside.submit(sha256)
            try:
                yield running.result
            finally:
                # Nobody waits for the hash of a file that is refused.
                stop.set()

    @cached_property
    def data(self) -> bytes:
        """The bytes in memory, decompressed."""
        if not self.compressed:
            self.refuse_above(self.size, "the file")
            return self.path.read_bytes()
        made = bytearray()
        try:
            with gzip.open(self.path, "rb") as stream:
                while piece := stream.read(_PIECE):
                    made += piece
                    self.refuse_above(len(made), "the decompressed file")
        except (OSError, EOFError, zlib.error):
            raise RecordingError(f"{self.name}: is not a whole gzip file, write it again") from None
        return bytes(made)

    def open(self) -> BinaryIO:
        """The bytes as a file that can be searched, decompressed."""
        return io.BytesIO(self.data) if self.compressed else open(self.path, "rb")

    @property
    def source(self) -> bytes | Path:
        """The path, or the bytes of what had to be decompressed."""
        return self.data if self.compressed else self.path

    def refuse_above(self, size: int, what: str) -> None:
        """Refuse what is larger than memory allows; `size` in bytes.

        Raises
        ------
        RecordingError
            With the option that raises the limit.
        """
        if size > self.most:
            raise self.above(what)

    def above(self, what: str) -> RecordingError:
        """The error about something too large for memory."""
        limit = self.most / 1e9
        more = option("memory_limit", "GB")
        return RecordingError(
            f"{self.name}: {what} needs more than {limit:.3g} GB of memory, the limit: give "
            f"{more} if this computer has it, or a file with fewer rows and columns"
        )

    def damaged(self, kind: str, error: BaseException | str, remedy: str) -> RecordingError:
        """The error about a file that its library cannot read."""
        if isinstance(error, MemoryError):
            return self.above("a part of the file")
        return RecordingError(f"{self.name}: is not a whole {kind} file ({short(error)}): {remedy}")

    def check_columns(self, names: Sequence[str]) -> None:
        """Refuse what no recording has: too many columns, or a name as long as a page."""
        if len(names) > MOST_COLUMNS:
            raise RecordingError(
                f"{self.name}: has {len(names)} columns, at most {MOST_COLUMNS} are read: is it "
                "transposed, or of another kind?"
            )
        longest = max(names, key=len, default="")
        if len(longest) > _LONGEST_NAME:
            raise RecordingError(
                f"{self.name}: the name of a column has {len(longest)} characters "
                f"('{longest[:40]}...'), at most {_LONGEST_NAME} are read: correct the header"
            )

    def check_table(self, rows: int, columns: int) -> None:
        """Refuse a table that would not fit, before it is read."""
        self.refuse_above(8 * rows * columns, f"a table of {rows} rows and {columns} columns")


def enter(path: Path, asked: Asked) -> Entered:
    """Check that a path is a file that may be read; nothing of it is read yet.

    Raises
    ------
    RecordingError
        There is nothing, or something that is no regular file.
    """
    name = str(path)
    try:
        # Not opened: that would wait for the other end of a pipe.
        found = os.stat(path)
    except FileNotFoundError:
        raise RecordingError(f"{name}: no such file{_beside(path)}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise RecordingError(f"{name}: cannot be read ({short(str(reason))})") from None
    if stat.S_ISDIR(found.st_mode):
        raise RecordingError(f"{name}: is a directory, give one recording file")
    if not stat.S_ISREG(found.st_mode):
        raise RecordingError(f"{name}: is not a regular file: save the recording to one")
    try:
        with open(path, "rb"):
            pass
    except OSError as error:
        raise RecordingError(f"{name}: cannot be read ({error.strerror or error})") from None
    if found.st_size == 0:
        raise RecordingError(f"{name}: the file is empty")
    compressed = path.suffix.lower() == ".gz"
    suffix = Path(path.stem).suffix if compressed else path.suffix
    return Entered(path, suffix.lower(), found.st_size, compressed, _most(asked))


def _most(asked: Asked) -> int:
    """Bytes that a table may have: while it is checked, about as much again is needed."""
    if asked.memory_limit is not None:
        return int(asked.memory_limit * 1e9)
    free = psutil.virtual_memory().available
    if sys.platform != "win32":
        import resource

        soft, _ = resource.getrlimit(resource.RLIMIT_AS)
        if soft != resource.RLIM_INFINITY:
            free = min(free, max(soft - psutil.Process().memory_info().vms, 0))
    return int(min(MOST_GIGABYTES * 1e9, free / 2))


def missing_library(name: str, kind: str, library: str) -> RecordingError:
    """The error about a format whose library is not installed."""
    return RecordingError(
        f"{name}: {kind} files need {library}: install it with pip install 'stribeck[readers]'"
    )


def short(error: BaseException | str) -> str:
    """The first line of what a library said, of bounded length."""
    text = str(error).strip()
    if not text:
        return "unknown" if isinstance(error, str) else type(error).__name__
    return "".join(c if c.isprintable() else "?" for c in text.splitlines()[0][:_LONGEST_REASON])


def _beside(path: Path) -> str:
    """The hint at a file of a similar name; a like ending alone makes none similar."""
    try:
        files = [p for p in path.parent.iterdir() if p.is_file() and nearest(path.stem, [p.stem])]
        return nearest(path.name, [p.name for p in files])
    except (OSError, ValueError):
        return ""
