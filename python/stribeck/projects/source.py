"""The data of a project: files with their hashes, and the options that read them."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

from stribeck.base.errors import ProjectError
from stribeck.recording.load import Given, read
from stribeck.recording.recording import Recording
from stribeck.recording.several.join import joined_hash
from stribeck.recording.several.paths import listed_files, text_of
from stribeck.recording.stated.options import TABLE
from stribeck.recording.stated.sidecar import find_sidecar

#: Keys of ``[reading]``: the options of `stribeck.read`.
READING = tuple(entry.name for entry in TABLE)


class Stored(NamedTuple):
    """A data file in the state in which a project knows it.

    Attributes
    ----------
    path
        Relative to the folder of the project file.
    sha256, sidecar_sha256
        Hash of the file, and of its sidecar if there is one.
    """

    path: str
    sha256: str
    sidecar_sha256: str | None

    def to_dict(self) -> dict[str, str | None]:
        """As JSON."""
        return self._asdict()


@dataclass(frozen=True)
class Source:
    """Data files, identified by their content, and the options that read them.

    Attributes
    ----------
    folder
        Folder of the project file; paths of the files and of a given sidecar are relative to it.
    files
        One file, or several that are runs of one joint, in their order.
    reading
        Options of `stribeck.read` that were given.
    """

    folder: Path
    files: tuple[Stored, ...]
    reading: Mapping[str, Any]

    @classmethod
    def of(cls, data: Given, folder: Path, reading: Mapping[str, object]) -> Source:
        """Return the source of data files in their present state."""
        given = {name: _plain(said) for name, said in reading.items()}
        given = {name: said for name, said in given.items() if _is_said(said)}
        if "sidecar" in given:
            given["sidecar"] = os.path.relpath(str(given["sidecar"]), folder)
        named = cls(
            folder,
            tuple(Stored(os.path.relpath(f, folder), "", None) for f in listed_files(data)),
            given,
        )
        files = tuple(Stored(one.path, *named._hashes(one)) for one in named.files)
        return cls(folder, files, given)

    @property
    def path(self) -> str:
        """How sentences and model files name the data, relative to the folder."""
        return _named([one.path for one in self.files])

    @property
    def file(self) -> str:
        """The same from the working directory."""
        return _named(self.named)

    @property
    def named(self) -> tuple[str, ...]:
        """The files, each from the working directory."""
        return tuple(str(self._place(one)) for one in self.files)

    @property
    def sha256(self) -> str:
        """Hash of the data: that of the file, or of the names and hashes of several."""
        return joined_hash([(one.path, one.sha256) for one in self.files])

    def check(self) -> None:
        """Raise ProjectError if the data differ from those of the project.

        Raises
        ------
        ProjectError
        """
        for one in self.files:
            file = self._place(one)
            found, beside = self._hashes(one)
            if found != one.sha256:
                raise ProjectError(
                    f"{file} has changed since the project was made (SHA-256 {found[:12]}, was "
                    f"{one.sha256[:12]}): put the old file back, or make a project of the new one"
                )
            if beside != one.sidecar_sha256:
                raise ProjectError(
                    f"the sidecar of {file} has changed since the project was made: put the old "
                    f"one back, or make a new project"
                )

    @cached_property
    def recording(self) -> Recording:
        """The data, read with the options of the project."""
        self.check()
        return read(self.named, **self.options)

    @property
    def options(self) -> dict[str, Any]:
        """The options of `stribeck.read`, with the sidecar from the working directory."""
        named = self.reading.get("sidecar")
        given = {} if named is None else {"sidecar": str(self.folder / str(named))}
        return {**self.reading, **given}

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        first, *others = self.files
        several = {"files": [one.to_dict() for one in self.files]} if others else {}
        beside = None if others else first.sidecar_sha256
        return {
            "path": self.path,
            "sha256": self.sha256,
            "sidecar_sha256": beside,
            **several,
            "reading": dict(self.reading),
        }

    def _place(self, one: Stored) -> Path:
        """Path of a file from the working directory."""
        return self.folder / one.path

    def _hashes(self, one: Stored) -> tuple[str, str | None]:
        """Hash of a file, and of the sidecar that it is read with."""
        file, named = self._place(one), self.reading.get("sidecar")
        sidecar = find_sidecar(file) if named is None else self.folder / str(named)
        return _sha256(file), None if sidecar is None else _sha256(sidecar)


def _named(paths: Sequence[str]) -> str:
    return text_of(paths, paths)


def _sha256(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise ProjectError(
            f"{path}: the project's data cannot be read ({error.strerror or error})"
        ) from None


def _is_said(option: object) -> bool:
    """Whether an option has a value; an inertia of 0 is one."""
    return not (option is None or option is False or option == [])


def _plain(said: object) -> object:
    """Return an option in the form of the TOML file: a text, a number or a list of texts."""
    if isinstance(said, Mapping):
        return [f"{name}={value}" for name, value in said.items()]
    if isinstance(said, list | tuple):
        return [str(item) for item in said]
    return str(said) if isinstance(said, os.PathLike) else said
