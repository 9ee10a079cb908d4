"""The files of a robot in C."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from stribeck.exporters.c.files import (
    Member,
    channel_members,
    elementary_source,
    function_names,
    identifier,
    parameter_members,
    state_members,
    unused_arguments,
    wanted_functions,
    wrapped,
)
from stribeck.exporters.c.number import FORMATS, Format
from stribeck.exporters.c.statements import Statements
from stribeck.exporters.robot.joints import OF_MOTION, Joints
from stribeck.exporters.robot.vectors import RobotVectors
from stribeck.exporters.templates import template

#: Structs of every robot.
_STRUCTS = frozenset({"link", "parameters", "sample", "state"})


@dataclass(frozen=True)
class Law:
    """The friction of one or more joints: the same step, with other values.

    Attributes
    ----------
    name
        Type and function are named after it.
    spec
        The model.
    parameters, states
        Members of the structs.
    statements
        The body of the step.
    unused
        Arguments that it does not use.
    """

    name: str
    spec: str
    parameters: tuple[Member, ...]
    states: tuple[Member, ...]
    statements: str
    unused: tuple[str, ...]


def robot_c_files(joints: Joints, vectors: RobotVectors, *, name: str) -> Mapping[str, str]:
    """Header, source, test vectors and self-test, by file name.

    Parameters
    ----------
    name
        A C identifier: files, types and functions begin with it.
    """
    form = FORMATS[joints.precision]
    laws, of_joint = _laws(joints, form)
    functions = {"sin_cos"}
    for program in joints.programs:
        functions |= wanted_functions(program)
    shared = {
        "name": name,
        "title": joints.robot.name,
        "real": form.real,
        "lit": form.literal,
        "numbers": lambda row: ", ".join(form.literal(x) for x in row),
        "joints": joints.robot.joints,
        "gravity": joints.robot.gravity,
        "turns": joints.robot.coupling,
        "inverse": joints.robot.core.joints_per_motor,
        "values": [model.values for model in joints.friction],
        "laws": laws,
        "of_joint": list(enumerate(of_joint, start=1)),
        "states": any(law.states for law in laws),
        "given": _given(joints),
        "channels": [*OF_MOTION[:3], *joints.given],
        "read": joints.channels,
    }

    def render(file: str, **more: object) -> str:
        return template("c", file).render({**shared, **more})

    return {
        f"{name}.h": render("robot.h.j2", about=list(wrapped(joints.about()))),
        f"{name}.c": render("robot.c.j2", elementary=elementary_source(functions, form, False)),
        f"{name}_vectors.h": render("robot_vectors.h.j2", rows=_rows(vectors, form)),
        f"{name}_test.c": render("robot_test.c.j2"),
    }


def _given(joints: Joints) -> list[Member]:
    """The channels that a caller gives in addition to the motion."""
    found: dict[str, Member] = {}
    for model, program in zip(joints.friction, joints.programs, strict=True):
        for member in channel_members(model, program):
            found.setdefault(member.name, member)
    return [found[channel] for channel in joints.given]


def _laws(joints: Joints, form: Format) -> tuple[list[Law], list[Law]]:
    """The different laws, and the law of each joint."""
    laws: dict[tuple[object, ...], Law] = {}
    of_joint = []
    for model, program in zip(joints.friction, joints.programs, strict=True):
        parameters = tuple(parameter_members(model))
        names = tuple(p.name for p in parameters)
        statements = str(Statements(program, form, names, function_names(form, libm=False)))
        key = (statements, names, tuple(p.unit for p in parameters))
        if key not in laws:
            taken = _STRUCTS | {law.name for law in laws.values()}
            laws[key] = Law(
                name=_unique(identifier(model.spec), taken),
                spec=model.spec,
                parameters=parameters,
                states=tuple(state_members(model, program)),
                statements=statements,
                unused=tuple(unused_arguments(program)),
            )
        of_joint.append(laws[key])
    return list(laws.values()), of_joint


def _unique(name: str, taken: frozenset[str]) -> str:
    """A name that is not taken, by a number."""
    if name not in taken:
        return name
    return next(f"{name}_{k}" for k in range(2, len(taken) + 3) if f"{name}_{k}" not in taken)


def _rows(vectors: RobotVectors, form: Format) -> list[list[str]]:
    return [[form.literal(x).strip("()") for x in row] for row in vectors.rows]
