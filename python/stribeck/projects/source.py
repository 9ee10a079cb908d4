"""The data of a project: the file, its hash, and the options that read it."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from stribeck.base.errors import ProjectError
from stribeck.recording.load import read
from stribeck.recording.options import TABLE
from stribeck.recording.recording import Recording
from stribeck.recording.sidecar import find_sidecar

#: Keys of ``[reading]``: the options of `stribeck.read`.
READING = tuple(entry.name for entry in TABLE)


@dataclass(frozen=True)
class Source:
    """A data file, identified by its content, and the options that read it.

    Attributes
    ----------
    folder
        Folder of the project file; `path` and the path of a given sidecar are relative to it.
    sha256, sidecar_sha256
        Hash of the file, and of its sidecar if there is one.
    reading
        Options of `stribeck.read` that were given.
    """

    folder: Path
    path: str
    sha256: str
    sidecar_sha256: str | None
    reading: Mapping[str, Any]

    @classmethod
    def of(
        cls, data: str | os.PathLike[str], folder: Path, reading: Mapping[str, object]
    ) -> Source:
        """Return the source of a data file in its present state."""
        given = {name: _plain(said) for name, said in reading.items()}
        given = {name: said for name, said in given.items() if _is_said(said)}
        if "sidecar" in given:
            given["sidecar"] = os.path.relpath(str(given["sidecar"]), folder)
        path = os.path.relpath(data, folder)
        made = cls(folder, path, "", None, given)
        return cls(folder, path, *made._hashes(), given)

    @property
    def file(self) -> Path:
        """Path of the data file from the working directory."""
        return self.folder / self.path

    @property
    def sidecar(self) -> Path | None:
        """Path of the sidecar used to read the file, from the working directory."""
        named = self.reading.get("sidecar")
        return find_sidecar(self.file) if named is None else self.folder / str(named)

    def check(self) -> None:
        """Raise ProjectError if the data differ from those of the project.

        Raises
        ------
        ProjectError
        """
        found, beside = self._hashes()
        if found != self.sha256:
            raise ProjectError(
                f"{self.file} has changed since the project was made (SHA-256 {found[:12]}, was "
                f"{self.sha256[:12]}): put the old file back, or make a project of the new one"
            )
        if beside != self.sidecar_sha256:
            raise ProjectError(
                f"the sidecar of {self.file} has changed since the project was made: put the old "
                f"one back, or make a new project"
            )

    @cached_property
    def recording(self) -> Recording:
        """The data, read with the options of the project."""
        self.check()
        named = {} if self.sidecar is None else {"sidecar": self.sidecar}
        return read(self.file, **{**self.reading, **named})

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "path": self.path,
            "sha256": self.sha256,
            "sidecar_sha256": self.sidecar_sha256,
            "reading": dict(self.reading),
        }

    def _hashes(self) -> tuple[str, str | None]:
        return _sha256(self.file), None if self.sidecar is None else _sha256(self.sidecar)


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
