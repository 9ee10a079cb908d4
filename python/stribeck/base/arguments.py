"""Arguments of public functions: checked where they enter, for Python and the command alike.

`door` wraps a function. It checks arguments whose names are in `RULES`, and those of which it is
told the class; and it turns the errors of libraries into sentences (`stribeck.base.foreign`).
"""

from __future__ import annotations

import functools
import inspect
import os
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import ParamSpec, TypeAlias, TypeVar

from stribeck.base.checks import check_count, check_number, check_share, shown
from stribeck.base.errors import SpecError, StribeckError
from stribeck.base.foreign import sentence_of

__all__ = ["MOST_SEED", "MOST_STARTS", "RULES", "door"]

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")
#: Raises `SpecError` for a value that cannot be used; takes the argument's name and value.
Rule: TypeAlias = Callable[[str, object], None]

#: More random starts find nothing new, and their table does not fit into memory.
MOST_STARTS = 100_000
#: Seeds are 63-bit numbers.
MOST_SEED = 2**63 - 1
#: Most samples of an excerpt or window.
_MOST_ROWS = 10**9


def _count(least: int, most: int) -> Rule:
    return lambda name, value: check_count(name, value, least, most)


def _path(name: str, value: object) -> None:
    if not isinstance(value, str | os.PathLike):
        raise SpecError(f"`{name}` is {shown(value)}: give a path")
    if "\0" in os.fsdecode(value):
        raise SpecError(f"`{name}` is {shown(value)}: a path has no null character")


def _paths(name: str, value: object) -> None:
    if isinstance(value, str | os.PathLike) or not isinstance(value, Iterable):
        raise SpecError(f"`{name}` is {shown(value)}: give a list of paths")


def _text(name: str, value: object) -> None:
    if not isinstance(value, str):
        raise SpecError(f"`{name}` is {shown(value)}: give a text")


def _text_or_none(name: str, value: object) -> None:
    if value is not None:
        _text(name, value)


def _texts(name: str, value: object) -> None:
    if isinstance(value, str) or not isinstance(value, Collection):
        raise SpecError(f"`{name}` is {shown(value)}: give a list of texts")
    for item in value:
        _text(name, item)


def _box(name: str, value: object) -> None:
    if value is None:
        return
    if not isinstance(value, Mapping):
        raise SpecError(f"`{name}` is {shown(value)}: give a dict of (low, high) by channel")
    for channel, sides in value.items():
        if not isinstance(channel, str):
            raise SpecError(f"`{name}` has the channel {shown(channel)}: give its name")
        if isinstance(sides, str) or not isinstance(sides, Iterable) or len([*sides]) != 2:
            raise SpecError(f"`{name}` of {channel} is {shown(sides)}: give (low, high)")
        for side in sides:
            check_number(f"{name} of {channel}", side)


#: What an argument of this name must be, in every public function.
RULES: dict[str, Rule] = {
    "starts": _count(1, MOST_STARTS),
    "seed": _count(0, MOST_SEED),
    "least_fall": check_share,
    "resamples": _count(1, 10**6),
    "most_steps": _count(0, 1000),
    "sample_rows": _count(1, _MOST_ROWS),
    "window_rows": _count(1, _MOST_ROWS),
    "rejected": _texts,
    "candidates": _texts,
    "effect": _text,
    "name": _text_or_none,
    "formula": _text,
    "to": _text,
    "box": _box,
    "folder": _path,
    "path": _path,
    "output": _path,
    "files": _paths,
}


def door(
    error: type[StribeckError] = SpecError, **kinds: tuple[str, type | tuple[type, ...]]
) -> Callable[[Callable[Arguments, Result]], Callable[Arguments, Result]]:
    """Wrap a public function: its arguments are checked, and foreign errors become `error`.

    Parameters
    ----------
    error
        The error to raise in place of one of the system or of a library.
    **kinds
        By argument: what to give in words, and the classes that it may have.

    Examples
    --------
    >>> @door(recording=("a recording", dict))
    ... def rows(recording, starts=20):
    ...     return len(recording)
    >>> rows(None)
    Traceback (most recent call last):
    stribeck.base.errors.SpecError: `recording` is None: give a recording
    >>> rows({}, starts=0)
    Traceback (most recent call last):
    stribeck.base.errors.SpecError: `starts=0`: give a whole number from 1 to 100000
    """

    def decorate(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
        signature = inspect.signature(function)

        @functools.wraps(function)
        def checked(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Result:
            try:
                given = signature.bind(*args, **kwargs).arguments
            except TypeError as failure:
                # Python's own words for a wrong call name the function.
                raise TypeError(f"{function.__name__}() {failure}") from None
            for name, value in given.items():
                if name in kinds:
                    _check_kind(name, value, *kinds[name], given)
                elif name in RULES:
                    RULES[name](name, value)
            try:
                return function(*args, **kwargs)
            except StribeckError:
                raise
            except Exception as failure:
                sentence = sentence_of(failure)
                if sentence is None:
                    raise
                raise error(sentence) from failure

        return checked

    return decorate


def _check_kind(
    name: str,
    value: object,
    words: str,
    kinds: type | tuple[type, ...],
    given: Mapping[str, object],
) -> None:
    if isinstance(value, kinds):
        return
    # What was to be given stands in another place.
    swapped = next((other for other, one in given.items() if isinstance(one, kinds)), None)
    hint = "" if swapped is None else f"; are `{name}` and `{swapped}` swapped?"
    raise SpecError(f"`{name}` is {shown(value)}: give {words}{hint}")
