"""Options in sentences as the command line spells them."""

from __future__ import annotations

import shlex

from stribeck.base.errors import spell_options

#: Arguments that hold several values, and the flags that give one of them.
_SINGULAR = {"bounds": "bound", "constraints": "constraint", "ties": "tie"}


def with_flags(text: str) -> str:
    """A sentence with its options (`stribeck.base.errors.option`) as flags.

    Examples
    --------
    >>> with_flags('say which with `map="time=COLUMN"`')
    'say which with --map time=COLUMN'
    >>> with_flags('widen it with `bounds="inertia=0:1"`')
    'widen it with --bound inertia=0:1'

    A value that a shell would split or change is quoted:

    >>> with_flags('perhaps `map="torque=Torque actual value"`')
    "perhaps --map 'torque=Torque actual value'"
    """
    return spell_options(text, _flag)


def _flag(name: str, value: str | None) -> str:
    flag = "--" + _SINGULAR.get(name, name).replace("_", "-")
    return flag if value is None else f"{flag} {shlex.quote(value)}"
