"""Options in sentences as the command line spells them."""

from __future__ import annotations

from stribeck.base.errors import spell_options


def with_flags(text: str) -> str:
    """A sentence with its options (`stribeck.base.errors.option`) as flags.

    Examples
    --------
    >>> with_flags('say which with `map="time=COLUMN"`')
    'say which with --map time=COLUMN'
    """
    return spell_options(text, _flag)


def _flag(name: str, value: str | None) -> str:
    flag = "--" + name.replace("_", "-")
    return flag if value is None else f"{flag} {value}"
