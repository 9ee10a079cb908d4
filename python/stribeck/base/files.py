"""Files that are written whole or not at all, and never in place of a file of another kind.

Nothing here loads the plotting library: a figure brings it along.
"""

from __future__ import annotations

import io
import os
import re
import secrets
import stat
from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.base.errors import StribeckError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = [
    "FORMATS",
    "check_replaceable",
    "kind_of",
    "png_bytes",
    "save_figure",
    "write_bytes_whole",
    "write_whole",
]

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
    path: str | os.PathLike[str], content: bytes, error: type[StribeckError] = StribeckError
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
        except BaseException:
            os.unlink(unfinished)
            raise
    except OSError as failure:
        raise error(
            f"cannot write {path}: {failure.strerror or failure}; give a path in a folder that "
            f"exists and may be written to"
        ) from None


def check_replaceable(
    path: str | os.PathLike[str], kind: str, error: type[StribeckError] = StribeckError
) -> None:
    """Refuse to replace a file of another kind, a folder or a device.

    Parameters
    ----------
    path
        Where a file is to be written; there need not be one.
    kind
        The kind of the new content, as of `kind_of`.
    error
        The error to raise.
    """
    target = Path(path)
    if not target.exists():
        return
    if not target.is_file():
        raise error(f"cannot write {target}: it is not a regular file; give a path to a file")
    with target.open("rb") as stream:
        present = kind_of(stream.read(_ENOUGH))
    if present not in ("empty", kind):
        raise error(
            f"cannot write {target}: a file of another kind is there ({present}, not {kind}); give "
            f"another path, or remove it"
        )


#: Bytes from which the kind of a file shows.
_ENOUGH = 4096
_SIGNATURES = {
    b"PAR1": "Parquet",
    b"ARROW1": "Arrow",
    b"\x89PNG": "PNG",
    b"%PDF": "PDF",
    b"<?xml": "SVG",
    b"<!doctype html": "HTML",
    b"MATLAB": "MATLAB",
    b"PK\x03\x04": "archive",
    b"\x89HDF": "HDF5",
}
_TOML_KIND = re.compile(rb'^kind = "(\w+)"', re.MULTILINE)


def kind_of(content: bytes) -> str:
    """The kind of a file by its first bytes; of TOML files the value of the key ``kind``.

    Examples
    --------
    >>> kind_of(b'kind = "model"\\nlaw = "coulomb"'), kind_of(b"time,torque"), kind_of(b"")
    ('model file', 'text', 'empty')
    """
    start = content[:_ENOUGH]
    for signature, kind in _SIGNATURES.items():
        if start[: len(signature)].lower() == signature.lower():
            return kind
    stated = _TOML_KIND.search(start)
    if stated:
        return f"{stated[1].decode()} file"
    return "text" if start else "empty"


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
