"""Completion, width and colour: what a shell and a terminal get."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from click.testing import CliRunner
from stribeck.cli import terminal
from stribeck.cli.main import cli, main
from stribeck.report import layout

LONG = "note: " + "a word that is one of many and " * 8


@pytest.fixture
def narrow(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both streams are a terminal of 60 columns."""
    monkeypatch.setattr("sys.stdout.isatty", lambda: True, raising=False)
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    monkeypatch.setenv("COLUMNS", "60")
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")


@pytest.mark.usefixtures("narrow")
def test_text_is_wrapped_to_the_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    assert max(map(len, layout.paragraph(LONG).splitlines())) <= 60
    monkeypatch.setenv("NO_COLOR", "1")
    assert max(map(len, terminal.on_stderr(LONG).splitlines())) < 60
    # Names and numbers are whole, even if that is wider.
    rows = [["name", "value"], ["a" * 50, "1" * 30]]
    assert "a" * 50 in layout.table(rows, right=(1,), whole=(0,))
    assert "1" * 30 in layout.table(rows, right=(1,), whole=(0,))


@pytest.mark.usefixtures("narrow")
def test_colour_is_for_terminals_that_want_it(monkeypatch: pytest.MonkeyPatch) -> None:
    assert terminal.on_stderr("note: x").startswith("\x1b[") and "x" in terminal.on_stderr("x")
    for name, value in (("NO_COLOR", "1"), ("TERM", "dumb")):
        with monkeypatch.context() as patch:
            patch.setenv(name, value)
            assert terminal.on_stderr("note: x") == "note: x"


def test_a_pipe_gets_the_line_as_it_is() -> None:
    assert terminal.on_stderr(LONG) == LONG and layout.line_width() == layout.WIDTH


def completed(
    words: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> list[str]:
    """What bash is given for the last of some words."""
    monkeypatch.setenv("_STRIBECK_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", words)
    monkeypatch.setenv("COMP_CWORD", str(len(words.split()) - 1))
    with pytest.raises(SystemExit):
        main([])
    return [line.partition(",")[2] for line in capsys.readouterr().out.splitlines()]


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ("stribeck impro", ["improve"]),
        ("stribeck fit --per", ["--per-run"]),
        ("stribeck fit x.csv --model lug", ["lug", "lugre"]),
        ("stribeck compare coulomb+te", ["coulomb+temperature_dry", "coulomb+temperature_viscous"]),
        ("stribeck effects back", ["backlash"]),
        ("stribeck models gan", ["gantry_map"]),
    ],
)
def test_words_are_completed(
    words: str,
    found: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert sorted(completed(words, monkeypatch, capsys)) == sorted(found)


@pytest.mark.parametrize(
    ("shell", "path"),
    [
        ("bash", ".local/share/bash-completion/completions/stribeck"),
        ("zsh", ".zfunc/_stribeck"),
        ("fish", ".config/fish/completions/stribeck.fish"),
    ],
)
def test_completion_is_printed_or_installed(
    shell: str, path: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("XDG_DATA_HOME", "XDG_CONFIG_HOME", "BASH_COMPLETION_USER_DIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    printed = CliRunner().invoke(cli, ["completion", shell], catch_exceptions=False).stdout
    assert "_STRIBECK_COMPLETE" in printed
    CliRunner().invoke(cli, ["completion", shell, "--install"], catch_exceptions=False)
    assert (tmp_path / path).read_text() == printed.replace(os.linesep, "\n")
