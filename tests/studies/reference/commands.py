"""The page on every command, from the commands themselves."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator

import click
from stribeck.cli.main import cli

#: An option of at least so many commands, with the same words, is described once.
SHARED = 8
#: What Markdown reads as more than a letter, outside of code.
_MARK = re.compile(r"[\\|\[\]*_<>](?=(?:[^`]*`[^`]*`)*[^`]*$)")
_OPTION = re.compile(r"(?<![\w`-])--[a-z][\w-]*(?=(?:[^`]*`[^`]*`)*[^`]*$)")

HEAD = """# Commands

Every command with its options, as the program itself states them; `stribeck COMMAND --help` prints
the same. [Command line](command_line.md) says what the commands have in common.
"""
COMMON = """## Options of many commands

How data is read, and how a model is fitted. A command names those that it takes.
"""


def page() -> str:
    """The whole page, as Markdown."""
    found = list(commands(cli, "stribeck"))
    counts = Counter(row for _, command in found for row in option_rows(command))
    common = {row for row, count in counts.items() if count >= SHARED}
    ordered = [row for row in dict.fromkeys(counts) if row in common]
    parts = [HEAD, *(section(name, command, common) for name, command in found)]
    return "\n".join([*parts, COMMON, table(ordered)])


def commands(group: click.Group, name: str) -> Iterator[tuple[str, click.Command]]:
    """Every command below a group, with its whole name."""
    context = click.Context(group, info_name=name)
    for word in group.list_commands(context):
        command = group.get_command(context, word)
        assert command is not None
        if isinstance(command, click.Group):
            yield from commands(command, f"{name} {word}")
        else:
            yield f"{name} {word}", command


def section(name: str, command: click.Command, common: set[tuple[str, str]]) -> str:
    """A command: what it does, how it is written, and its options."""
    context = click.Context(command, info_name=name)
    usage = f"{name} {' '.join(command.collect_usage_pieces(context))}"
    rows = option_rows(command)
    own = [row for row in rows if row not in common]
    also = " ".join(f"`{flag(row)}`" for row in rows if row in common)
    lines = [f"## {name}", "", paragraphs(command.help or ""), "", f"```text\n{usage}\n```", ""]
    if own:
        lines += [table(own), ""]
    if also:
        lines += [f"Also [options of many commands](#options-of-many-commands): {also}", ""]
    return "\n".join(lines)


def paragraphs(text: str) -> str:
    """The help of a command; its lines are joined, since Markdown breaks them anew."""
    plain = text.replace("\b\n", "").strip()
    return "\n\n".join(options(" ".join(part.split())) for part in plain.split("\n\n"))


def option_rows(command: click.Command) -> list[tuple[str, str]]:
    """The options of a command: how they are written, and what they do."""
    context = click.Context(command)
    rows = []
    for parameter in command.get_params(context):
        record = parameter.get_help_record(context)
        if record is not None and record[1] and "--help" not in record[0]:
            rows.append((f"`{record[0]}`", " ".join(record[1].split())))
    return rows


def flag(row: tuple[str, str]) -> str:
    """The long name of an option: `--output` of `-o, --output FILE`."""
    return next(word for word in row[0].strip("`").split() if word.startswith("--"))


def table(rows: list[tuple[str, str]]) -> str:
    """Options as a table of Markdown."""
    lines = ["| option | effect |", "|---|---|"]
    for written, said in rows:
        lines.append(f"| {written} | {escaped(said)} |")
    return "\n".join(lines)


def escaped(text: str) -> str:
    """Text of a cell; brackets are no links, stars no emphasis, and options are code."""
    return _MARK.sub(lambda mark: f"&#{ord(mark[0])};", options(text))


def options(text: str) -> str:
    """Text whose options are set as code."""
    return _OPTION.sub(r"`\g<0>`", text)
