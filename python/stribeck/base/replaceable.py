"""Which files an output may take the place of: none of another kind, none that a user made."""

from __future__ import annotations

import os
import re
import secrets
from pathlib import Path

from stribeck.base.errors import StribeckError

__all__ = [
    "OWN",
    "check_folder",
    "check_own",
    "check_regular",
    "check_replaceable",
    "check_table",
    "kind_of",
]

#: First line of the sidecars that are written together with a table.
OWN = "# Written by stribeck together with the table, and replaced with it."


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
    if not os.path.exists(target):
        return
    if not target.is_file():
        raise error(f"cannot write {target}: it is not a regular file; give a path to a file")
    try:
        with target.open("rb") as stream:
            present = kind_of(stream.read(_ENOUGH))
    except OSError as failure:
        raise error(
            f"cannot write {target}: {failure.strerror}; give a path that may be read and written"
        ) from None
    if present not in ("empty", kind):
        raise error(
            f"cannot write {target}: a file of another kind is there ({present}, not {kind}); give "
            f"another path, or remove it"
        )


#: First bytes that two exports of the same kind and name share.
_SAME = 12
#: Bytes from which the kind of a file shows.
_ENOUGH = 4096
_SIGNATURES = {
    b"PAR1": "Parquet",
    b"ARROW1": "Arrow",
    b"\x89PNG": "PNG",
    b"%PDF": "PDF",
    b"<?xml": "XML",
    b"<robot": "XML",
    b"<mujoco": "XML",
    b"<svg": "SVG",
    b"<!doctype html": "HTML",
    b"MATLAB": "MATLAB",
    b"PK\x03\x04": "archive",
    b"\x89HDF": "HDF5",
}
#: The first element of an SVG file, after declarations and comments.
_SVG = re.compile(rb"<svg[\s>]")
_TOML_KIND = re.compile(rb'^kind = "(\w+)"', re.MULTILINE)


def kind_of(content: bytes) -> str:
    """The kind of a file by its first bytes; of TOML files the value of the key ``kind``.

    Examples
    --------
    >>> kind_of(b'kind = "model"\\nlaw = "coulomb"'), kind_of(b"time,torque"), kind_of(b"")
    ('model file', 'text', 'empty')
    >>> kind_of(b'<?xml version="1.0"?><robot name="arm"/>'), kind_of(b'<?xml?>\\n<svg width="9">')
    ('XML', 'SVG')
    """
    start = content[:_ENOUGH]
    for signature, kind in _SIGNATURES.items():
        if start[: len(signature)].lower() == signature.lower():
            return "SVG" if kind == "XML" and _SVG.search(start) else kind
    stated = _TOML_KIND.search(start)
    if stated:
        return f"{stated[1].decode()} file"
    return "text" if start else "empty"


def check_regular(path: str | os.PathLike[str], error: type[StribeckError]) -> None:
    """Refuse to read a device or a pipe, which may never end; a missing file passes."""
    if os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path):
        raise error(f"cannot read {path}: it is not a regular file; give a path to a file")


def check_own(path: str | os.PathLike[str], text: str, error: type[StribeckError]) -> None:
    """Refuse to replace a file that neither names stribeck nor begins as the new `text` does."""
    if os.path.isfile(path):
        with open(path, "rb") as stream:
            start = stream.read(_ENOUGH)
        same = start[:_SAME] == text.encode()[:_SAME]
        if start and not same and b"stribeck" not in start.lower():
            raise error(
                f"cannot write {path}: a file that stribeck did not write is there; give another "
                f"folder, or remove it"
            )


def check_folder(path: str | os.PathLike[str], error: type[StribeckError] = StribeckError) -> None:
    """Refuse a path in whose folder no file can be made.

    Parameters
    ----------
    path
        Where a file is to be written.
    error
        The error to raise.
    """
    target = Path(path)
    try:
        folder = Path(os.path.realpath(target)).parent
        if not folder.is_dir():
            raise error(
                f"cannot write {target}: the folder {folder} does not exist; make it, or give "
                f"another path"
            )
        # As long as the unfinished file that takes the name in the end.
        trial = folder / f".{target.name}-{secrets.token_hex(4)}"
        os.close(os.open(trial, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
        os.unlink(trial)
    except (OSError, ValueError) as failure:
        if isinstance(failure, StribeckError):
            raise
        reason = getattr(failure, "strerror", None) or failure
        raise error(
            f"cannot write {target}: {reason}; give a path in a folder that exists and may be "
            f"written to"
        ) from None


def check_table(path: str | os.PathLike[str], error: type[StribeckError] = StribeckError) -> None:
    """Refuse to replace a table or a sidecar that `stribeck.base.files.write_table` did not write.

    A recording cannot be told from a simulated one by its content; the sidecar tells.

    Parameters
    ----------
    path
        Where a table is to be written; its sidecar stands beside it.
    error
        The error to raise.
    """
    sidecar = Path(f"{path}.sidecar.toml")
    own = False
    if sidecar.is_file():
        with sidecar.open("rb") as stream:
            own = stream.read(len(OWN)) == OWN.encode()
        if not own:
            raise error(
                f"cannot write {path}: the sidecar {sidecar} was not written together with it; "
                f"give another path"
            )
    if os.path.lexists(path) and not own:
        raise error(f"cannot write {path}: it exists already; remove it, or give another path")
