"""Write docs/effects.md and its pictures: every effect, from the tables and from recordings.

python tests/studies/gallery/page.py [EFFECT...]

Without names, all effects are shown and the page is written; with names, their pictures alone.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from io import BytesIO
from pathlib import Path

from catalog import description, introduction
from example import RATE, SECONDS, SEEDS, Example, example
from PIL import Image
from poor import obstacles
from stribeck.effect.base import Obstacle
from stribeck.effect.describe import base_of
from stribeck.models.catalog import effect_ids
from stribeck.report.numbers import listed, plain

DOCS = Path(__file__).resolve().parents[3] / "docs"
#: Dots per inch and colours of the pictures.
DPI, COLOURS = 100, 48
#: Effects that are named as hard to tell apart; in the overview those of several recordings.
MOST_NAMED, FEWEST = 5, 2


def main() -> None:
    """Show the effects."""
    named = sys.argv[1:]
    needed, real = obstacles(), found_in_measurements()
    examples = []
    for effect in named or effect_ids():
        made = example(effect)
        draw(made)
        examples.append(made)
        print(f"{effect}: first in {made.first} of {len(SEEDS)}")
    if not named:
        parts = [introduction(), *overview(examples), ""]
        for made in examples:
            parts += section(made, needed.get(made.effect, []), real.get(made.effect, []))
        (DOCS / "effects.md").write_text("\n".join(parts), encoding="utf-8")


def overview(examples: list[Example]) -> list[str]:
    """The table of all effects."""
    lines = [
        f"Each effect was hidden in {len(SEEDS)} recordings of {SECONDS:g} s at {RATE:g} Hz (seeds "
        f"{SEEDS[0]} to {SEEDS[-1]}) and looked for with `diagnose`, from `coulomb` and the effect "
        "that it goes beyond, if there is one. `python3 develop.py gallery` writes this page.",
        "",
        "| effect | named first, or tied with the first | indistinguishable from | "
        "lowers the error too as long as it is missing |",
        "|---|---|---|---|",
    ]
    for made in examples:
        cells = [", ".join(links(most(of))) for of in (made.ties, made.instead)]
        lines.append(
            f"| [{made.effect}](#{made.effect}) | {made.first} of {len(SEEDS)} | "
            f"{' | '.join(cells)} |"
        )
    return lines


def section(made: Example, needed: list[Obstacle], real: list[str]) -> list[str]:
    """The part of the page on one effect."""
    before, after, noise = made.errors
    base = "+".join(["coulomb", *base_of(made.effect)])
    lines = [
        *description(made.effect),
        "",
        f"![Residual of {base} without and with {made.effect}](effects/{made.effect}.png)",
        "",
        f"**In this recording:** {made.where}. With {made.effect} the held-out error of `{base}` "
        f"falls from {plain(before)} to {plain(after)} {made.unit}; the noise is {plain(noise)} "
        f"{made.unit}.",
        "",
        *told_apart(made),
    ]
    if real:
        lines += [
            "",
            f"**Real examples:** {listed(real)} ([results](results.md)).",
        ]
    if needed:
        lines += ["", "| a recording cannot show it if | then |", "|---|---|"]
        lines += [f"| {row.why} | {row.do} |" for row in needed]
    return [*lines, ""]


def told_apart(made: Example) -> list[str]:
    """What the effect is mistaken for, in a sentence or two."""
    total = len(SEEDS)
    text = f"**Told apart:** named first, or tied with the first, in {made.first} of {total}."
    if made.ties:
        rivals = links(most(made.ties, least=1), total)
        text += f" Indistinguishable from {listed(rivals)}."
    if made.instead:
        rivals = links(most(made.instead, least=1), total)
        text += f" Lowers the error too as long as it is missing: {listed(rivals)}."
    if not made.ties and not made.instead:
        text += " No other effect passes the tests in its place."
    return [text]


def most(counts: Counter[str], least: int = FEWEST) -> list[tuple[str, int]]:
    """The effects that occur most often, in catalog order where as often."""
    order = {name: k for k, name in enumerate(effect_ids())}
    rows = [(name, count) for name, count in counts.items() if count >= least]
    return sorted(rows, key=lambda row: (-row[1], order[row[0]]))[:MOST_NAMED]


def links(rows: list[tuple[str, int]], total: int | None = None) -> list[str]:
    """Effects as links, with their counts out of `total`."""
    if total is None:
        return [f"[{name}](#{name})" for name, _ in rows]
    return [f"[{name}](#{name}) (in {count} of {total})" for name, count in rows]


def found_in_measurements() -> dict[str, list[str]]:
    """For each effect the real recordings on which it was found: a row of docs/results.md each."""
    found: dict[str, list[str]] = {}
    table = (
        (DOCS / "results.md").read_text(encoding="utf-8").split("| recording | effects found")[1]
    )
    for row in re.findall(r"^\| (.+?) \| (.+?) \|", table.split("\n\n")[0], re.M):
        for step in row[1].split(", then "):
            if step.split()[0] in effect_ids():
                found.setdefault(step.split()[0], []).append(row[0])
    return found


def draw(made: Example) -> None:
    """Write the picture, small: few dots, few colours."""
    assert made.figure is not None
    whole = BytesIO()
    made.figure.savefig(whole, dpi=DPI)
    path = DOCS / "effects" / f"{made.effect}.png"
    path.parent.mkdir(exist_ok=True)
    Image.open(whole).convert("RGB").quantize(COLOURS).save(path, optimize=True)


if __name__ == "__main__":
    main()
