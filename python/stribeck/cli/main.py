"""The command `stribeck`."""

from __future__ import annotations

import os
import sys

import click

from stribeck.base.errors import StribeckError
from stribeck.base.version import __version__
from stribeck.cli.commands import Commands
from stribeck.cli.flags import with_flags


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="stribeck")
def cli() -> None:
    """Find the physical effect that a friction model lacks.

    Start with `stribeck demo`, then `stribeck improve DATA`.
    """


def main() -> None:
    """Run a command; bad input ends in one line on stderr and exit code 2."""
    try:
        cli.main(standalone_mode=False, prog_name="stribeck")
    except click.exceptions.Exit as done:
        sys.exit(done.exit_code)
    except click.exceptions.NoArgsIsHelpError as help_text:
        click.echo(help_text.format_message())
        sys.exit(0)
    except click.ClickException as error:
        _stop(error.format_message().rstrip(".").replace("\n", " "))
    except StribeckError as error:
        _stop(str(error).replace("\n", " "))
    except (click.Abort, KeyboardInterrupt):
        click.echo("stribeck: stopped; nothing was written", err=True)
        sys.exit(130)
    except BrokenPipeError:
        # The reader of the pipe (head, less) has closed it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(0)
    except Exception as error:
        if os.environ.get("STRIBECK_DEBUG"):
            raise
        _stop(
            f"unexpected {type(error).__name__}: {error}; this is a defect, please report it "
            f"(STRIBECK_DEBUG=1 shows where)".replace("\n", " ")
        )


def _stop(sentence: str) -> None:
    click.echo(f"stribeck: {with_flags(sentence)}", err=True)
    sys.exit(2)
