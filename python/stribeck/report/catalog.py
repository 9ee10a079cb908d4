"""The catalog of laws and effects as text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from stribeck.report.layout import joined, paragraph, table
from stribeck.report.numbers import listed, plain, unit_text
from stribeck.report.text_plot import MARKS, text_plot

if TYPE_CHECKING:
    from stribeck.models.model import Model
    from stribeck.models.rows import EffectRow, LawRow, ParameterRow
    from stribeck.report.effect_example import EffectExample
    from stribeck.report.law_curve import LawCurve


def catalog_text(rows: Iterable[Mapping[str, object]], last: str) -> str:
    """Laws or effects, one paragraph each; `last` names the key that ends it."""
    lines = []
    for row in rows:
        lines.append(f"{row['id']}: {row['title']}")
        source = row["source"] if "source" in row else row["group"]
        lines.append(paragraph(f"{row['formula']}  [{source}]", 4, 2))
        if "what" in row:
            lines.append(paragraph(str(row["what"]), 4))
        lines.append(paragraph(f"parameters: {_parameters(row['parameters'])}", 4, 2))
        lines.append(paragraph(f"{last}: {_said(row[last])}", 4, 2))
    lines.append("Units: T is N m or N, X is rad or m.")
    return "\n".join(lines)


def _parameters(rows: object) -> str:
    assert isinstance(rows, list | tuple)
    return ", ".join(f"{p['name']} ({p['symbol']}, {unit_text(p['unit'])})" for p in rows)


def _said(value: object) -> str:
    return listed([str(v) for v in value]) if isinstance(value, list | tuple) else str(value)


def law_text(row: LawRow, curve: LawCurve) -> str:
    """One law: formula, source, parameters, what it captures, and its friction over velocity."""
    drawn = [(curve.velocity, friction) for _, friction in curve.curves]
    axes = f"velocity [{curve.model.position_unit}/s]", f"friction [{curve.model.torque_unit}]"
    held = ", ".join(
        f"{MARKS[k]} {one.said}" for k, (one, _) in enumerate(curve.curves) if one.said
    )
    sweep = ", swept slowly back and forth" if curve.model.has_state else ""
    reads = ", ".join(name for name in row["channels"]) if row["channels"] else ""
    return joined(
        f"{row['id']}: {row['title']}",
        "\n".join(
            [
                paragraph(row["formula"], 2, 2),
                paragraph(f"Source: {row['source']}.", 2),
                paragraph(f"Captures: {_said(row['captures'])}.", 2),
                *([paragraph(f"Reads besides velocity: {reads}.", 2)] if reads else []),
            ]
        ),
        _parameter_table(row["parameters"], curve.model),
        paragraph(f"Friction over velocity at these values{sweep}{': ' if held else ''}{held}"),
        text_plot(drawn, *axes),
        paragraph(
            f"Fit it: stribeck fit DATA {row['id']}; this curve as a figure: stribeck models "
            f"{row['id']} -o FILE.svg",
            2,
        ),
    )


def effect_text(row: EffectRow, example: EffectExample) -> str:
    """One effect: cause, formula, needs, parameters, and the residual of a model without it."""
    view = example.view
    without = view.without
    shown = (without.at, without.median) if without.at.size else (view.x, without.samples)
    return joined(
        f"{row['id']}: {row['title']}",
        "\n".join(
            [
                paragraph(row["what"], 2),
                paragraph(row["formula"], 2, 2),
                paragraph(f"Cause: {row['group']}.", 2),
                paragraph(f"A recording shows it with: {row['needs']}.", 2),
            ]
        ),
        _parameter_table(row["parameters"], example.with_it.model),
        paragraph("What a model without it leaves, on a generated recording with these values:"),
        text_plot([shown], view.x_label, view.y_label, log=view.log),
        paragraph(
            f"Add it: stribeck add DATA MODEL {row['id']}; as a figure: stribeck effects "
            f"{row['id']} -o FILE.svg",
            2,
        ),
    )


def _parameter_table(rows: Iterable[ParameterRow], model: Model) -> str:
    """Parameters with units, bounds, and the values that are drawn."""
    cells = [["parameter", "symbol", "unit", "bounds of a fit", "here", "meaning"]]
    units = {p.name: p.unit for p in model.parameters}
    for row in rows:
        scale = "" if row["scale"] == "none" else f" x {row['scale'].replace('_', ' ')}"
        known = row["name"] in units
        cells.append(
            [
                row["name"],
                row["symbol"],
                unit_text(units.get(row["name"], row["unit"])),
                f"{row['lower']:.7g} .. {row['upper']:.7g}{scale}",
                plain(model.value(row["name"])) if known else "",
                row["description"].rstrip("."),
            ]
        )
    note = (
        "Bounds of a fit are multiples of the scale that the recording has: of its torque, speed, "
        "torque per speed (damping) or torque per position (stiffness)."
    )
    return joined(table(cells, right=(4,), whole=(0, 1)), paragraph(note))
