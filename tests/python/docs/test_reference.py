"""The page on every command has every command and option."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import click
from stribeck.cli.main import cli

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "studies/reference"))
from commands import commands, page


def test_every_option_of_every_command_is_described() -> None:
    text = page()
    found = list(commands(cli, "stribeck"))
    assert len(found) > 40
    for name, command in found:
        assert f"\n## {name}\n" in text
        for parameter in command.params:
            if isinstance(parameter, click.Option) and not parameter.hidden:
                assert parameter.opts[-1] in text, (name, parameter.opts)
    # A heading, a head of a table or a row: no cell is broken over lines, and bars are in code.
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert all(re.sub("`[^`]*`", "", line).count("|") == 3 for line in rows)
