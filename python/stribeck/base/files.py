"""Files that are written whole or not at all, and never in place of a file of another kind.

Nothing here loads the plotting library: a figure brings it along.
"""

from __future__ import annotations

import contextlib
import io
import os
import secrets
import stat
from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.base.errors import StribeckError
from stribeck.base.replaceable import OWN, check_replaceable, check_table, kind_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = [
    "FORMATS",
    "note_written",
    "place_table",
    "png_bytes",
    "save_figure",
    "write_bytes_whole",
    "write_table",
    "write_whole",
    "written_files",
]

#: Files that this process has written, in order.
_written: list[str] = []
#: How a new file is opened; without O_BINARY, Windows would change line ends.
_NEW = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
#: Formats of figures, by the ending of the path.
FORMATS = ("png", "svg", "pdf")


def write_whole(
    path: str | os.PathLike[str], text: str, error: type[StribeckError] = StribeckError
) -> None:
    """Write `text` in UTF-8 so that a reader never sees a part of it.

    Parameters
    ----------
    path
        An existing file is replaced.
    text
        The file's content. Line ends are written as they are on this platform.
    error
        The error to raise where the file cannot be written.

    Raises
    ------
    StribeckError
        Of the type `error`: the path cannot be written.
    """
    write_bytes_whole(path, text.replace("\n", os.linesep).encode(), error)


def write_bytes_whole(
    path: str | os.PathLike[str],
    content: bytes,
    error: type[StribeckError] = StribeckError,
    *,
    told: bool = True,
) -> None:
    """Write `content` so that a reader never sees a part of it.

    The bytes go to a temporary file in the same folder, which then takes the name `path`.

    Parameters
    ----------
    path
        An existing file is replaced.
    content
        The file's content.
    error
        The error to raise where the file cannot be written.
    told
        Whether the file is one of `written_files`.

    Raises
    ------
    StribeckError
        Of the type `error`: the path cannot be written.
    """
    # A symbolic link stays; the file that it names is written.
    target = Path(os.path.realpath(path))
    check_replaceable(path, kind_of(content), error)
    unfinished = target.parent / f".{target.name}-{secrets.token_hex(4)}"
    try:
        # A new file gets the permissions that any other new file would get here.
        handle = os.open(unfinished, _NEW, 0o666)
        try:
            with os.fdopen(handle, "wb") as stream:
                stream.write(content)
                stream.flush()
                # Else a power cut could leave the name with nothing behind it.
                os.fsync(stream.fileno())
            if target.exists():
                os.chmod(unfinished, stat.S_IMODE(target.stat().st_mode))
            os.replace(unfinished, target)
            if told:
                note_written(path)
        except BaseException:
            with contextlib.suppress(FileNotFoundError):
                os.unlink(unfinished)
            raise
    except OSError as failure:
        raise error(
            f"cannot write {path}: {failure.strerror or failure}; give a path in a folder that "
            f"exists and may be written to"
        ) from None


def write_table(
    path: str | os.PathLike[str],
    content: bytes,
    sidecar: str,
    error: type[StribeckError] = StribeckError,
) -> None:
    """Write a table and its sidecar; they replace nothing but an earlier pair of this function.

    Parameters
    ----------
    path
        The table; its sidecar is ``PATH.sidecar.toml``.
    content
        The table's bytes.
    sidecar
        The sidecar's TOML.
    error
        The error to raise where one of them cannot be written.

    Raises
    ------
    StribeckError
        Of the type `error`: a path cannot be written, or holds what the user made.
    """
    check_table(path, error)
    write_whole(f"{path}.sidecar.toml", f"{OWN}\n{sidecar}", error)
    write_bytes_whole(path, content, error)


def place_table(unfinished: str | os.PathLike[str], path: Path, sidecar: str) -> None:
    """As `write_table`, for a table that is in a file already: it takes the name `path`.

    Parameters
    ----------
    unfinished
        The table's file, in a folder on the same file system.
    path, sidecar
        As of `write_table`.
    """
    check_table(path)
    write_whole(f"{path}.sidecar.toml", f"{OWN}\n{sidecar}")
    os.replace(unfinished, path)
    note_written(path)


def written_files() -> list[str]:
    """The files that this process has written so far, each once, in order."""
    return list(dict.fromkeys(_written))


def note_written(path: str | os.PathLike[str]) -> None:
    """Add a file to `written_files`."""
    _written.append(os.fspath(path))


def png_bytes(figure: Figure) -> bytes:
    """The figure as a PNG file."""
    return _bytes(figure, "png")


def _bytes(figure: Figure, kind: str) -> bytes:
    stream = io.BytesIO()
    # No date inside: the same run gives the same bytes.
    metadata = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}[kind]
    figure.savefig(stream, format=kind, metadata=metadata)
    return stream.getvalue()


def save_figure(figure: Figure, path: str | os.PathLike[str]) -> None:
    """Write a figure whole or not at all; the format (png, svg, pdf) is the path's ending.

    Raises
    ------
    StribeckError
        Another ending, or a path that cannot be written.
    """
    target = Path(path)
    kind = target.suffix.lower().lstrip(".")
    if kind not in FORMATS:
        raise StribeckError(f"cannot draw {target}: its name must end in .png, .svg or .pdf")
    write_bytes_whole(target, _bytes(figure, kind))
