"""DATA and models as a command names them: which argument is which."""

from __future__ import annotations

import glob
import os
from collections.abc import Sequence
from pathlib import Path

import click

from stribeck.base.errors import SpecError
from stribeck.base.replaceable import kind_of
from stribeck.identify.statements import names_in
from stribeck.models.formula_law import is_formula
from stribeck.models.published.sets import PREFIX
from stribeck.recording.readers import SUFFIXES
from stribeck.recording.several.paths import named_files

#: One or several files, folders and patterns.
data_argument = click.argument("data", nargs=-1, required=True, metavar="DATA...")
#: The same, with models among them.
arguments_of_both = click.argument("arguments", nargs=-1, required=True, metavar="DATA... MODEL...")

#: Bytes from which the kind of a file shows.
_HEAD = 4096


def is_data(argument: str) -> bool:
    """Whether an argument names recordings, not a model.

    A model is the spec or formula of one, `published:ID`, or a TOML file that is no sidecar. All
    other files, folders and patterns are data, and so is what is named like one of them.
    """
    path, bare = Path(argument), argument.lower().removesuffix(".gz")
    if os.path.isdir(path) or bare.endswith((*SUFFIXES, ".sidecar.toml")):
        return True
    if os.path.isfile(path):
        with path.open("rb") as stream:
            kind = kind_of(stream.read(_HEAD))
        return not kind.endswith(" file") and not bare.endswith(".toml")
    if argument.startswith(PREFIX) or bare.endswith(".toml"):
        return False
    if glob.has_magic(argument) and glob.glob(argument, recursive=True):
        return True
    return "/" in argument and " " not in argument and not _reads_as_formula(argument)


def split(given: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The data and the models of a command, each in their order.

    Raises
    ------
    SpecError
        There are no data among them.
    RecordingError
        A model file among the data.
    """
    data = tuple(argument for argument in given if is_data(argument))
    models = tuple(argument for argument in given if not is_data(argument))
    if not data:
        raise SpecError(
            f"no recording is among {', '.join(given)}: name a file, a folder or a pattern"
        )
    named_files(data)
    return data, models


def _reads_as_formula(text: str) -> bool:
    """Whether a text is a formula, and not a pattern of paths."""
    try:
        return is_formula(text) and bool(names_in(text))
    except SpecError:
        return False
