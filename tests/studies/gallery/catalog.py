"""What the page says of an effect that follows from the tables alone, not from a fit."""

from __future__ import annotations

import stribeck as sb
from stribeck.effect.describe import base_of
from stribeck.effect.registry import of_catalog
from stribeck.models.catalog import catalog, effect_ids
from stribeck.report.numbers import listed, unit_text
from stribeck.report.pages.equations import CONSTANTS, SYMBOLS, equations
from stribeck.report.pages.mathml import mathml
from stribeck.report.pages.prose import unit

INTRODUCTION = """# Effect gallery

Every effect of the catalog: its physical cause, its equation, what the residual of a model without
it looks like, the motion that shows it, and what it is mistaken for. An effect is a cause, not a
curve: [the loop](loop.md) says how one is accepted, `stribeck effects` prints this catalog, and
`stribeck generate -o LOG.parquet --effect ID` makes a recording in which one is hidden.

The pictures show the residual of the model without the effect (orange) and with it (blue), each
against the channel in which the effect shows: lines are medians, bands hold the middle half of the
samples. Each recording is synthetic, with the sizes of a robot joint; it was made with the formula
of the effect. The gallery therefore shows what an effect looks like, and not how often the
diagnosis is right: for that see [results](results.md).

In the equations an arrow means "becomes". Their symbols are the parameters below each, and:

"""
#: Where a cause lies, by group of the catalog.
GROUPS = {
    "friction": "friction",
    "measurement": "the measurement",
    "actuator": "the actuator",
    "rigid body": "the rigid body",
    "drive": "the drive train",
}


def introduction() -> str:
    """The beginning of the page, with the symbols."""
    symbols = {**SYMBOLS, **CONSTANTS}
    rows = [f"| {_symbol(name)} | {meaning} |" for name, meaning in symbols.items()]
    table = "\n".join(["| symbol | meaning |", "|---|---|", *rows])
    return f"{INTRODUCTION}{table}\n\nIn units T is N m or N, and X is rad or m.\n"


def description(effect: str) -> list[str]:
    """Heading, cause, equation and parameters of an effect, as lines of Markdown."""
    row = catalog()["effects"][effect]
    lines = [
        f"## {effect}",
        "",
        f"**{row['title']}**, a cause in {GROUPS[str(row['group'])]}. {row['what']}",
        "",
        *_equation(effect),
        "",
        "| parameter | symbol | unit | meaning |",
        "|---|---|---|---|",
    ]
    for p in row["parameters"]:
        lines.append(
            f"| `{p['name']}` | {_symbol(p['symbol'])} | {unit(unit_text(p['unit']))} | "
            f"{p['description']} |"
        )
    lines += ["", f"**Needs** {row['needs']}.", *_relations(effect)]
    return lines


def _equation(effect: str) -> list[str]:
    model = sb.model("+".join(["coulomb", *base_of(effect), effect]))
    made = next(one for one in equations(model) if one.name == effect)
    return [f'<p style="overflow-x: auto">{statement}</p>' for statement in made.statements]


def _symbol(name: str) -> str:
    return mathml(name)[0]


def _relations(effect: str) -> list[str]:
    """How the effect is related to others, on any data."""
    said, row = [], of_catalog(effect)
    if row.shown_beside is not None:
        said.append(f"It shows beside [{row.shown_beside}](#{row.shown_beside}), for example.")
    elif base := base_of(effect):
        said.append(f"It goes beyond [{base[0]}](#{base[0]}), which is tried first.")
    if row.part_of is not None:
        said.append(f"It is a special case of [{row.part_of}](#{row.part_of}).")
    inside = [name for name in effect_ids() if of_catalog(name).part_of == effect]
    if inside:
        said.append(f"It contains {listed([f'[{name}](#{name})' for name in inside])}.")
    return ["", " ".join(said)] if said else []
