"""Actions as forms send them: a name and fields of text."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Mapping

from stribeck.base.errors import SpecError, nearest
from stribeck.passivity.operating_box import parse_sides
from stribeck.recording.stated.options import TABLE, ReadOptions
from stribeck.report.workbench.actions import Limits
from stribeck.report.workbench.controller import Workbench

#: Fields of a form: each name with its texts.
Fields = Mapping[str, list[str]]


def act(bench: Workbench, name: str, fields: Fields) -> None:
    """Do the action of a form.

    Raises
    ------
    StribeckError
        There is no such action, a field is missing or wrong, or it cannot be done.
    """
    if name not in ACTIONS:
        raise SpecError(f"there is no action {name!r}{nearest(name, tuple(ACTIONS))}")
    ACTIONS[name](bench, fields)


def text(fields: Fields, name: str) -> str:
    """The text of a field, without spaces around it.

    Raises
    ------
    SpecError
        It is missing or empty.
    """
    said = " ".join(fields.get(name, [])).strip()
    if not said:
        raise SpecError(f"the field {name!r} is empty: fill it in")
    return said


def number(fields: Fields, name: str) -> float:
    """The number of a field."""
    said = text(fields, name)
    try:
        return float(said)
    except ValueError:
        raise SpecError(f"the field {name!r} is {said!r}: give a number") from None


def words(fields: Fields, name: str) -> tuple[str, ...]:
    """The words of a field, which may be ticked or typed with commas."""
    parts = ",".join(fields.get(name, [])).split(",")
    return tuple(dict.fromkeys(part.strip() for part in parts if part.strip()))


def lines(fields: Fields, name: str) -> list[str]:
    """The lines of a field."""
    return [
        line.strip() for said in fields.get(name, []) for line in said.splitlines() if line.strip()
    ]


def paths(said: str) -> list[str]:
    """The paths of a text: one, or several with spaces between them."""
    if os.path.exists(said):
        return [said]
    try:
        return shlex.split(said)
    except ValueError as error:
        raise SpecError(f"{said}: these paths cannot be told apart: {error}") from None


def ticked(fields: Fields, name: str) -> list[str]:
    """What is ticked."""
    if not fields.get(name):
        raise SpecError(f"no {name} is ticked: tick at least one")
    return list(fields[name])


def options_of(fields: Fields) -> ReadOptions:
    """The options of reading, from a form with a field for each that is given."""
    given: dict[str, object] = {}
    for entry in TABLE:
        said = "\n".join(fields.get(entry.name, [])).strip()
        if not said:
            continue
        if entry.kind == "number":
            given[entry.name] = number(fields, entry.name)
        elif entry.kind == "pairs":
            given[entry.name] = tuple(lines(fields, entry.name))
        elif entry.kind == "switch":
            given[entry.name] = True
        else:
            given[entry.name] = said
    return ReadOptions.of(given)


def with_option(options: ReadOptions, name: str, value: str) -> ReadOptions:
    """The options with one more, as a proposal or the remedy of a check names it.

    Of pairs, one with the same left side is replaced.
    """
    entry = next((entry for entry in TABLE if entry.name == name), None)
    if entry is None:
        raise SpecError(f"there is no option {name!r}")
    given: dict[str, object] = dict(options.given())
    if entry.kind == "pairs":
        # Units name the column on their left, which may hold an equals sign.
        left = value.rpartition("=")[0] if name == "unit" else value.partition("=")[0]
        kept = [f"{k}={v}" for k, v in options.pairs(name).items() if k != left.strip()]
        given[name] = (*kept, value)
    elif entry.kind == "switch":
        given[name] = True
    else:
        given[name] = number({name: [value]}, name) if entry.kind == "number" else value
    return ReadOptions.of(given)


def _apply(bench: Workbench, fields: Fields) -> None:
    value = " ".join(fields.get("value", []))
    bench.read(with_option(bench.joint.options, text(fields, "option"), value))


def _plan(bench: Workbench, fields: Fields) -> None:
    limits = Limits(
        (number(fields, "lowest position"), number(fields, "highest position")),
        number(fields, "speed"),
        number(fields, "acceleration"),
        number(fields, "duration"),
        words(fields, "show"),
        words(fields, "separate"),
    )
    bench.plan(limits)


def _reject(bench: Workbench, fields: Fields) -> None:
    bench.reject(text(fields, "effect"), " ".join(fields.get("why", [])).strip())


ACTIONS: dict[str, Callable[[Workbench, Fields], None]] = {
    "open": lambda bench, f: bench.open(*paths(text(f, "path"))),
    "open together": lambda bench, f: bench.open(*ticked(f, "file")),
    "choose": lambda bench, f: bench.choose(int(number(f, "number"))),
    "read": lambda bench, f: bench.read(options_of(f)),
    "apply": _apply,
    "compare laws": lambda bench, f: bench.compare_laws(list(words(f, "law"))),
    "improve robot": lambda bench, f: bench.improve_robot(text(f, "robot")),
    "start": lambda bench, f: bench.start(text(f, "law")),
    "where": lambda bench, f: bench.where(),
    "diagnose": lambda bench, f: bench.diagnose(),
    "add": lambda bench, f: bench.add(text(f, "effect")),
    "drop": lambda bench, f: bench.drop(text(f, "effect")),
    "improve": lambda bench, f: bench.improve(),
    "reject": _reject,
    "accept": lambda bench, f: bench.accept(text(f, "effect")),
    "back": lambda bench, f: bench.back(text(f, "node")),
    "name": lambda bench, f: bench.name(" ".join(f.get("name", []))),
    "compare": lambda bench, f: bench.compare_nodes(text(f, "one"), text(f, "other")),
    "prove": lambda bench, f: bench.prove(parse_sides(lines(f, "box"))),
    "plan": _plan,
    "export": lambda bench, f: bench.export(text(f, "format"), text(f, "precision")),
    "save model": lambda bench, f: bench.save_model(),
    "save report": lambda bench, f: bench.save_report(),
    "cancel": lambda bench, f: bench.cancel(),
}
