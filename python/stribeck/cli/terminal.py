"""Text for the terminal or pipe at hand, whatever characters it can show."""

from __future__ import annotations

import codecs
import os
import shutil
import sys
import textwrap
import unicodedata

import click

_NAME = "stribeck.plain"
#: One character each, so that columns stay aligned.
_PLAIN = str.maketrans(
    "\u2212\u00b1\u00b7\u22c5\u2500\u2502\u251c\u2514\u2192\u00d7\u2265\u2264\u2248\u0394\u00b5\u03bc\u2022"
    "\u25b8\u25b2\u2588\u2592\u258f\u258e\u258d\u258c\u258b\u258a\u2589\u00b0\u2026",
    "-~  -||`>x><~duu*>^#=####### .",
)


def show_everywhere() -> None:
    """Have stdout and stderr replace what their encoding lacks, instead of failing.

    A pipe of Windows is often cp1252 or cp437, which have no minus sign and no lines of tables.
    """
    codecs.register_error(_NAME, _replaced)
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors=_NAME)


#: Colours of the words that begin a line on stderr.
_COLOURS = {"stribeck:": "red", "note:": "yellow"}


def stderr_is_terminal() -> bool:
    """Whether somebody reads stderr; it may be closed, or there may be none."""
    return sys.stderr is not None and not sys.stderr.closed and sys.stderr.isatty()


def on_stderr(sentence: str) -> str:
    """A sentence for stderr: on a terminal wrapped to its width, its first word in colour.

    There is no colour where NO_COLOR is set (https://no-color.org) or the terminal is dumb.
    """
    if not stderr_is_terminal():
        return sentence
    first = sentence.partition(" ")[0]
    if "\n" not in sentence:
        width = max(shutil.get_terminal_size().columns - 1, 20)
        indent = " " * (len(first) + 1) if first in _COLOURS else ""
        sentence = textwrap.fill(
            sentence,
            width,
            subsequent_indent=indent,
            break_long_words=False,
            break_on_hyphens=False,
        )
    if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb" or first not in _COLOURS:
        return sentence
    return click.style(first, fg=_COLOURS[first], bold=True) + sentence[len(first) :]


def _replaced(error: UnicodeError) -> tuple[str, int]:
    """What stands for the characters that cannot be encoded."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(_plain(character, error.encoding) for character in lacking), error.end


def _plain(character: str, encoding: str) -> str:
    """The nearest character of the encoding; a question mark where there is none."""
    for candidate in (
        character.translate(_PLAIN),
        unicodedata.normalize("NFKD", character)[:1],
    ):
        try:
            candidate.encode(encoding)
        except UnicodeError:
            continue
        return candidate
    return "?"
