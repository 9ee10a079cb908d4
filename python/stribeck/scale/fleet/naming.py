"""The robot, day and joint of a file, read from its path."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path

from stribeck.base.errors import RecordingError, SpecError, nearest, option

FIELDS = ("robot", "day", "joint")
_DATE = re.compile(r"(?<!\d)(\d{4})[-_.]?(\d{2})[-_.]?(\d{2})(?!\d)")
#: Fields that must have a certain form.
_WRITTEN = {"day": r"\d{4}[-_.]?\d{2}[-_.]?\d{2}"}
_PIECE = re.compile(r"\{(\w*)\}|(\*)|([^{}*]+)|(.)", re.DOTALL)


@dataclass(frozen=True)
class Name:
    """Robot, day and joint named by a path; None if the path does not name it."""

    robot: str | None
    day: date | None
    joint: str | None = None


@dataclass(frozen=True)
class Naming:
    """Pattern of the paths of a fleet.

    Parameters
    ----------
    pattern
        The end of a path, ``"{robot}/{day}.parquet"``: ``{robot}``, ``{day}`` and ``{joint}``
        match what they name and ``*`` matches anything; none of them matches a ``/``. None: the
        robot is the file's folder, the day is the last date in its path.

    Raises
    ------
    SpecError
        The pattern has an unknown field, or a field twice.

    Examples
    --------
    >>> Naming("{robot}/*_{day}.csv").name("/logs/cell_7/arm_2026-03-09.csv")
    Name(robot='cell_7', day=datetime.date(2026, 3, 9), joint=None)
    """

    pattern: str | None = None
    _expression: re.Pattern[str] | None = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_expression", self._compiled())

    def _compiled(self) -> re.Pattern[str] | None:
        if self.pattern is None:
            return None
        written, named = "", set()
        for name, star, plain, stray in _PIECE.findall(self.pattern):
            if stray or (name not in FIELDS and not (star or plain)):
                raise SpecError(
                    f"{option('name', self.pattern)}: {stray or '{' + name + '}'} is unknown"
                    f"{nearest(name, FIELDS)}; write {{robot}}, {{day}}, {{joint}} and *"
                )
            if name in named:
                raise SpecError(f"{option('name', self.pattern)}: {{{name}}} is given twice")
            if name:
                named.add(name)
                written += f"(?P<{name}>{_WRITTEN.get(name, '[^/]+?')})"
            else:
                written += "[^/]*?" if star else re.escape(plain)
        return re.compile(rf"(?:^|/){written}$")

    def name(self, path: str) -> Name:
        """Return robot, day and joint of the file at an absolute `path`.

        Raises
        ------
        RecordingError
            The path does not match the pattern, or its day is not a date.
        """
        expression = self._expression
        plain = Path(path).as_posix()
        if expression is None:
            return Name(Path(path).parent.name or None, _last_date(plain))
        found = expression.search(plain)
        if found is None:
            raise RecordingError(f"{path} does not match {option('name', self.pattern or '')}")
        said = found.groupdict()
        day = None if said.get("day") is None else as_date(said["day"])
        if said.get("day") is not None and day is None:
            raise RecordingError(f"{path}: its day {said['day']} is not in the calendar")
        return Name(said.get("robot"), day, said.get("joint"))


def as_date(text: str) -> date | None:
    """Return the date at the beginning of a text, or None.

    Examples
    --------
    >>> as_date("2026-03-09T06:00:00"), as_date("20260309"), as_date("monday")
    (datetime.date(2026, 3, 9), datetime.date(2026, 3, 9), None)
    """
    found = _DATE.match(text.strip())
    return None if found is None else _date(found)


def _last_date(path: str) -> date | None:
    """Return the last date in a path: the date of a file has priority over that of its folder."""
    dates = [day for found in _DATE.finditer(path) if (day := _date(found)) is not None]
    return dates[-1] if dates else None


def _date(found: re.Match[str]) -> date | None:
    try:
        return date(*map(int, found.groups()))
    except ValueError:
        return None
