"""Files that commands write: refused before any work where they cannot be written."""

from __future__ import annotations

import glob
import os
import shlex
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

import click

from stribeck.base.checks import check_number
from stribeck.base.errors import RecordingError, SpecError
from stribeck.base.files import FORMATS
from stribeck.base.replaceable import check_folder, check_replaceable, check_table
from stribeck.cli import interrupts

#: Where a context keeps the words of its command.
COMMAND = "stribeck.command"
Decorated = TypeVar("Decorated", bound=Callable[..., object])

#: Endings of tables.
TABLES = (".csv", ".parquet")


class Output(click.ParamType):  # type: ignore[type-arg]
    """An option that names a file to write.

    Parameters
    ----------
    kind
        ``"model file"``, ``"HTML"``, ``"figure"`` or ``"table"``.
    endings
        Endings that the name may have; empty: any.
    """

    name = "file"

    def __init__(self, kind: str, endings: tuple[str, ...] = ()) -> None:
        self.kind = kind
        self.endings = endings

    def convert(self, value: str, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """The path, if it can be written."""
        for path in self.paths(value):
            self._check(path)
        return value

    def paths(self, value: str) -> list[str]:
        """The files that are written."""
        return [value, f"{value}.sidecar.toml"] if self.kind == "table" else [value]

    def _check(self, path: str) -> None:
        ending = os.path.splitext(path)[1].lower()
        if path.endswith(".sidecar.toml") and self.kind == "table":
            return
        if self.endings and ending not in self.endings:
            listed = " or ".join(self.endings)
            raise RecordingError(f"cannot write {path}: its name must end in {listed}")
        check_folder(path, RecordingError)
        if self.kind == "table":
            check_table(path, RecordingError)
        else:
            kind = ending[1:].upper() if self.kind == "figure" else self.kind
            check_replaceable(path, kind, RecordingError)


class Pair(Output):
    """The models of a two-joint arm, by the beginning of their names."""

    def paths(self, value: str) -> list[str]:
        """The files that are written."""
        return [f"{value}_joint_{joint}.toml" for joint in (1, 2)]


class Folder(Output):
    """An option that names a folder for files; it may be new."""

    def __init__(self) -> None:
        super().__init__("folder")

    def _check(self, path: str) -> None:
        if os.path.exists(path) and not os.path.isdir(path):
            raise RecordingError(f"cannot write {path}: it is not a folder; give another path")
        check_folder(path, RecordingError)


MODEL = Output("model file")
PAGE = Output("HTML", (".html", ".htm"))
DESCRIPTION = Output("XML", (".urdf", ".xml"))
ROBOT = Output("robot file", (".toml",))
FIGURE = Output("figure", tuple(f".{ending}" for ending in FORMATS))
TABLE = Output("table", TABLES)
POINTS = Output("table", (".csv",))
MODELS_OF_ARM = Pair("model file")
FOLDER = Folder()
#: Options with a value that means "no limit".
_UNLIMITED = ("limit", "seed")
_MOST_COUNT = 10**9


class CheckedCommand(click.Command):
    """A command whose outputs never replace an input or each other."""

    def make_context(
        self,
        info_name: str | None,
        args: list[str],
        parent: click.Context | None = None,
        **extra: Any,
    ) -> click.Context:
        """Keep the words of the command, so that a page can say what made it."""
        words = list(args)
        made = super().make_context(info_name, args, parent, **extra)
        made.meta[COMMAND] = f"{made.command_path} {shlex.join(words)}"
        return made

    def invoke(self, ctx: click.Context) -> object:
        """Check the outputs, then run."""
        _check_numbers(self, ctx)
        _refuse_inputs(self, ctx)
        interrupts.while_working()
        return super().invoke(ctx)


def _check_numbers(command: click.Command, ctx: click.Context) -> None:
    for param in command.params:
        value = ctx.params.get(param.name or "")
        if param.param_type_name == "option" and param.name not in _UNLIMITED:
            if isinstance(value, float):
                check_number(param.opts[0].lstrip("-").replace("-", "_"), value)
            elif isinstance(value, int) and abs(value) > _MOST_COUNT:
                raise SpecError(f"{param.opts[0]} {value:.3g}: give a smaller number")


def _refuse_inputs(command: click.Command, ctx: click.Context) -> None:
    inputs: list[str] = []
    outputs: list[str] = []
    for param in command.params:
        value = ctx.params.get(param.name or "")
        if isinstance(param.type, Output):
            outputs += [] if value is None else param.type.paths(value)
        else:
            inputs += _files(value)
    for number, path in enumerate(outputs):
        for given in inputs:
            if os.path.exists(path) and os.path.samefile(path, given):
                raise RecordingError(f"cannot write {path}: it is an input; give another path")
        for other in outputs[:number]:
            if os.path.realpath(path) == os.path.realpath(other):
                raise RecordingError(f"cannot write {path} twice: give each output a path")


def _files(value: object) -> Iterator[str]:
    """The files that the value of an option may name, with their sidecars."""
    for text in value if isinstance(value, tuple) else (value,):
        if isinstance(text, str):
            for path in (text, f"{text}.sidecar.toml"):
                if os.path.isfile(path):
                    yield path
                elif "*" in path and "\0" not in path:
                    yield from filter(os.path.isfile, glob.iglob(path))
