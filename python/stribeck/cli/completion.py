"""`stribeck completion`: completion of words for a shell."""

from __future__ import annotations

import os
from pathlib import Path

import click
from click.shell_completion import ShellComplete, get_completion_class

from stribeck.base.errors import StribeckError
from stribeck.base.files import write_whole
from stribeck.cli.common import echo_json, json_option, say, seed_option
from stribeck.cli.outputs import CheckedCommand

SHELLS = ("bash", "zsh", "fish")
#: The variable by which the shell asks for words.
VARIABLE = "_STRIBECK_COMPLETE"
#: What remains to be done after the file is written.
_THEN = {
    "bash": "a new shell completes, if the package bash-completion is installed",
    "zsh": "add `fpath+=(~/.zfunc); autoload -Uz compinit; compinit` to ~/.zshrc, if it is not "
    "there",
    "fish": "a new shell completes",
}


@click.command(cls=CheckedCommand)
@click.argument("shell", type=click.Choice(SHELLS))
@click.option("--install", is_flag=True, help="Write it where the shell looks for it.")
@seed_option
@json_option
def completion(shell: str, install: bool, seed: int, as_json: bool) -> None:
    """Print the script that completes commands, options, laws and effects, or install it.

    For one session of bash: eval "$(stribeck completion bash)".
    """
    made = script(shell)
    if not install:
        if as_json:
            echo_json({"shell": shell, "script": made})
        else:
            click.echo(made)
        return
    path = place(shell)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StribeckError(f"cannot create {path.parent}: {error.strerror or error}") from None
    write_whole(path, f"{made}\n")
    if as_json:
        echo_json({"shell": shell, "path": str(path)})
    else:
        click.echo(f"wrote {path}")
    say(f"note: {_THEN[shell]}")


def script(shell: str) -> str:
    """The script of click for a shell."""
    made = get_completion_class(shell)
    assert made is not None
    # Bash's own class asks the shell for its version first; the script works without.
    return ShellComplete.source(made(click.Group(), {}, "stribeck", VARIABLE)).strip()


def place(shell: str) -> Path:
    """Where a shell looks for completions of the user."""
    home = Path.home()
    if shell == "zsh":
        return home / ".zfunc" / "_stribeck"
    if shell == "fish":
        folder = Path(os.environ.get("XDG_CONFIG_HOME") or home / ".config")
        return folder / "fish" / "completions" / "stribeck.fish"
    data = Path(os.environ.get("XDG_DATA_HOME") or home / ".local" / "share")
    folder = Path(os.environ.get("BASH_COMPLETION_USER_DIR") or data / "bash-completion")
    return folder / "completions" / "stribeck"
