"""Which robot a file is of, and of which day: from its path."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import date
from functools import cached_property
from pathlib import Path

from stribeck.base.errors import RecordingError, SpecError, nearest

#: What a pattern can name.
FIELDS = ("robot", "day", "joint")
_DATE = re.compile(r"(?<!\d)(\d{4})[-_.]?(\d{2})[-_.]?(\d{2})(?!\d)")
#: Fields that are written in one way only.
_WRITTEN = {"day": r"\d{4}[-_.]?\d{2}[-_.]?\d{2}"}
_PIECE = re.compile(r"\{(\w*)\}|(\*)|([^{}*]+)|(.)", re.DOTALL)


@dataclass(frozen=True)
class Name:
    """What a path says. Each is None where it says nothing of it."""

    robot: str | None
    day: date | None
    joint: str | None = None


@dataclass(frozen=True)
class Naming:
    """How the paths of a fleet are written.

    Parameters
    ----------
    pattern
        The end of a path, ``"{robot}/{day}.parquet"``: ``{robot}``, ``{day}`` and ``{joint}``
        stand for what they name, ``*`` for anything, none of them across a ``/``. None: the robot
        is the file's folder, the day the last date in its path.

    Raises
    ------
    SpecError
        The pattern names something else, or one of them twice.

    Examples
    --------
    >>> Naming("{robot}/*_{day}.csv").name("/logs/cell_7/arm_2026-03-09.csv")
    Name(robot='cell_7', day=datetime.date(2026, 3, 9), joint=None)
    """

    pattern: str | None = None

    def __post_init__(self) -> None:
        self._expression  # noqa: B018  a wrong pattern is refused where it is given

    @cached_property
    def _expression(self) -> re.Pattern[str] | None:
        if self.pattern is None:
            return None
        written, named = "", set()
        for field, star, plain, stray in _PIECE.findall(self.pattern):
            if stray or (field not in FIELDS and not (star or plain)):
                raise SpecError(
                    f"--name {self.pattern}: {stray or '{' + field + '}'} stands for nothing"
                    f"{nearest(field, FIELDS)}; write {{robot}}, {{day}}, {{joint}} and *"
                )
            if field in named:
                raise SpecError(f"--name {self.pattern}: {{{field}}} is there twice")
            if field:
                named.add(field)
                written += f"(?P<{field}>{_WRITTEN.get(field, '[^/]+?')})"
            else:
                written += "[^/]*?" if star else re.escape(plain)
        return re.compile(rf"(?:^|/){written}$")

    def name(self, path: str) -> Name:
        """Robot, day and joint of the file at an absolute `path`.

        Raises
        ------
        RecordingError
            The path is not as the pattern says, or its day is no date.
        """
        expression = self._expression
        plain = Path(path).as_posix()
        if expression is None:
            return Name(Path(path).parent.name or None, _last_date(plain))
        found = expression.search(plain)
        if found is None:
            raise RecordingError(f"{path} does not end as --name {self.pattern} says")
        said = found.groupdict()
        day = None if said.get("day") is None else as_date(said["day"])
        if said.get("day") is not None and day is None:
            raise RecordingError(f"{path}: its day {said['day']} is none of the calendar")
        return Name(said.get("robot"), day, said.get("joint"))


def as_date(text: str) -> date | None:
    """The date at the beginning of a text; None where there is none.

    Examples
    --------
    >>> as_date("2026-03-09T06:00:00"), as_date("20260309"), as_date("monday")
    (datetime.date(2026, 3, 9), datetime.date(2026, 3, 9), None)
    """
    found = _DATE.match(text.strip())
    return None if found is None else _date(found)


def _last_date(path: str) -> date | None:
    """The last date in a path, so that a file's own date wins over that of its folder."""
    dates = [day for found in _DATE.finditer(path) if (day := _date(found)) is not None]
    return dates[-1] if dates else None


def _date(found: re.Match[str]) -> date | None:
    try:
        return date(*map(int, found.groups()))
    except ValueError:
        return None
