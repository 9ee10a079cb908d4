"""The files that a fleet is given."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable
from pathlib import Path

from stribeck.base.errors import RecordingError

__all__ = ["expand"]


def expand(files: Iterable[str | Path]) -> list[str]:
    """Return the absolute paths of files and patterns in order, each once, without sidecars.

    Raises
    ------
    RecordingError
        A pattern matches no file, or nothing is given.
    """
    found: set[str] = set()
    for given in map(str, files):
        matches = [given]
        if glob.has_magic(given) and not os.path.exists(given):
            matches = glob.glob(given, recursive=True)
            if not matches:
                raise RecordingError(f"no file matches {given}: check the pattern")
        found |= {str(Path(path).absolute()) for path in matches}
    paths = sorted(path for path in found if not path.endswith(".sidecar.toml"))
    if not paths:
        raise RecordingError("no file is given: name recordings, or a pattern that matches them")
    return paths
