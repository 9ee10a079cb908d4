"""Groups of options that several commands share."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from typing import Any, TypeAlias, TypeVar

Command = TypeVar("Command", bound=Callable[..., object])
#: The values of options by name, as click gives them to a command.
Values: TypeAlias = dict[str, Any]


def gathered(
    command: Command,
    options: Iterable[Callable[[Command], Command]],
    name: str,
    build: Callable[[Values], object],
) -> Command:
    """Add `options` to a command, which receives one argument built from their values.

    Parameters
    ----------
    options
        In the order of the help.
    name
        The argument that the command receives.
    build
        Takes the values of the options out of all values, and returns the argument.
    """

    @functools.wraps(command)
    def wrapper(**values: Any) -> object:
        argument = build(values)
        return command(**{name: argument}, **values)

    return added(options, wrapper)


def added(options: Iterable[Callable[[Command], Command]], command: Any) -> Command:
    """The command with `options`, which its help shows in this order."""
    for option in reversed(list(options)):
        command = option(command)
    decorated: Command = command
    return decorated
