"""Export as data: the model and the operations of its step, for other generators."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

from stribeck.exporters.about import About
from stribeck.exporters.c.number import Precision
from stribeck.exporters.program import Program

#: Version of the document's keys.
SCHEMA = 1


def json_files(
    about: About, program: Program, *, name: str, precision: Precision
) -> Mapping[str, str]:
    """One JSON document, by file name.

    ``step`` holds the operations of one step, each a list of its name, the operations that it takes
    its numbers from, and what else it says; an infinite constant is written ``"inf"``.
    """
    model = about.model
    document = {
        "kind": "exported_model",
        "schema": SCHEMA,
        "model": model.spec,
        "formulas": {terms.name: terms.text for terms in model.own},
        "constants": dict(sorted(model.core.constants.items())),
        "torque_unit": model.torque_unit,
        "position_unit": model.position_unit,
        "parameters": [
            {"name": p.name, "symbol": p.symbol, "unit": p.unit, "value": float(value)}
            for p, value in zip(model.parameters, model.values, strict=True)
        ],
        "fitted_on": dict(about.fitted_on),
        "certificate": None if about.certificate is None else about.certificate.to_dict(),
        "step": {
            "precision": precision,
            "operations": [
                [operation.name, list(operation.operands), _said(operation.said)]
                for operation in program.operations
            ],
            "torque": program.torque,
            "states": [
                {"name": s.name, "unit": s.unit, "what": s.what, "after": s.after}
                for s in program.states
            ],
        },
    }
    return {f"{name}.json": json.dumps(document, indent=1, allow_nan=False) + "\n"}


def _said(said: Any) -> Any:
    if isinstance(said, float) and math.isinf(said):
        return "inf" if said > 0.0 else "-inf"
    return said
