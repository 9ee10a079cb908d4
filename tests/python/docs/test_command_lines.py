"""Command lines in README.md and docs/ are right; slow: all of them run, except a list."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import click
import pytest

sys.path.insert(0, str(Path(__file__).parent))
from command_lines import NOT_RUN, Line, lines
from stribeck.cli.main import cli

HERE = Path(__file__).parent
OF_STRIBECK = [line for line in lines() if line.words[0] == "stribeck"]


def name_of(line: Line) -> str:
    return f"{line.page}: {line.text[:60]}"


@pytest.mark.parametrize("line", OF_STRIBECK, ids=name_of)
def test_command_and_options_exist(line: Line):
    command: click.Command = cli
    words = line.words[1:]
    context = click.Context(command, info_name="stribeck")
    while isinstance(command, click.Group):
        found = command.get_command(context, words[0])
        assert found is not None, f"{line.page} names a command that does not exist: {line.text}"
        command, words = found, words[1:]
        context = click.Context(command, info_name=command.name, parent=context)
    command.make_parser(context).parse_args(args=list(words))


def test_every_exception_is_of_a_line():
    unused = [head for head in NOT_RUN if not any(x.text.startswith(head) for x in lines())]
    assert unused == []


@pytest.mark.slow
@pytest.mark.minutes
@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
def test_every_line_runs(tmp_path: Path):
    done = subprocess.run(
        [sys.executable, str(HERE / "run_commands.py")],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
    )
    assert done.returncode == 0, done.stderr[-2000:]
    rows = [json.loads(row) for row in done.stdout.splitlines()]
    assert [f"{r['page']}: {r['line']}: {r['said']}" for r in rows if r["code"] != 0] == []
    assert len(rows) == sum(line.reason is None for line in lines())
