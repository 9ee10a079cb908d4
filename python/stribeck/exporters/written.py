"""Files of an export: the choice of a format, and writing."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TypeVar

from stribeck.base.errors import ModelFileError, SpecError, nearest, option
from stribeck.base.files import write_whole
from stribeck.base.replaceable import check_own

_Named = TypeVar("_Named", bound=str)


def chosen(name_of_option: str, given: str, known: tuple[_Named, ...]) -> _Named:
    """The known name that is given.

    Raises
    ------
    SpecError
        None is.
    """
    for name in known:
        if name == given:
            return name
    raise SpecError(
        f"{option(name_of_option)} cannot be {given!r}{nearest(given, known)}; give one of "
        f"{', '.join(known)}"
    )


def write_files(texts: Mapping[str, str], folder: Path) -> tuple[Path, ...]:
    """Write texts by file name into a folder, which is created if needed.

    Raises
    ------
    ModelFileError
        The folder or a file cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ModelFileError(
            f"cannot create the folder {folder}: {error.strerror or error}; give another one"
        ) from None
    for name, text in texts.items():
        check_own(folder / name, text, ModelFileError)
    for name, text in texts.items():
        write_whole(folder / name, text, ModelFileError)
    return tuple(folder / name for name in texts)
