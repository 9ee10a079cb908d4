"""Options and output that the commands share."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Protocol

import click

from stribeck.base.arguments import MOST_SEED, MOST_STARTS
from stribeck.cli.flags import with_flags
from stribeck.cli.kept import keep
from stribeck.cli.options import Command, Values, gathered
from stribeck.cli.outputs import FOLDER, MODEL, PAGE
from stribeck.cli.terminal import on_stderr, stderr_is_terminal
from stribeck.diagnosis.result import Finding
from stribeck.fitting.evaluate import evaluate
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.models.model_file import ModelFile
from stribeck.models.published.sets import PREFIX
from stribeck.models.reader import read_model_file
from stribeck.recording.load import read_with
from stribeck.recording.recording import Recording
from stribeck.recording.several.paths import Given
from stribeck.recording.stated.options import TABLE, Entry, ReadOptions


def finite(value: object) -> object:
    """Replace NaN and infinity, which JSON lacks, by null, and write options as flags."""
    if isinstance(value, str):
        return with_flags(value)
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def echo_json(value: Mapping[str, object]) -> None:
    """Print one JSON object, and nothing else, on stdout."""
    click.echo(json.dumps(finite(value), allow_nan=False))


class Result(Protocol):
    """A result with the contract's JSON; its `repr` is the text."""

    def to_dict(self) -> Mapping[str, object]:
        """The contract's JSON."""
        ...


def echo_result(result: Result, as_json: bool, file_text: Callable[[], str] | None = None) -> None:
    """Print a result on stdout, as JSON or as text, and keep it for `stribeck last`.

    Parameters
    ----------
    file_text
        Gives the text of the file that `-o` would write, where that is no model file.
    """
    text = None if as_json else with_flags(repr(result))
    if text is None:
        echo_json(result.to_dict())
    else:
        click.echo(text)

    def in_json() -> dict[str, object]:
        return {key: finite(value) for key, value in result.to_dict().items()}

    unsaved = keep(result, text, in_json, file_text)
    if unsaved and text is not None and stderr_is_terminal():
        say("note: the model is in no file; `stribeck last -o M.toml` writes it")


def say(sentence: str) -> None:
    """Print progress or a warning on stderr."""
    click.echo(on_stderr(with_flags(sentence)), err=True)


json_option = click.option(
    "--json", "as_json", is_flag=True, help="Print one JSON object on stdout."
)
seed_option = click.option(
    "--seed",
    type=click.IntRange(0, MOST_SEED),
    default=0,
    show_default=True,
    help="Seed of the random numbers.",
)
workers_option = click.option(
    "--workers",
    type=click.IntRange(min=1),
    default=None,
    help="Number of processes. [default: one per core]",
)
output_option = click.option(
    "-o",
    "--output",
    type=MODEL,
    default=None,
    help="Write the fitted model to this file (TOML).",
)
starts_option = click.option(
    "--starts",
    type=click.IntRange(1, MOST_STARTS),
    default=20,
    show_default=True,
    help="Random starts of the nonlinear parameters.",
)
least_fall_option = click.option(
    "--least-fall",
    type=click.FloatRange(0.0, 1.0),
    default=0.01,
    show_default=True,
    help="Smallest relative decrease of the held-out RMSE that counts as a finding.",
)

report_option = click.option(
    "--report", type=PAGE, default=None, metavar="FILE", help="Write a self-contained page (HTML)."
)
figures_option = click.option(
    "--figures",
    type=FOLDER,
    default=None,
    metavar="FOLDER",
    help="Write the figure behind each finding to this folder (PNG).",
)


def _click_option(entry: Entry) -> Callable[[Command], Command]:
    """The flag of one option of `stribeck.read`."""
    flag = "--" + entry.name.replace("_", "-")
    if entry.kind == "pairs":
        return click.option(flag, entry.name, multiple=True, metavar=entry.form, help=entry.help)
    if entry.kind == "number":
        help = f"{entry.help} [{entry.unit}]" if entry.unit else entry.help
        return click.option(flag, type=float, default=None, help=help)
    if entry.kind == "switch":
        return click.option(flag, entry.name, is_flag=True, help=entry.help)
    if entry.choices:
        return click.option(flag, type=click.Choice(entry.choices), default=None, help=entry.help)
    kind = click.Path() if entry.kind == "path" else None
    return click.option(flag, type=kind, default=None, metavar=entry.form, help=entry.help)


def recording_options(command: Command) -> Command:
    """Add the reading options; the command receives them as `reading`."""
    table = [entry for entry in TABLE if entry.command_line]

    def build(values: Values) -> ReadOptions:
        return ReadOptions(**{entry.name: values.pop(entry.name) for entry in table})

    return gathered(command, map(_click_option, table), "reading", build)


#: Arguments of the options that only a command which reads and fits DATA reads.
OF_DATA = ("starts", *(entry.name for entry in TABLE if entry.command_line))


def read_recording(path: Given, reading: ReadOptions) -> Recording:
    """Read the recording of one joint from one or several files, and print its notes on stderr."""
    recording = read_with(path, reading)
    for note in recording.notes:
        say(f"note: {note}")
    for line in _of_checks(recording):
        say(f"note: {line}")
    recording.require_consistent()
    return recording


def _of_checks(recording: Recording) -> Iterator[str]:
    """What the checks found: those passed in one line, the others in a line each."""
    passed = [check.said for check in recording.checks if check.ok and not check.is_open]
    if passed:
        yield f"checks passed: {'; '.join(passed)}"
    for check in recording.checks:
        if check.is_open:
            yield check.said + (f"; {check.do}" if check.do else "")
        elif not check.ok and check.trustable and recording.trusted:
            yield f"accepted with --trust: {check.said}"


def is_model_file(argument: str) -> bool:
    """Whether a model argument names a file or a published set rather than a spec."""
    return argument.startswith(PREFIX) or argument.endswith(".toml") or os.path.isfile(argument)


def stored_model(path: str, recording: Recording) -> Fit:
    """A model file on a recording, unchanged."""
    stored = read_model_file(path)
    return evaluate(
        stored.model,
        recording,
        fitted_on=stored.hashes,
        stderr=stored.stderr,
    )


def model_fit(argument: str, recording: Recording, *, starts: int, seed: int) -> Fit:
    """The fit of a model argument: a spec is fitted, a model file is evaluated unchanged."""
    if is_model_file(argument):
        return stored_model(argument, recording)
    return fit(argument, recording, starts=starts, seed=seed)


def save_fit(fitted: Fit, path: str) -> None:
    """Write the model file of a fit, with standard errors and provenance."""
    ModelFile.of(fitted).write(path)
    say(f"wrote {path}")


def save_findings(findings: Sequence[Finding], folder: str | None) -> None:
    """Write one figure per finding, named by its effect; nothing if `folder` is None."""
    from stribeck.base.files import save_figure

    if folder is None:
        return
    if not findings:
        say(f"note: there is no finding, so {folder} is not written")
        return
    Path(folder).mkdir(exist_ok=True)
    for finding in findings:
        path = Path(folder) / f"{finding.effect}.png"
        save_figure(finding.plot(), path)
        say(f"wrote {path}")
