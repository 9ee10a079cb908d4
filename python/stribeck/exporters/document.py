"""Export as JSON: the model and the operations of its step, for other generators."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping

from stribeck.exporters.about import About
from stribeck.exporters.precision import Precision
from stribeck.exporters.program import Operation, Program
from stribeck.exporters.rows import Argument

#: Version of the document's keys.
SCHEMA = 1


def json_files(
    about: About, program: Program, *, name: str, precision: Precision
) -> Mapping[str, str]:
    """One JSON document, by file name.

    ``step`` holds the operations of one step, each as a list of name, operands and argument; an
    infinite constant is written ``"inf"``. ``rigid_body_torque`` is the part of the torque that is
    no friction, ``load_torque`` how that input is computed; null where there is none.
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
        "rigid_body_torque": about.rigid_body_torque,
        "load_torque": about.load_to_give,
        "fitted_on": dict(about.fitted_on),
        "certificate": None if about.certificate is None else about.certificate.to_dict(),
        "step": {
            "precision": precision,
            "operations": [
                [operation.name, list(operation.operands), _argument(operation)]
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


def _argument(operation: Operation) -> Argument:
    argument = operation.argument
    if isinstance(argument, float) and math.isinf(argument):
        return "inf" if argument > 0.0 else "-inf"
    return argument
