"""The files of an export to C."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from stribeck.exporters.about import About
from stribeck.exporters.c import elementary
from stribeck.exporters.c.number import FORMATS, Format
from stribeck.exporters.c.statements import Statements
from stribeck.exporters.precision import Precision
from stribeck.exporters.program import Program
from stribeck.exporters.templates import template
from stribeck.exporters.vectors import Vectors
from stribeck.models.model import Model
from stribeck.models.parameter import joint_unit

#: Keywords of C and C++, which cannot be the name of a member.
_KEYWORDS = frozenset(
    """alignas alignof and asm auto bool break case catch char class const constexpr continue
    default delete do double else enum explicit export extern false float for friend goto if inline
    int long mutable namespace new not operator or private protected public register restrict return
    short signed sizeof static struct switch template this throw true try typedef typename union
    unsigned using virtual void volatile while xor""".split()
)

#: Units as in the catalog: T torque or force, X position.
_CHANNEL_UNITS = {
    "velocity": "X/s",
    "position": "X",
    "acceleration": "X/s2",
    "temperature": "degC",
    "temperature_rate": "K/s",
    "load_torque": "T",
    "load_torque_curvature": "T/s2",
    "motor_torque": "T",
    "external_torque": "T",
    "time": "s",
}

#: Functions of math.h, by operation.
_LIBM = {
    "abs": "fabs",
    "exp": "exp",
    "expm1": "expm1",
    "ln": "log",
    "sqrt": "sqrt",
    "cbrt": "cbrt",
    "sin": "sin",
    "cos": "cos",
    "tanh": "tanh",
    "atan": "atan",
    "power": "pow",
}

#: Largest difference of a torque from its test vector with the platform's functions, relative to
#: the largest torque.
_LIBM_TOLERANCE = {"f64": 1e-9, "f32": 1e-3}


@dataclass(frozen=True)
class Member:
    """A member of a struct."""

    name: str
    unit: str
    what: str = ""
    symbol: str = ""
    value: float = 0.0

    @property
    def description(self) -> str:
        """Description that cannot end a comment."""
        return self.what.replace("*/", "* /")


def c_files(
    about: About,
    program: Program,
    vectors: Vectors,
    *,
    name: str,
    precision: Precision,
    libm: bool,
) -> Mapping[str, str]:
    """Header, source, test vectors and self-test, by file name.

    Parameters
    ----------
    name
        A C identifier: files, types and functions begin with it.
    libm
        Use the platform's ``math.h``: smaller, but the bits are the platform's.
    """
    form = FORMATS[precision]
    model = about.model
    parameters = tuple(parameter_members(model))
    shared = {
        "name": name,
        "title": model.spec,
        "real": form.real,
        "lit": form.literal,
        "libm": libm,
        "parameters": parameters,
        "channels": channel_members(model, program),
        "states": state_members(model, program),
        "torque_unit": model.torque_unit,
    }
    body = Statements(program, form, tuple(p.name for p in parameters), function_names(form, libm))
    scale = max(abs(x) for x in vectors.torque) or 1.0

    def render(file: str, **more: object) -> str:
        return template("c", file).render({**shared, **more})

    return {
        f"{name}.h": render("model.h.j2", about=list(wrapped(about.lines()))),
        f"{name}.c": render(
            "model.c.j2",
            elementary=elementary_source(wanted_functions(program), form, libm),
            statements=str(body),
            unused_arguments=list(unused_arguments(program)),
        ),
        f"{name}_vectors.h": render("vectors.h.j2", rows=_Rows(vectors.rows, form)),
        f"{name}_test.c": render(
            "test.c.j2", tolerance=form.literal(_LIBM_TOLERANCE[precision] * scale)
        ),
    }


def identifier(text: str) -> str:
    """A C identifier from a text.

    Examples
    --------
    >>> identifier("coulomb+load")
    'coulomb_load'
    """
    word = re.sub(r"\W+", "_", text, flags=re.ASCII).strip("_") or "model"
    word = f"m_{word}" if word[0].isdigit() else word
    return f"{word}_" if word in _KEYWORDS else word


def channel_members(model: Model, program: Program) -> list[Member]:
    """The channels that a program reads, with their units."""
    return [Member(c, _unit(model, _CHANNEL_UNITS[c])) for c in program.channels]


def state_members(model: Model, program: Program) -> list[Member]:
    """The states of a program, with their units."""
    return [Member(s.name, _unit(model, s.unit), s.what) for s in program.states]


def parameter_members(model: Model) -> Iterator[Member]:
    """The parameters of a model, with their values."""
    for p, value in zip(model.parameters, model.values, strict=True):
        yield Member(identifier(p.name), p.unit, p.description, p.symbol, float(value))


def _unit(model: Model, unit: str) -> str:
    return joint_unit(unit, model.load_unit, model.position_unit)


def function_names(form: Format, libm: bool) -> dict[str, str]:
    """Names of the elementary functions in C, by operation."""
    own = {name: f"elementary_{name}" for name in (*elementary.PARTS, "abs", "sign")}
    own["is_finite"] = "is_finite"
    if libm:
        own |= {name: f"{called}{'f' if form.single else ''}" for name, called in _LIBM.items()}
    return own


def wanted_functions(program: Program) -> set[str]:
    """Names of the operations of a program, and of constants that need a function."""
    functions = set(program.functions)
    if any(o.name == "constant" and math.isinf(o.value) for o in program.operations):
        functions.add("infinity")
    return functions


def elementary_source(functions: set[str], form: Format, libm: bool) -> str:
    """The elementary functions among these, and what they call, in C."""
    known = {*elementary.PARTS, "abs", "sign", "is_finite", "infinity"}
    wanted = (functions - set(_LIBM) if libm else functions) & known
    if not wanted:
        return ""
    context = elementary.context(wanted, form)
    context["libm"] = libm
    return template("c", "elementary.c.j2").render(context)


def unused_arguments(program: Program) -> Iterator[str]:
    """Arguments of the step that a program does not use."""
    names = program.functions
    if "parameter" not in names:
        yield "parameters"
    if not program.states:
        yield "state"
    if not program.channels:
        yield "sample"
    if "time_step" not in names:
        yield "dt"


def wrapped(lines: Iterator[str]) -> Iterator[str]:
    """Lines wrapped for a comment; none of them ends it."""
    for line in lines:
        yield from textwrap.wrap(line.replace("*/", "* /"), 96, subsequent_indent="    ") or [""]


class _Rows(list[list[str]]):
    """Rows of numbers as literals in C."""

    def __init__(self, rows: list[list[float]], form: Format) -> None:
        super().__init__([form.literal(x).strip("()") for x in row] for row in rows)
