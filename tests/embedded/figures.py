"""The figures of a step: the table that is kept, and what they are held against."""

from __future__ import annotations

import re
from dataclasses import astuple, dataclass
from pathlib import Path

TABLE = Path(__file__).resolve().parent / "table.md"
HEADER = """\
| law | processor | numbers | instructions, mean | instructions, most | stack, bytes | code, bytes |
|---|---|---|---|---|---|---|
"""
# More than this above the table is a regression.
MARGIN = 0.05
# The timer counts in ticks of 0.6 to 1 instruction, so one more or less is not seen.
RESOLUTION = 1
# Largest mean and largest number of instructions, whatever the table says.
BARS = {
    ("lugre_squared", "Cortex-M4F"): (120, 150),
    ("lugre", "Cortex-M4F"): (260, 280),
    ("tadese_full", "Cortex-M4F"): (280, 310),
    ("bittencourt_a", "Cortex-M4F"): (200, 220),
    ("bittencourt_a_squared", "Cortex-M4F"): (60, 80),
    ("lugre_squared", "Cortex-M7"): (160, 180),
    ("robot_feedforward", "Cortex-M7"): (12_000, 12_000),
}


@dataclass(frozen=True)
class Figures:
    """What one step takes."""

    mean: int
    largest: int
    stack: int
    code: int


Key = tuple[str, str, str]


def text(figures: dict[Key, Figures]) -> str:
    """The table."""
    rows = (
        f"| {' | '.join(key)} | {' | '.join(map(str, astuple(taken)))} |\n"
        for key, taken in figures.items()
    )
    return HEADER + "".join(rows)


def kept() -> dict[Key, Figures]:
    """The figures of the table that is kept."""
    found = {}
    for row in TABLE.read_text().splitlines()[2:]:
        law, processor, number, *taken = re.split(r" *\| *", row.strip("| "))
        found[law, processor, number] = Figures(*map(int, taken))
    return found


def worse(figures: dict[Key, Figures], before: dict[Key, Figures]) -> list[str]:
    """One sentence for each figure that is too large."""
    sentences = []
    for (law, processor, number), now in figures.items():
        bar = BARS.get((law, processor))
        if bar is not None and (now.mean > bar[0] or now.largest > bar[1]):
            sentences.append(
                f"{law} on {processor} takes {now.mean} instructions, at most {now.largest}: "
                f"the bars are {bar[0]} and {bar[1]}"
            )
        old = before.get((law, processor, number))
        if old is None:
            sentences.append(f"{law} on {processor} is not in {TABLE.name}")
            continue
        for name in ("mean", "largest", "stack", "code"):
            was, is_now = getattr(old, name), getattr(now, name)
            if is_now > was * (1 + MARGIN) + RESOLUTION:
                sentences.append(f"{law} on {processor}: {name} has grown from {was} to {is_now}")
    return sentences
