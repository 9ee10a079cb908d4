"""One writer at a time: a lock beside a file or in a folder, which ends with its process."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from stribeck.base.errors import StribeckError

__all__ = ["LOCK", "one_writer", "take"]

#: Name of the lock of a folder.
LOCK = ".lock"


class Held:
    """A lock that this process holds until `release`, or until it ends, however it ends."""

    def __init__(self, path: Path, busy: str) -> None:
        # Imported here: only commands that continue earlier work need it.
        from filelock import FileLock, Timeout

        self._path = path
        self._lock = FileLock(path)
        try:
            self._lock.acquire(timeout=0)
        except Timeout:
            raise StribeckError(busy) from None
        except (OSError, NotImplementedError) as error:
            reason = getattr(error, "strerror", None) or "the file system has no locks"
            raise StribeckError(
                f"cannot lock {path}: {reason}; give a path in a folder that can be written to"
            ) from None

    def release(self) -> None:
        """Give it up; a second call does nothing."""
        if self._lock.is_locked:
            # Before the release: afterwards it could be the lock of another process.
            with contextlib.suppress(OSError):
                self._path.unlink()
            self._lock.release()


def take(path: Path, busy: str) -> Held:
    """Take a lock.

    Parameters
    ----------
    path
        The lock's own file, which exists as long as it is held.
    busy
        The error if another process holds it, or another object of this process.

    Raises
    ------
    StribeckError
        It is held, or the file cannot be made.
    """
    return Held(path, busy)


@contextlib.contextmanager
def one_writer(path: str | os.PathLike[str]) -> Iterator[None]:
    """Exclude other commands that change a file, from its reading to its writing.

    Raises
    ------
    StribeckError
        Another command is changing the file.
    """
    target = Path(os.path.realpath(path))
    if not target.parent.is_dir():
        yield  # Whoever opens the file reports that.
        return
    held = take(
        target.parent / f".{target.name}{LOCK}",
        f"another command is changing {path}: run this one again when that has ended",
    )
    try:
        yield
    finally:
        held.release()
