"""The limits that keep the package easy to enter: rooms, lengths of files and functions."""

from __future__ import annotations

import ast
import importlib
from collections.abc import Iterator
from pathlib import Path

import click
import stribeck
from stribeck.cli.commands import COMMANDS, Commands
from stribeck.cli.outputs import CheckedCommand

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
    """From `def` to the last line, with the docstring, but without the examples in it."""
    long = []
    for path in FILES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                examples = (ast.get_docstring(node) or "").partition("\n\nExamples\n")[2]
                lines = (node.end_lineno or node.lineno) - node.lineno + 1
                # The heading and the empty line before it belong to them.
                lines -= len(examples.splitlines()) + 2 * bool(examples)
                if lines > MOST_LINES_OF_A_FUNCTION:
                    long.append((str(path), node.name, lines))
    assert long == []


def test_every_command_of_the_help_exists() -> None:
    for name, (module, _) in COMMANDS.items():
        command = getattr(importlib.import_module(f"stribeck.cli.{module}"), name)
        assert isinstance(command, click.Command) and command.help


def commands_of(group: click.Group, above: str = "") -> Iterator[tuple[str, click.Command]]:
    """Every command that does something, also those of groups, by the words that call it."""
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None, name
        words = f"{above} {name}".strip()
        if isinstance(command, click.Group):
            yield from commands_of(command, words)
            # A group that answers without a command of its own would be unguarded.
            assert not command.invoke_without_command, words
        else:
            yield words, command


def unguarded(group: click.Group) -> list[str]:
    """Commands that do not check their outputs and numbers before they start."""
    return [words for words, made in commands_of(group) if not isinstance(made, CheckedCommand)]


def test_every_command_is_guarded() -> None:
    assert unguarded(Commands("stribeck")) == []


def test_a_command_without_guard_is_noticed() -> None:
    """The test above would say which one."""

    @click.command()
    def bare() -> None:
        """Write without looking."""

    inner = click.Group("inner", {"bare": bare})
    assert unguarded(click.Group("all", {"bare": bare, "inner": inner})) == ["bare", "inner bare"]
