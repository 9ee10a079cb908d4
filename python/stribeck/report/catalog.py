"""The catalog of laws and effects as text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from stribeck.report.layout import paragraph
from stribeck.report.numbers import listed, unit_text


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
