"""The files that are named by paths, folders and patterns."""

from __future__ import annotations

import glob
import os
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TypeAlias

from stribeck.base.errors import RecordingError, option
from stribeck.base.replaceable import kind_of
from stribeck.recording.stated.options import FilePath
from stribeck.recording.tables.readers import SUFFIXES

__all__ = [
    "Given",
    "is_folder_or_pattern",
    "listed_files",
    "named_files",
    "run_name",
    "run_names",
    "text_of",
]

#: A file, a folder, a pattern, or several of them.
Given: TypeAlias = FilePath | Sequence[FilePath]

#: Ends of files that are recordings wherever they lie; a text file in a folder may be anything.
_IN_FOLDERS = tuple(sorted(SUFFIXES - {".txt", ".dat"}))
_SIDECAR = ".sidecar.toml"
#: Bytes from which the kind of a file shows.
_HEAD = 4096


def named_files(given: Sequence[FilePath]) -> list[str]:
    """The files that paths, folders and patterns name, in their order.

    Those of a folder or pattern are ordered by name, numbers by value; sidecars are left out.

    Raises
    ------
    RecordingError
        Nothing is named, a file twice, or something that is no recording.
    """
    if not given:
        raise RecordingError("no file is given: name a recording, a folder or a pattern")
    files = [file for one in given for file in _found(os.fspath(one))]
    kept = [file for file in files if not _is_sidecar_of(file, files)]
    seen: dict[str, str] = {}
    for file in kept:
        _refuse_other_kinds(file)
        place = os.path.realpath(file)
        if place in seen:
            raise RecordingError(f"{file}: is given twice: name each file once")
        seen[place] = file
    return kept


def listed_files(given: Given) -> list[str]:
    """The files of what `stribeck.read` takes; see `named_files`."""
    return named_files(_listed(given))


def _listed(given: Given) -> Sequence[FilePath]:
    return [given] if isinstance(given, str | os.PathLike) else list(given)


def is_folder_or_pattern(path: FilePath) -> bool:
    """Whether a path is a folder, or a pattern that is no file."""
    return os.path.isdir(path) or (glob.has_magic(os.fspath(path)) and not os.path.exists(path))


def text_of(given: Given, files: Sequence[str]) -> str:
    """How sentences name several files."""
    listed = _listed(given)
    if len(listed) == 1:
        return os.fspath(listed[0])
    return files[0] if len(files) == 1 else f"{files[0]} and {len(files) - 1} more"


def run_name(path: FilePath) -> str:
    """The name of a file without its ending.

    Examples
    --------
    >>> run_name("logs/run_2.csv"), run_name("run_3.csv.gz")
    ('run_2', 'run_3')
    """
    name = Path(path).name
    return Path(name.removesuffix(".gz")).stem


def run_names(files: Sequence[str]) -> list[str]:
    """The name of each file as a run.

    Raises
    ------
    RecordingError
        Two files have the same name.
    """
    names = [run_name(file) for file in files]
    first: dict[str, str] = {}
    for name, file in zip(names, files, strict=True):
        if name in first:
            raise RecordingError(
                f"{file}: would be run '{name}', as {first[name]} is: rename one of the two, since "
                "each file is a run with the file's name"
            )
        first[name] = file
    return names


def _found(path: str) -> list[str]:
    """The files that one path names."""
    if os.path.isdir(path):
        files = [str(file) for file in Path(path).iterdir() if _is_recording(file)]
        if not files:
            raise RecordingError(
                f"{path}: there are no recordings in this folder ({', '.join(_IN_FOLDERS)}): give "
                "files, or a pattern such as 'FOLDER/*.txt'"
            )
        return _ordered(files)
    if is_folder_or_pattern(path):
        files = [file for file in glob.glob(path, recursive=True) if os.path.isfile(file)]
        files = [file for file in files if not file.endswith(".toml")]
        if not files:
            raise RecordingError(f"{path}: no file matches this pattern")
        return _ordered(files)
    return [path]


def _is_recording(file: Path) -> bool:
    name = file.name.lower().removesuffix(".gz")
    return file.is_file() and not name.startswith(".") and name.endswith(_IN_FOLDERS)


def _ordered(files: Iterable[str]) -> list[str]:
    def key(file: str) -> list[tuple[int, str]]:
        return [(int(part) if part.isdigit() else -1, part) for part in re.split(r"(\d+)", file)]

    return sorted(files, key=key)


def _is_sidecar_of(file: str, files: Sequence[str]) -> bool:
    return file.endswith(_SIDECAR) and file.removesuffix(_SIDECAR) in files


def _refuse_other_kinds(file: str) -> None:
    """Refuse model files and sidecars, which have a place of their own."""
    # To open a pipe would wait for its other end.
    if not os.path.isfile(file):
        return
    try:
        with open(file, "rb") as stream:
            kind = kind_of(stream.read(_HEAD))
    except OSError:
        # A file that cannot be read is refused when it is read.
        return
    if kind == "recording file":
        raise RecordingError(
            f"{file}: is a sidecar, which is read with its recording: give the recording, and the "
            f"sidecar with {option('sidecar')} where it does not lie beside it"
        )
    if kind.endswith(" file"):
        toml = "" if file.endswith(".toml") else ", and name it .toml"
        what = f": give it as the model{toml}" if kind == "model file" else ""
        raise RecordingError(f"{file}: is a {kind}, not a recording{what}")
