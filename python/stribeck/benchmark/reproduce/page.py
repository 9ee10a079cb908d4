"""Files of a reproduction: a self-contained page, figures, and the rows as tables."""

from __future__ import annotations

import json
from pathlib import Path

from stribeck.base.files import save_figure, write_whole
from stribeck.benchmark.reproduce.result import Reproduction
from stribeck.benchmark.reproduce.text import HEADING, cells, reasons, verdict
from stribeck.report.page import picture_text, render


def reproduction_page(made: Reproduction) -> str:
    """One HTML file without references: numbers, reasons, figures."""
    return render(
        "reproduction.html",
        made=made,
        heading=HEADING,
        rows=[(cells(row), row.within, row.why) for row in made.rows],
        verdict=verdict(made),
        reasons=reasons(made.rows),
        pictures=[(p.where, p.caption, picture_text(p.figure)) for p in made.pictures],
    )


def write_reproduction(made: Reproduction, folder: str | Path) -> list[str]:
    """Write ``PAPER.html``, ``rows.csv``, ``rows.json`` and the figures to a folder.

    Returns
    -------
    list of str
        Paths of the figures.
    """
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    figures = []
    for picture in made.pictures:
        path = str(target / f"{made.paper}_{picture.name}.png")
        save_figure(picture.figure, path)
        figures.append(path)
    write_whole(target / "rows.csv", made.to_frame().write_csv())
    write_whole(target / "rows.json", json.dumps(made.to_dict(figures), indent=2) + "\n")
    write_whole(target / f"{made.paper}.html", reproduction_page(made))
    return figures
