"""Options that the chosen mode of a command does not read: refused in one sentence.

Without this, a call would answer another question than the one that was asked.
"""

from __future__ import annotations

from collections.abc import Mapping

import click
from click.core import ParameterSource

from stribeck.base.errors import SpecError

#: Where the value of an option that nobody gave comes from.
_NOT_GIVEN = (None, ParameterSource.DEFAULT, ParameterSource.DEFAULT_MAP)


def refuse_unread(mode: str, readers: Mapping[str, str]) -> None:
    """Refuse options of the running command that were given, and that `mode` does not read.

    Parameters
    ----------
    mode
        Where they have no effect, as in ``"with --torque"``.
    readers
        By argument of the command: where the option has one, as in ``"with --spring"``.

    Raises
    ------
    SpecError
        One of them was given.
    """
    context = click.get_current_context()
    for option in context.command.params:
        name = option.name or ""
        if name in readers and context.get_parameter_source(name) not in _NOT_GIVEN:
            flag = option.opts[0]
            raise SpecError(f"{flag} has no effect {mode}, only {readers[name]}: omit {flag}")
