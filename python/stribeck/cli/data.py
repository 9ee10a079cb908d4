"""DATA and models as a command names them: which argument is which."""

from __future__ import annotations

import glob
import os
import shlex
from collections.abc import Callable, Sequence
from pathlib import Path

import click

from stribeck.base.errors import SpecError
from stribeck.base.replaceable import kind_of
from stribeck.cli.common import say
from stribeck.cli.options import Command
from stribeck.cli.words import complete_model
from stribeck.identify.stated.statements import names_in
from stribeck.models.formula_law import is_formula
from stribeck.models.published.sets import PREFIX
from stribeck.recording.several.paths import named_files
from stribeck.recording.tables.readers import SUFFIXES

#: One or several files, folders and patterns.
data_argument = click.argument("data", nargs=-1, required=True, metavar="DATA...")

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


def arguments_of(metavar: str) -> Callable[[Command], Command]:
    """The positional arguments of a command: DATA, then models."""
    return click.argument(
        "arguments", nargs=-1, required=True, metavar=metavar, shell_complete=complete_model
    )


#: One or several recordings, and models among them.
arguments_of_both = arguments_of("DATA... MODEL...")


def split(given: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The data and the models of a command, each in their order.

    Data stand before models; another order is understood, with a note on stderr.

    Raises
    ------
    SpecError
        There are no data among them.
    RecordingError
        A model file among the data, or data that are not there.
    """
    data, models = _parted(given)
    named_files(data)
    return data, models


def split_one(
    given: Sequence[str], flag: str, said: str | None, *, checked: bool = True
) -> tuple[tuple[str, ...], str | None]:
    """The data of a command, and its one model: an argument after the data, or that of `flag`.

    Parameters
    ----------
    flag
        The option that names the model too.
    said
        What it was given.
    checked
        Whether data that are not there are refused.

    Raises
    ------
    SpecError
        There are no data, or several models.
    """
    if said is not None and not any(map(is_data, given)):
        # A file that is not there is missed as such, not taken for a model.
        return tuple(given), said
    data, models = split(given) if checked else _parted(given)
    named = (*models, *([] if said is None else [said]))
    if len(named) > 1:
        both = f", one of them with {flag}" if models and said is not None else ""
        raise SpecError(f"one model is needed, {len(named)} are given{both}: {', '.join(named)}")
    return data, named[0] if named else None


def _parted(given: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Data and models, with a note if models stand before data."""
    are_data = [is_data(argument) for argument in given]
    data = tuple(argument for argument, yes in zip(given, are_data, strict=True) if yes)
    models = tuple(argument for argument, yes in zip(given, are_data, strict=True) if not yes)
    if not data:
        raise SpecError(
            f"no recording is among {', '.join(given)}: name a file, a folder or a pattern"
        )
    if are_data != sorted(are_data, reverse=True):
        in_order = shlex.join([*data, *models])
        say(f"note: DATA stands before models: {in_order} (another order is read the same)")
    return data, models


def _reads_as_formula(text: str) -> bool:
    """Whether a text is a formula, and not a pattern of paths."""
    try:
        return is_formula(text) and bool(names_in(text))
    except SpecError:
        return False
