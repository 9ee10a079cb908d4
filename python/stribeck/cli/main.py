"""The command `stribeck`."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import NoReturn

import click

from stribeck.base.errors import StribeckError, one_line
from stribeck.base.files import written_files
from stribeck.base.foreign import sentence_of
from stribeck.base.version import __version__
from stribeck.cli import interrupts
from stribeck.cli.commands import Commands
from stribeck.cli.flags import with_flags
from stribeck.cli.surroundings import check_surroundings
from stribeck.cli.terminal import on_stderr, show_everywhere


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="stribeck")
def cli() -> None:
    """Find the physical effect that a friction model lacks.

    Start with `stribeck demo`, then `stribeck improve DATA`.
    """


def main(arguments: Sequence[str] | None = None) -> None:
    """Run a command; bad input ends in one line on stderr and exit code 2.

    Parameters
    ----------
    arguments
        The words after `stribeck`; None: those of the process.
    """
    show_everywhere()
    try:
        check_surroundings()
        cli.main(arguments, standalone_mode=False, prog_name="stribeck")
        if sys.stdout is not None:
            sys.stdout.flush()
    except click.exceptions.Exit as done:
        sys.exit(done.exit_code)
    except click.exceptions.NoArgsIsHelpError as help_text:
        click.echo(help_text.format_message())
    except click.ClickException as error:
        _stop(error.format_message().rstrip("."))
    except StribeckError as error:
        _stop(str(error))
    except (click.Abort, KeyboardInterrupt):
        interrupts.stop(written_files())
    except BrokenPipeError:
        # The reader of the pipe (head, less) has closed it.
        _drop_output()
        sys.exit(0)
    except Exception as error:
        if os.environ.get("STRIBECK_DEBUG"):
            raise
        _stop_with(error)


def _stop_with(error: Exception) -> NoReturn:
    """Stop after an error that is not one of ours."""
    sentence = sentence_of(error)
    if isinstance(error, OSError) and error.filename is None:
        # What cannot be printed now cannot be printed when the interpreter ends either.
        _drop_output()
        sentence = f"cannot write the result: {sentence}"
    if sentence is None:
        said = one_line(f"{type(error).__name__}: {error}", 300)
        sentence = (
            f"unexpected {said}; this is a defect, please report it (STRIBECK_DEBUG=1 shows where)"
        )
    _stop(sentence)


def _drop_output() -> None:
    try:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (OSError, ValueError, AttributeError):
        # There is no stdout, or no file behind it.
        return


def _stop(sentence: str) -> NoReturn:
    try:
        click.echo(on_stderr(one_line(f"stribeck: {with_flags(sentence)}")), err=True)
    except OSError:
        # Nobody can be told: the exit code remains.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    sys.exit(2)
