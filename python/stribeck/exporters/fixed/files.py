"""The files of an export to C in fixed point."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from stribeck.exporters.about import About
from stribeck.exporters.c.files import channel_members, wrapped
from stribeck.exporters.fixed.analysis import Analysis
from stribeck.exporters.fixed.statements import Statements
from stribeck.exporters.precision import FixedPrecision
from stribeck.exporters.program import Program
from stribeck.exporters.templates import template
from stribeck.models.channels import ChannelArguments
from stribeck.passivity.operating_box import operating_box

#: Samples of a test vector file.
ROWS = 500


def analyse(
    about: About,
    program: Program,
    box: Mapping[str, tuple[float, float]],
    precision: FixedPrecision,
) -> Analysis:
    """Formats and error bounds over the operating box.

    Raises
    ------
    SpecError
        A channel without a range, or a model whose error has no bound.
    """
    model = about.model
    sides = operating_box(model, box)
    bits = 32 if precision == "q31" else 16
    return Analysis(program, [float(x) for x in model.values], sides, bits, model.spec)


def fixed_files(
    about: About, analysis: Analysis, *, name: str, precision: FixedPrecision, seed: int
) -> Mapping[str, str]:
    """Header, source, test vectors and self-test, by file name."""
    statements = Statements(analysis)
    program, model = analysis.program, about.model
    channels = [
        (member, analysis.numbers[_place(program, member.name)], analysis.box[member.name])
        for member in channel_members(model, program)
    ]
    torque = analysis.torque
    shared = {
        "name": name,
        "title": model.spec,
        "word": statements.word,
        "wide": statements.wide,
        "bits": analysis.bits,
        "precision": precision,
        "channels": channels,
        "torque": torque,
        "torque_unit": model.torque_unit,
        "about": list(wrapped(about.lines())),
        "tables": statements.tables,
        "lines": statements.lines,
        "rows": _rows(about, analysis, seed),
        "most_wrong": int(np.ceil(torque.error / torque.step)) + 1,
    }
    files = ("model.h", "model.c", "vectors.h", "test.c")
    called = (f"{name}.h", f"{name}.c", f"{name}_vectors.h", f"{name}_test.c")
    return {
        own: template("fixed", f"{file}.j2").render(shared)
        for own, file in zip(called, files, strict=True)
    }


def _place(program: Program, channel: str) -> int:
    return next(k for k, o in enumerate(program.operations) if o.argument == channel)


def _rows(about: About, analysis: Analysis, seed: int) -> Sequence[Sequence[int]]:
    """Random samples in the box and the nearest torque, all as whole numbers."""
    rng = np.random.default_rng(seed)
    program = analysis.program
    given = {}
    for channel in program.channels:
        number = analysis.numbers[_place(program, channel)]
        low, high = (np.trunc(np.ldexp(x, number.digits)) for x in analysis.box[channel])
        given[channel] = rng.integers(int(low), int(high), ROWS, endpoint=True), number.digits
    columns: ChannelArguments = {
        name: np.ldexp(x.astype(np.float64), -digits) for name, (x, digits) in given.items()
    }
    model = about.model.without_effect("delay")
    velocity = columns.pop("velocity", np.zeros(ROWS))
    values = model.known_values()
    torque = np.asarray(model.core.torque(values, None, velocity, **columns))
    wanted = np.rint(np.ldexp(torque, analysis.torque.digits)).astype(np.int64)
    whole = [x for x, _ in given.values()]
    return [[int(x) for x in row] for row in zip(*whole, wanted, strict=True)]
