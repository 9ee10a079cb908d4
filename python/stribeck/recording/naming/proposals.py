"""Columns that are not read, and the channel that each may hold."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import asdict, dataclass

from stribeck.recording.naming.names import (
    CHANNELS,
    any_index,
    channel_words,
    file_unit,
    parse_name,
)

__all__ = ["Proposal", "propose"]

#: A column with one of these words is no measurement.
_NOT_MEASURED = frozenset(
    "ref reference des desired cmd command set setpoint goal target err error sim model est ff "
    "limit max min".split()
)
#: The channel of a column whose unit alone is known.
_OF_UNIT = {
    "length": "position",
    "angle": "position",
    "linear velocity": "velocity",
    "angular velocity": "velocity",
    "temperature": "temperature",
}


@dataclass(frozen=True)
class Proposal:
    """A column that is not read.

    Attributes
    ----------
    channel
        That it may hold.
    unit
        Named in the column's name.
    """

    column: str
    channel: str
    unit: str | None

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return asdict(self)


def propose(columns: Iterable[str], used: Iterable[str], joint: str | None) -> list[Proposal]:
    """The columns that may hold a channel, but whose names leave it open.

    Parameters
    ----------
    columns, used
        Columns of the file, and those that are read.
    joint
        Number of the joint that is read from a file with several side by side; columns of the
        others are left out.

    Examples
    --------
    >>> propose(["t", "mos_temperature", "pos_ref"], ["t"], None)
    [Proposal(column='mos_temperature', channel='temperature', unit=None)]

    The unit alone says what a column may be, if no other is read as that:

    >>> propose(["t", "x_m", "y_mm"], ["t"], None)[0]
    Proposal(column='x_m', channel='position', unit='m')
    """
    known, found = set(used), []
    read = {parse_name(column).channel for column in known}
    for column in columns:
        index = any_index(column)
        if column in known or (joint is not None and index not in (None, joint)):
            continue
        words = [w.casefold() for w in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", column)]
        if not _NOT_MEASURED.isdisjoint(words):
            continue
        parsed = parse_name(column)
        channel, unit = parsed.channel, parsed.unit
        if channel is None:
            channels = [channel_words(word) for word in words if len(word) > 1]
            channel = next((c for c in reversed(channels) if c is not None), None)
            unit = file_unit(column)
        if channel is None and unit is not None:
            channel = _OF_UNIT.get(unit.dimension)
            channel = None if channel in read else channel
        if channel is None:
            continue
        fits = unit is not None and unit.dimension in CHANNELS[channel]
        found.append(Proposal(column, channel, unit.name if unit is not None and fits else None))
    return found
