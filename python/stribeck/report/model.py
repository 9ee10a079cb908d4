"""A model with its values, and what was exported of it, as text."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from stribeck.report.layout import joined, table
from stribeck.report.numbers import plain, unit_text

if TYPE_CHECKING:
    from stribeck.exporters.export import Export
    from stribeck.models.model import Model


def model_text(model: Model) -> str:
    """The spec, and each parameter with its value."""
    rows = [["parameter", "symbol", "value", "unit"]]
    rows += [
        [p.name, p.symbol, "not known" if math.isnan(value) else plain(value), unit_text(p.unit)]
        for p, value in zip(model.parameters, model.values, strict=True)
    ]
    return joined(model.spec, table(rows, right=[2])) if len(rows) > 1 else model.spec


def export_text(export: Export) -> str:
    """The model, then one line a file."""
    head = f"{export.model.spec} in {export.language}, {export.precision}"
    return "\n".join([head, *(f"  {path}" for path in export.files)])
