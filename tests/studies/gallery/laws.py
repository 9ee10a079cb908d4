"""Write docs/law_catalog.md: every law with its equation, source and parameters, from the tables.

python tests/studies/gallery/laws.py
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import stribeck as sb
from stribeck.models.catalog import catalog, effect_ids
from stribeck.report.numbers import listed, unit_text
from stribeck.report.pages.equations import SYMBOLS, equations
from stribeck.report.pages.mathml import mathml
from stribeck.report.pages.prose import unit

PAGE = Path(__file__).resolve().parents[3] / "docs/law_catalog.md"
INTRODUCTION = """# Catalog of laws

Every friction law of the package with its equation, where it is printed, its parameters and what
it contains: these [effects](effects.md) are refused as additions. `stribeck models` prints this
catalog, and `stribeck models ID` one law with its curve. [Laws and effects](laws.md) says how to
choose one, and how to write one by formula.

In units T is N m or N, and X is rad or m. Symbols that are no parameters:

"""


def page() -> str:
    """The page."""
    symbols = [f"| {mathml(name)[0]} | {meaning} |" for name, meaning in SYMBOLS.items()]
    parts = [INTRODUCTION + "\n".join(["| symbol | meaning |", "|---|---|", *symbols]), ""]
    for law, row in catalog()["laws"].items():
        parts += section(str(law), row)
    return "\n".join(parts)


def section(law: str, row: Mapping[str, object]) -> list[str]:
    """The part of the page on one law."""
    (made,) = (one for one in equations(sb.model(law)) if one.name == law)
    lines = [
        f"## {law}",
        "",
        f"**{row['title']}** ({row['source']}).",
        "",
        *(f'<p style="overflow-x: auto">{statement}</p>' for statement in made.statements),
        "",
        "| parameter | symbol | unit | meaning |",
        "|---|---|---|---|",
    ]
    parameters = row["parameters"]
    assert isinstance(parameters, list | tuple)
    for p in parameters:
        lines.append(
            f"| `{p['name']}` | {mathml(p['symbol'])[0]} | {unit(unit_text(p['unit']))} | "
            f"{p['description']} |"
        )
    contained = row["captures"]
    assert isinstance(contained, list | tuple)
    if contained:
        known = effect_ids()
        names = [f"[{x}](effects.md#{x})" if x in known else str(x) for x in contained]
        lines += ["", f"**Contains** {listed(names)}."]
    return [*lines, ""]


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
