"""Exceptions that carry one plain sentence: what is wrong, where, and what to do."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

__all__ = [
    "FitError", "ModelFileError", "ProjectError", "RecordingError", "SpecError", "StribeckError",
    "nearest",
]  # fmt: skip


class StribeckError(ValueError):
    """Base of every error a user can cause; the command line turns it into exit code 2."""


class RecordingError(StribeckError):
    """A recording, its sidecar or the options that read it cannot be used."""


class ModelFileError(StribeckError):
    """A model file cannot be used."""


class ProjectError(StribeckError):
    """A project file, or the data it is about, cannot be used."""


class SpecError(StribeckError):
    """A model spec (``LAW[+effect...]``) names something that does not exist or does not fit."""


class FitError(StribeckError):
    """A model cannot be identified from a recording."""


def nearest(name: str, options: Iterable[str]) -> str:
    """Return a hint ``"; did you mean 'x'?"`` for a mistyped name, or an empty string.

    Parameters
    ----------
    name
        What was typed.
    options
        What would have been accepted.
    """
    by_folded = {option.casefold(): option for option in options}
    found = difflib.get_close_matches(name.casefold(), list(by_folded), n=1, cutoff=0.6)
    return f"; did you mean '{by_folded[found[0]]}'?" if found else ""
