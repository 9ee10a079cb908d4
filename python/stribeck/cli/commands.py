"""The commands, and a group that imports one of them when it is called.

`stribeck --help` prints this table alone, so it does not wait for what the commands need.
"""

from __future__ import annotations

import importlib

import click
from click.shell_completion import CompletionItem

from stribeck.base.errors import nearest

#: Each command in the order of the help: its module, its name there, and what it does.
COMMANDS = {
    "demo": ("demo", "Run the whole loop on a shipped recording."),
    "inspect": ("catalog", "Show what DATA holds, and which effects it can show."),
    "models": ("catalog", "List the friction laws."),
    "effects": ("catalog", "List the effects that can be missing."),
    "published": ("published", "List the parameter sets printed in the literature."),
    "fit": ("fit", "Identify the parameters of a model on DATA."),
    "compare": ("loop", "Compare MODELS with DATA, and show where each fails."),
    "plot": ("plot", "Draw one figure of MODELS on DATA, as journals print it."),
    "diagnose": ("loop", "Find which physical effect MODEL lacks on DATA."),
    "add": ("loop", "Add EFFECT to MODEL and refit; error before and after."),
    "improve": ("loop", "Diagnose and add effects until the residual is noise."),
    "report": ("report", "Write one page on DATA or a PROJECT: models, errors, findings."),
    "app": ("app", "Open the workbench: the loop as pages in a browser."),
    "project": ("project", "Run the loop step by step; a file keeps every branch."),
    "plan": ("plan", "Plan a motion that shows what DATA cannot show."),
    "check": ("check", "Prove that MODEL is passive, or show where it is not."),
    "simulate": ("simulate", "Simulate a joint with the friction of MODEL."),
    "compensate": ("compensate", "Track a trajectory with and without friction compensation."),
    "validate": ("validate", "Simulate MODEL from the torque of DATA; compare the motion."),
    "export": ("export", "Write MODEL as a program for a controller."),
    "points": ("methods", "Reduce passes at constant speed to steady-state points."),
    "robot": ("robot", "Rigid bodies and friction of a whole robot."),
    "arm": ("methods", "Identify a planar two-joint arm."),
    "study": ("study", "Fit many laws to every joint of DATA and compare them."),
    "fleet": ("fleet", "Fit every joint of many FILES; find the joints that changed."),
    "reproduce": ("reproduce", "Repeat the tables and figures of a paper."),
    "last": ("last", "Print the last result again, or save its model."),
    "completion": ("completion", "Complete words in bash, zsh or fish."),
    "generate": ("generate", "Make a synthetic recording with hidden effects."),
    "benchmark": ("benchmark", "Measure how often the diagnosis is right."),
}


class Commands(click.Group):
    """A group of the commands above; a mistyped command is answered with the nearest one."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The names, in the order of the table."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command; None if there is none of this name."""
        if cmd_name not in COMMANDS:
            return None
        module = importlib.import_module(f"stribeck.cli.{COMMANDS[cmd_name][0]}")
        command: click.Command = getattr(module, cmd_name)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the table without importing a command."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, what) for name, (_, what) in COMMANDS.items()])

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Commands that begin alike, without importing them."""
        named = [
            CompletionItem(name, help=what)
            for name, (_, what) in COMMANDS.items()
            if name.startswith(incomplete)
        ]
        return (
            named if incomplete[:1] != "-" else click.Command.shell_complete(self, ctx, incomplete)
        )

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command, or say which one may be meant."""
        if args[0] not in COMMANDS and not args[0].startswith("-"):
            raise click.UsageError(
                f"there is no command {args[0]!r}{nearest(args[0], tuple(COMMANDS))}; "
                f"`stribeck --help` lists the commands"
            )
        return super().resolve_command(ctx, args)
