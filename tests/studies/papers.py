"""Write docs/papers.md and its pictures: the five papers, repeated.

python tests/studies/papers.py [PAPER...]

Without names, all papers are repeated and the page is written; with names, their pictures alone.
"""

from __future__ import annotations

import sys
from io import BytesIO
from pathlib import Path

from PIL import Image
from stribeck.benchmark.reproduce.papers import PAPERS, reproduce
from stribeck.benchmark.reproduce.result import Reproduction, Row
from stribeck.benchmark.reproduce.text import HEADING, cells, reasons, verdict

DOCS = Path(__file__).resolve().parents[2] / "docs"
#: Dots per inch and colours of the pictures, and rows of a table beside those that miss.
DPI, COLOURS, MOST_ROWS = 66, 256, 45
INTRODUCTION = """# Papers, repeated

`stribeck reproduce PAPER` repeats the tables and figures of the five papers that the catalog and
the methods come from, by the package's own commands, and sets the printed numbers beside ours. Each
number has a tolerance with its reason. A number outside is listed as a miss. None of the papers
publishes its measurements: what stands in for them is said first. `-o DIR` writes a page with the
figures, and all rows as CSV and JSON.

This page is written by `python3 develop.py papers`.
"""


def line(row: Row) -> str:
    """A row of the table."""
    return "| " + " | ".join(text.replace("|", "\\|") for text in cells(row)) + " |"


def rows_of(made: Reproduction) -> list[str]:
    """The table: every miss, and the first of the others."""
    met = [row for row in made.rows if row.within][:MOST_ROWS]
    shown = [row for row in made.rows if not row.within or row in met]
    lines = ["| " + " | ".join(HEADING) + " |", "|" + "---|" * 4 + "---:|" * 4, *map(line, shown)]
    left = len(made.rows) - len(shown)
    if left:
        lines += ["", f"{left} more numbers are within their tolerances; the command prints them."]
    return lines


def section(made: Reproduction) -> list[str]:
    """The part of the page on one paper."""
    pictures = [
        f"![{p.where}](papers/{made.paper}_{p.name}.png)\n\n*{p.where}*: {p.caption}\n"
        for p in made.pictures
    ]
    left_out = [f"- {text}" for text in made.left_out]
    return [
        f"## {made.title}",
        "",
        f"`stribeck reproduce {made.paper}` ({made.source}): **{verdict(made)}**.",
        "",
        *(f"- {text}" for text in made.data),
        "",
        *pictures,
        *rows_of(made),
        "",
        "Tolerances:",
        "",
        *(f"- {reason}" for reason in reasons(made.rows)),
        "",
        "Without a counterpart:",
        "",
        *left_out,
        "",
    ]


def draw(made: Reproduction) -> None:
    """Write the pictures, small: few dots, few colours."""
    for picture in made.pictures:
        whole = BytesIO()
        picture.figure.savefig(whole, dpi=DPI)
        path = DOCS / "papers" / f"{made.paper}_{picture.name}.png"
        Image.open(whole).convert("RGB").quantize(COLOURS).save(path, optimize=True)


def main() -> None:
    """Repeat the papers."""
    named = sys.argv[1:]
    parts = [INTRODUCTION]
    for paper in named or PAPERS:
        made = reproduce(paper)
        draw(made)
        parts += section(made)
        print(f"{paper}: {verdict(made)}")
    if not named:
        (DOCS / "papers.md").write_text("\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    main()
