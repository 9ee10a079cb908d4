"""The command `stribeck`."""

from __future__ import annotations

import os
import sys

import click

from stribeck.base.errors import StribeckError, nearest
from stribeck.base.version import __version__
from stribeck.cli.benchmark import benchmark
from stribeck.cli.catalog import effects, inspect, models
from stribeck.cli.check import check
from stribeck.cli.compensate import compensate
from stribeck.cli.demo import demo
from stribeck.cli.export import export
from stribeck.cli.flags import with_flags
from stribeck.cli.fleet import fleet
from stribeck.cli.generate import generate
from stribeck.cli.loop import add, compare, diagnose, fit, improve
from stribeck.cli.methods import arm, points
from stribeck.cli.plan import plan
from stribeck.cli.project import project
from stribeck.cli.simulate import simulate
from stribeck.cli.study import study
from stribeck.cli.validate import validate


class Commands(click.Group):
    """A group that answers a mistyped command with the nearest one."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command, or say which one may be meant."""
        if self.get_command(ctx, args[0]) is None and not args[0].startswith("-"):
            raise click.UsageError(
                f"there is no command {args[0]!r}{nearest(args[0], tuple(self.commands))}; "
                f"`stribeck --help` lists them"
            )
        return super().resolve_command(ctx, args)


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="stribeck")
def cli() -> None:
    """Which physical effect is your friction model missing?

    Start with `stribeck demo`, then `stribeck improve DATA`.
    """


for command in (demo, inspect, models, effects, fit, compare, diagnose, add, improve, generate):
    cli.add_command(command)
cli.add_command(plan)
cli.add_command(check)
cli.add_command(export)
cli.add_command(simulate)
cli.add_command(compensate)
cli.add_command(validate)
cli.add_command(points)
cli.add_command(arm)
cli.add_command(study)
cli.add_command(fleet)
cli.add_command(benchmark)
cli.add_command(project)


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
        # The reader (head, less) has gone: nothing to say to it.
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
