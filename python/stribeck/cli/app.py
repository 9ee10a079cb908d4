"""`stribeck app`: the loop as pages in a browser, on this computer alone."""

from __future__ import annotations

import webbrowser
from pathlib import Path

import click

from stribeck.base.errors import StribeckError
from stribeck.cli.common import say
from stribeck.cli.flags import with_flags
from stribeck.cli.outputs import CheckedCommand
from stribeck.cli.report import is_project
from stribeck.recording.several.paths import named_files


@click.command(cls=CheckedCommand)
@click.argument("data", nargs=-1, metavar="[DATA...]")
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    default=0,
    help="Port on this computer. [default: any that is free]",
)
@click.option("--no-browser", is_flag=True, help="Print the address and open nothing.")
@click.option(
    "--folder",
    type=click.Path(file_okay=False),
    default="stribeck-app",
    show_default=True,
    help="Folder for projects, reports, models and files sent; made when it is needed.",
)
def app(data: tuple[str, ...], port: int, no_browser: bool, folder: str) -> None:
    """Open the workbench in a browser: load, compare, find what is missing, add, export.

    DATA are recordings, which are opened as runs of one joint, or project files. The first line
    printed is the address with its token, which only this computer can reach; Ctrl-C ends it.
    """
    files = [file for one in data for file in ([one] if is_project(one) else named_files([one]))]
    try:
        from stribeck.report.workbench.controller import Workbench
        from stribeck.report.workbench.server import serve
    except ModuleNotFoundError as error:
        raise StribeckError(f"{error.name} is not installed: pip install {error.name}") from None
    bench = Workbench(Path(folder), files, with_flags)

    def told(address: str) -> None:
        click.echo(address)
        say("note: Ctrl-C ends the workbench")
        if not no_browser:
            webbrowser.open(address)

    serve(bench, port, told)
