"""The limits that keep the package easy to enter: rooms, lengths of files and functions."""

from __future__ import annotations

import ast
import importlib
from pathlib import Path

import click
import stribeck
from stribeck.cli.commands import COMMANDS

PACKAGE = Path(stribeck.__file__).parent
FILES = sorted(PACKAGE.rglob("*.py"))
MOST_ROOMS, MOST_LINES, MOST_LINES_OF_A_FUNCTION = 18, 400, 60


def test_the_package_has_few_rooms() -> None:
    rooms = {path.relative_to(PACKAGE).parts[0] for path in FILES}
    rooms -= {"__init__.py", "__main__.py"}
    assert len(rooms) <= MOST_ROOMS, sorted(rooms)


def test_no_file_is_long() -> None:
    lengths = {str(path): len(path.read_text(encoding="utf-8").splitlines()) for path in FILES}
    assert {name: n for name, n in lengths.items() if n > MOST_LINES} == {}


def test_no_function_is_long() -> None:
    """From the line of `def` to the last one, docstring included."""
    long = []
    for path in FILES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                lines = (node.end_lineno or node.lineno) - node.lineno + 1
                if lines > MOST_LINES_OF_A_FUNCTION:
                    long.append((str(path), node.name, lines))
    assert long == []


def test_every_command_of_the_help_exists() -> None:
    for name, (module, _) in COMMANDS.items():
        command = getattr(importlib.import_module(f"stribeck.cli.{module}"), name)
        assert isinstance(command, click.Command) and command.help
