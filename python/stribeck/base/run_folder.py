"""A folder that holds one run of a command, which can be stopped and continued.

``manifest.json`` describes the run; the same arguments continue it, others are refused. A lock
keeps two runs out of the same folder.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from stribeck.base.errors import StribeckError, option
from stribeck.base.files import write_whole
from stribeck.base.lock import LOCK, Held, take

MANIFEST = "manifest.json"


def claim(
    folder: Path, manifest: Mapping[str, object], identity: Mapping[str, str], what: str
) -> Held:
    """Use a folder for a run: a new or empty one, or one that holds the same run.

    Parameters
    ----------
    folder
        Created if it does not exist.
    manifest
        The description of the run, as JSON.
    identity
        Keys of `manifest` that must be the same, and the words of the error if one is not:
        ``{"seed": "with another seed"}``.
    what
        What the folder holds, as in "holds no study".

    Returns
    -------
    Held
        The lock of the folder, to be released at the end of the run.

    Raises
    ------
    StribeckError
        The folder holds another run or other files, another process works in it, or it cannot be
        written to.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not _is_empty(folder) and not (folder / MANIFEST).exists():
            raise StribeckError(
                f"{folder} is not empty and holds no {what}: give another {option('output')}"
            )
        held = take(
            folder / LOCK,
            f"another run works in {folder}: wait for its end, or give another {option('output')}",
        )
        try:
            if (folder / MANIFEST).exists():
                _check(folder, manifest, identity, what)
            else:
                write_whole(folder / MANIFEST, json.dumps(manifest, indent=2) + "\n")
        except BaseException:
            held.release()
            raise
    except OSError as error:
        raise unwritable(folder, error) from None
    return held


def _is_empty(folder: Path) -> bool:
    """Return whether nothing is in a folder but what a run makes before its manifest."""
    begun = (LOCK, f".{MANIFEST}-")
    return all(path.name.startswith(begun) for path in folder.iterdir())


def unwritable(folder: Path, error: OSError) -> StribeckError:
    """Return the error of a folder that cannot be written to."""
    return StribeckError(
        f"cannot write {folder}: {error.strerror or error}; give {option('output')} a "
        f"folder that can be written to"
    )


def _check(
    folder: Path, manifest: Mapping[str, object], identity: Mapping[str, str], what: str
) -> None:
    path = folder / MANIFEST
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except ValueError:
        raise StribeckError(
            f"{path} is damaged: remove the folder, or give another {option('output')}"
        ) from None
    for key, difference in identity.items():
        if not isinstance(found, dict) or found.get(key) != manifest[key]:
            raise StribeckError(
                f"{folder} holds a {what} {difference}{_differs(found, manifest, key)}: give "
                f"another {option('output')}, or the same arguments to continue it"
            )


def _differs(found: object, manifest: Mapping[str, object], key: str) -> str:
    """Return ``(3 there, 5 here)`` for numbers and texts; other values are too long to show."""
    theirs = found.get(key) if isinstance(found, dict) else None
    ours = manifest[key]
    return f" ({theirs} there, {ours} here)" if isinstance(ours, int | str) else ""
