"""The lines of a text file, looked at once before a table is made of them."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.door import Entered

__all__ = ["Lines", "look"]

#: Longest line and longest cell that are read; a recording's have some hundreds of characters.
LONGEST_LINE = 1_000_000
LONGEST_CELL = 131_072
#: Bytes looked at together: they stay in the cache.
_PIECE = 1 << 20
_NEWLINE, _QUOTE = 10, 34
_BLANK = re.compile(rb"\n[ \t]+\r?\n")


@dataclass(frozen=True)
class Lines:
    """What is known about the lines of a table.

    Attributes
    ----------
    count
        Lines that end, or hold something.
    quotes
        Whether a cell is quoted.
    blank
        Whether a line between others is blank.
    uneven
        The first line that has another number of separators than expected, and that number.
    end
        Byte after the last whole line; a line without an end may have been cut off.
    """

    count: int
    quotes: bool
    blank: bool
    uneven: tuple[int, int] | None
    end: int


def look(file: Entered, data: bytes, start: int, first: int, mark: bytes, expected: int) -> Lines:
    """Look at the lines from byte `start` on, which is the beginning of line `first`.

    Parameters
    ----------
    mark, expected
        What separates cells, and how many of them a line should have.

    Raises
    ------
    RecordingError
        A line is too long, a quote is not closed, or there are bytes of a binary file.
    """
    quotes = data.find(b'"', start) >= 0
    even = _all_even(file, data, start, first, mark, expected)
    if even is not None and not quotes:
        return even
    count, before, last = 0, 0, start - 1
    uneven: tuple[int, int] | None = None
    whole = np.frombuffer(data, dtype=np.uint8)
    for begin in range(start, len(data), _PIECE):
        piece = whole[begin : begin + _PIECE]
        at = np.flatnonzero((piece == _NEWLINE) | (piece == mark[0]))
        ends = np.flatnonzero(piece[at] == _NEWLINE)
        if not ends.size:
            before += at.size
        else:
            numbers = np.diff(ends, prepend=-1) - 1
            numbers[0] += before
            before = at.size - 1 - int(ends[-1])
            if uneven is None and (numbers != expected).any():
                uneven = _first_uneven(numbers, expected, first + count)
            stops = at[ends] + begin
            _check_lengths(file, np.diff(stops, prepend=last), first + count)
            last = int(stops[-1])
            count += int(ends.size)
        _check_lengths(file, np.array([begin + len(piece) - last]), first + count)
    end = last + 1
    if data[end:].strip():
        if uneven is None and before != expected:
            uneven = (first + count, before)
        count += 1
    if quotes:
        _check_quotes(file, whole[start:], first)
    return Lines(count, quotes, _has_blank(data, start), uneven, end)


def _all_even(
    file: Entered, data: bytes, start: int, first: int, mark: bytes, expected: int
) -> Lines | None:
    """The lines if all may have as many cells as expected: by counts, which are fast.

    A line with fewer cells than expected is then made up for by one with more, which is refused
    when the table is made.
    """
    if data.find(b"\0", start) >= 0:
        raise RecordingError(
            f"{file.name}: holds NUL characters, which text has not: give it the extension of its "
            "format, or write it again"
        )
    at = start
    while len(data) - at > LONGEST_LINE:
        at = data.rfind(b"\n", at, at + LONGEST_LINE) + 1
        if not at:
            # The line is named below.
            return None
    whole = marks = 0
    text = np.frombuffer(data, dtype=np.uint8)
    for begin in range(start, len(data), _PIECE):
        piece = text[begin : begin + _PIECE]
        whole += int(np.count_nonzero(piece == _NEWLINE))
        marks += int(np.count_nonzero(piece == mark[0]))
    end = data.rfind(b"\n", start) + 1 or start
    count = whole + bool(data[end:].strip())
    # A blank line has too few cells, unless there is one cell in each.
    if marks != count * expected or (not expected and _has_blank(data, start)):
        return None
    return Lines(count, False, False, None, end)


def _first_uneven(numbers: NDArray[np.int64], expected: int, line: int) -> tuple[int, int]:
    k = int(np.flatnonzero(numbers != expected)[0])
    return line + k, int(numbers[k])


def _check_lengths(file: Entered, lengths: NDArray[np.int64], line: int) -> None:
    k = int(np.argmax(lengths))
    if lengths[k] > LONGEST_LINE:
        raise RecordingError(
            f"{file.name}: line {line + k} has more than {LONGEST_LINE} characters, which no "
            "recording has: is it of another kind, or without line ends?"
        )


def _check_quotes(file: Entered, text: NDArray[np.uint8], first: int) -> None:
    """Refuse a quote that is not closed: everything after it would be one cell."""
    at = np.flatnonzero(text == _QUOTE)
    if at.size % 2:
        inside = np.cumsum(text == _NEWLINE, dtype=np.int64)[at]
        # Pairs within a line are closed; the last line with an odd number opens the rest.
        lines, numbers = np.unique(inside, return_counts=True)
        odd = lines[numbers % 2 == 1]
        raise RecordingError(
            f"{file.name}: line {first + int(odd[-1])} has a quote that is not closed: close it or "
            "remove it"
        )
    lengths = np.diff(at)[::2]
    if lengths.size and lengths.max() > LONGEST_CELL:
        line = int(np.count_nonzero(text[: at[2 * int(np.argmax(lengths))]] == _NEWLINE))
        raise RecordingError(
            f"{file.name}: a cell of line {first + line} has more than {LONGEST_CELL} characters: "
            "correct that line"
        )


def _has_blank(data: bytes, start: int) -> bool:
    """Whether a line between others is blank."""
    if data.find(b"\n\n", start) >= 0 or data.find(b"\n\r\n", start) >= 0:
        return True
    if data.find(b"\n ", start) < 0 and data.find(b"\n\t", start) < 0:
        return False
    return _BLANK.search(data, start) is not None
