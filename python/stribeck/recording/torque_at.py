"""Where a torque was measured: at the motor, as a command, or at the link."""

from __future__ import annotations

import re
from collections.abc import Iterable

__all__ = ["SHOWS", "guess_torque_at"]

#: Words in names of columns that say where.
_WORDS = {
    "command": "des desired cmd command commanded ref reference set setpoint goal target",
    "link": "link sensor cell ext external load ft jts",
    "motor": "mot motor current curr i iq pwm duty",
}

#: What a torque measured there can show.
SHOWS = {
    "motor": "it holds the friction of motor, gear and bearings",
    "command": "it is what was asked of the drive, so it shows friction only as far as the drive "
    "follows its command",
    "link": "it does not hold the friction of motor and gear, which then cannot be found",
}


def guess_torque_at(columns: Iterable[str], *, is_current: bool) -> str | None:
    """Where a torque was measured, by the names of its columns; None where they do not say it.

    Parameters
    ----------
    columns
        Columns that the torque is read or computed from.
    is_current
        Whether it is computed from a current.

    Examples
    --------
    >>> guess_torque_at(["tau_des_Nm_3"], is_current=False)
    'command'
    >>> guess_torque_at(["torque"], is_current=False) is None
    True
    """
    words = {
        word.casefold()
        for column in columns
        for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", column)
    }
    for where, known in _WORDS.items():
        if not words.isdisjoint(known.split()):
            return where
    return "motor" if is_current else None
