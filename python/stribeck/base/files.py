"""Files that are written whole or not at all: text, bytes, figures.

Nothing here loads the plotting library: a figure brings it along.
"""

from __future__ import annotations

import io
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.base.errors import StribeckError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["FORMATS", "png_bytes", "save_figure", "write_bytes_whole", "write_whole"]

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
    target = Path(path)
    try:
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}-")
        try:
            with os.fdopen(handle, "wb") as stream:
                stream.write(content)
            # Temporary files are private to the user; a result is as readable as any other file.
            os.chmod(name, 0o644)
            os.replace(name, target)
        except BaseException:
            os.unlink(name)
            raise
    except OSError as failure:
        raise error(
            f"cannot write {target}: {failure.strerror or failure}; give a path in a folder that "
            f"exists and may be written to"
        ) from None


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
