"""Keyword arguments of a study or a fleet: how recordings are read, what is stated."""

from __future__ import annotations

from typing import Any, cast

from stribeck.identify.stated.choices import CHOICE_NAMES, ChoiceArguments, Choices
from stribeck.recording.stated.options import ReadArguments, ReadOptions

__all__ = ["ScaleArguments", "split_arguments"]


class ScaleArguments(ReadArguments, ChoiceArguments, total=False):
    """How the recordings are read, and what is stated about parameters."""


def split_arguments(options: ScaleArguments) -> tuple[ReadOptions, Choices]:
    """How the recordings are read, and what is stated about parameters."""
    reading: dict[str, Any] = dict(options)
    stated = {name: reading.pop(name) for name in CHOICE_NAMES if name in reading}
    return ReadOptions.of(reading), Choices.of(cast(ChoiceArguments, stated))
