"""Figures and bytes into files, whole or not at all.

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

FORMATS = ("png", "svg", "pdf")


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


def write_bytes_whole(target: Path, content: bytes) -> None:
    """Write `content` so that a reader never sees half of it."""
    try:
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}-")
        try:
            with os.fdopen(handle, "wb") as stream:
                stream.write(content)
            os.chmod(name, 0o644)
            os.replace(name, target)
        except BaseException:
            os.unlink(name)
            raise
    except OSError as error:
        raise StribeckError(
            f"cannot write {target}: {error.strerror or error}; give a path in a folder that "
            f"exists and may be written to"
        ) from None
