"""Files of a reproduction: a self-contained page, figures, and the rows as tables."""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence
from pathlib import Path

from stribeck.base.errors import StribeckError
from stribeck.base.files import png_bytes, write_bytes_whole, write_whole
from stribeck.base.replaceable import check_own
from stribeck.benchmark.reproduce.result import Reproduction
from stribeck.benchmark.reproduce.text import HEADING, cells, reasons, verdict
from stribeck.report.pages.recording import render


def reproduction_page(made: Reproduction, drawn: Sequence[bytes]) -> str:
    """One HTML file without references: numbers, reasons, and the figures as PNG."""
    return render(
        "reproduction.html",
        made=made,
        heading=HEADING,
        rows=[(cells(row), row.within, row.why) for row in made.rows],
        verdict=verdict(made),
        reasons=reasons(made.rows),
        pictures=[
            (p.where, p.caption, base64.b64encode(png).decode("ascii"))
            for p, png in zip(made.pictures, drawn, strict=True)
        ],
    )


def write_reproduction(made: Reproduction, folder: str | Path) -> list[str]:
    """Write ``PAPER.html``, ``rows.csv``, ``rows.json`` and the figures to a folder.

    Files of the same names that stribeck did not write are refused before anything is written.

    Returns
    -------
    list of str
        Paths of the figures.
    """
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    drawn = [png_bytes(picture.figure) for picture in made.pictures]
    figures = [str(target / f"{made.paper}_{picture.name}.png") for picture in made.pictures]
    texts = {
        "rows.csv": made.to_frame().write_csv(),
        "rows.json": json.dumps(made.to_dict(figures), indent=2) + "\n",
        f"{made.paper}.html": reproduction_page(made, drawn),
    }
    for name, text in texts.items():
        check_own(target / name, text, StribeckError)
    for path, png in zip(figures, drawn, strict=True):
        write_bytes_whole(path, png)
    for name, text in texts.items():
        write_whole(target / name, text)
    return figures
