"""How text is set: paragraphs, tables, bars. No line is wider than `WIDTH`, nor the terminal."""

from __future__ import annotations

import io
import math
import re
import shutil
import sys
import textwrap
from collections.abc import Collection, Iterable, Sequence

from stribeck.report.numbers import change_text, plain

#: Characters of the longest line, and of the shortest that text is still wrapped to.
WIDTH, NARROWEST = 98, 40
BAR = 40
EIGHTHS = " ▏▎▍▌▋▊▉█"

#: A rule below the heading of a table and nothing else, in the notation of rich.
_RULED = "    \n    \n ── \n    \n    \n    \n    \n    \n"


#: Spaces at which no line breaks: between a number and its unit, and within N m.
_TOGETHER = re.compile(r"(?<=\d) (?=(?:N|rad|m|s|Hz|K|J|degC|%)(?:\W|$))|(?<=\bN) (?=m\b)")


def line_width() -> int:
    """Characters of a line: those of the terminal, where stdout is one, and at most `WIDTH`."""
    stream = sys.stdout
    if stream is None or stream.closed or not stream.isatty():
        return WIDTH
    return max(NARROWEST, min(WIDTH, shutil.get_terminal_size().columns))


def paragraph(text: str, indent: int = 2, hang: int = 0) -> str:
    """`text` wrapped to the width, each line indented."""
    first = " " * indent
    filled = textwrap.fill(
        _TOGETHER.sub("\N{NO-BREAK SPACE}", text),
        line_width(),
        initial_indent=first,
        subsequent_indent=first + " " * hang,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return filled.replace("\N{NO-BREAK SPACE}", " ")


def bullets(heading: str, items: Iterable[str], indent: int = 0) -> str:
    """A heading and one bullet an item; nothing where there is no item."""
    lines = [paragraph(f"• {item}", indent + 2, 2) for item in items]
    return "\n".join([" " * indent + heading, *lines]) if lines else ""


def joined(*parts: str) -> str:
    """The parts that say something, with an empty line between them."""
    return "\n\n".join(part for part in parts if part)


def notes_text(*groups: Iterable[str]) -> str:
    """Notes, each once."""
    notes = list(dict.fromkeys(note for group in groups for note in group))
    return "\n".join(paragraph(f"note: {note}", 2, 6) for note in notes)


def table(
    rows: Sequence[Sequence[str]],
    right: Collection[int] = (),
    indent: int = 2,
    whole: Collection[int] = (),
) -> str:
    """Columns lined up below a heading, as plain text.

    Parameters
    ----------
    rows
        The first row is the heading.
    right
        Columns that are set flush right.
    indent
        Spaces before each line.
    whole
        Columns of names, which are never broken into lines.

    Notes
    -----
    In a table that is too wide, the widest of the other columns are broken into lines.
    """
    # Imported here: it takes a tenth of a second that `stribeck --help` need not wait for.
    from rich.box import Box
    from rich.console import Console
    from rich.table import Table

    made = Table(box=Box(_RULED), show_edge=False, pad_edge=False, padding=(0, 1, 0, 0))
    for k, name in enumerate(rows[0]):
        made.add_column(
            name,
            justify="right" if k in right else "left",
            no_wrap=k in right or k in whole,
            overflow="fold",
        )
    for row in rows[1:]:
        made.add_row(*row)
    # Names and numbers are never cut: a terminal that is too narrow for them breaks the lines.
    unbroken = {*right, *whole}
    fewest = _fewest(rows, unbroken)
    most = WIDTH - indent if len(unbroken) < len(rows[0]) else max(WIDTH - indent, fewest)
    out = io.StringIO()
    console = Console(
        file=out,
        width=most,
        color_system=None,
        force_terminal=False,
        force_jupyter=False,
        legacy_windows=False,
        markup=False,
        emoji=False,
        highlight=False,
    )
    console.print(made, width=min(most, max(line_width() - indent, fewest)))
    return "\n".join((" " * indent + line).rstrip() for line in out.getvalue().splitlines())


def _fewest(rows: Sequence[Sequence[str]], unbroken: Collection[int]) -> int:
    """Characters that a table needs so that no word of it is broken."""
    wide = 0
    for k in range(len(rows[0])):
        cells = [row[k] for row in rows]
        words = cells if k in unbroken else [word for cell in cells for word in cell.split()]
        wide += max(map(len, words), default=0) + 2
    return wide


def width_of(text: str) -> int:
    """The length of the longest line."""
    return max(map(len, text.splitlines()), default=0)


def bar(value: float, largest: float, floor: float | None) -> str:
    """A bar of `value`: the part of the noise floor shaded, the rest solid."""
    if not (math.isfinite(value) and largest > 0):
        return ""
    length = BAR * value / largest
    shaded = 0 if floor is None else round(BAR * min(floor, value) / largest)
    whole = int(length)
    rest = EIGHTHS[int(8 * (length - whole))].strip() if whole >= shaded else ""
    return "▒" * shaded + "█" * max(whole - shaded, 0) + rest


def bars_legend(floor: float, unit: str) -> str:
    """What the two shades of a bar mean."""
    return f"▒ noise floor, {plain(floor)} {unit}   █ error above it"


def bars(
    labels: Sequence[str], values: Sequence[float | None], floor: float | None, unit: str
) -> str:
    """One bar a step with its error, and by how much the error fell."""
    known = [v for v in values if v is not None]
    largest = max([*known, floor or 0.0], default=0.0)
    wide = max(len(label) for label in labels)
    lines, before = [], None
    for label, value in zip(labels, values, strict=True):
        if value is None:
            lines.append(f"  {label:<{wide}}  (no held-out error)")
            continue
        change = f"  {change_text(before, value)}" if before else ""
        shape = bar(value, largest, floor)
        lines.append(f"  {label:<{wide}}  {shape:<{BAR}}  {plain(value)} {unit}{change}")
        before = value
    if floor is not None:
        lines.append(f"  {'':<{wide}}  {bars_legend(floor, unit)}")
    return "\n".join(lines)
