"""The files of an export to Rust."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

import numpy as np

from stribeck.exporters.about import About
from stribeck.exporters.precision import Precision
from stribeck.exporters.program import Program
from stribeck.exporters.templates import template
from stribeck.exporters.vectors import Vectors


def rust_files(
    about: About, program: Program, vectors: Vectors, *, name: str, precision: Precision
) -> Mapping[str, str]:
    """A module with the model as constants and its test, by file name.

    The module needs the crate `stribeck`, without its default features if there is no `std`.
    """
    model = about.model
    effects = [*model.effects, *model.rigid_body]

    def number(x: float) -> str:
        return literal(x, precision)

    text = template("rust", "model.rs.j2").render(
        about=[
            line
            for paragraph in about.lines()
            for line in textwrap.wrap(paragraph, 96, subsequent_indent="    ") or [""]
        ],
        real=precision,
        law=model.core.law,
        by_formula=model.by_formula,
        formulas=[terms.text for terms in model.own],
        effects=[effect for effect in effects if effect != "delay"],
        constants=sorted(model.core.constants.items()),
        parameters=[
            (p.name, p.unit, number(value))
            for p, value in zip(model.parameters, model.values, strict=True)
            if p.name != "delay"
        ],
        torque_unit=model.torque_unit,
        channels=program.channels,
        rows=[[number(x) for x in row] for row in vectors.rows],
        literal=number,
    )
    return {f"{name}.rs": text}


def literal(x: float, precision: Precision) -> str:
    """A number with the fewest digits that read back with the same bits."""
    text = str(np.float32(x)) if precision == "f32" else repr(float(x))
    return text if any(mark in text for mark in ".e") else f"{text}.0"
