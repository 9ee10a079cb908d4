"""What all commands share: options, output, errors."""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import click

from stribeck.base.errors import RecordingError
from stribeck.base.files import write_whole
from stribeck.cli.flags import with_flags
from stribeck.diagnosis.result import Finding
from stribeck.fitting.evaluate import evaluate
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.models.model_file import ModelFile
from stribeck.models.reader import read_model_file
from stribeck.recording.load import read
from stribeck.recording.recording import Recording

F = TypeVar("F", bound=Callable[..., Any])


def finite(value: Any) -> Any:
    """JSON has no NaN or infinity: they become null."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def echo_json(value: dict[str, Any]) -> None:
    """Print one JSON object, and nothing else, on stdout."""
    click.echo(json.dumps(finite(value), allow_nan=False))


def say(sentence: str) -> None:
    """Progress and warnings go to stderr."""
    click.echo(with_flags(sentence), err=True)


json_option = click.option("--json", "as_json", is_flag=True, help="One JSON object on stdout.")
seed_option = click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Seed of everything random.",
)
output_option = click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False),
    default=None,
    help="Write the fitted model to this file (TOML).",
)
starts_option = click.option(
    "--starts",
    type=click.IntRange(min=1),
    default=20,
    show_default=True,
    help="Random starts of the nonlinear parameters.",
)
least_fall_option = click.option(
    "--least-fall",
    type=click.FloatRange(0.0, 1.0),
    default=0.01,
    show_default=True,
    help="Least relative fall of the held-out RMSE that counts.",
)

report_option = click.option(
    "--report", default=None, metavar="FILE", help="Write a self-contained page (HTML)."
)
figures_option = click.option(
    "--figures",
    type=click.Path(file_okay=False),
    default=None,
    metavar="FOLDER",
    help="Write the figure behind each finding to this folder (PNG).",
)

_RECORDING_OPTIONS = [
    click.option("--joint", default=None, help="Which joint of a file that holds several."),
    click.option("--sidecar", type=click.Path(), default=None, help="Sidecar file (TOML)."),
    click.option("--map", "maps", multiple=True, metavar="NAME=COLUMN", help="Use COLUMN as NAME."),
    click.option(
        "--derive", "derives", multiple=True, metavar="NAME=EXPR", help="Make a column by formula."
    ),
    click.option("--where", default=None, metavar="EXPR", help="Keep the rows for which it holds."),
    click.option(
        "--average",
        type=click.Choice(["run", "row"]),
        default=None,
        help="Steady-state points: the median of each run, or each row by itself.",
    ),
    click.option(
        "--rows",
        type=click.Choice(["moving", "all"]),
        default=None,
        help="Rows that count: those that move (default), or all.",
    ),
    click.option(
        "--unit", "units", multiple=True, metavar="COLUMN=UNIT", help="Unit of a file's column."
    ),
    click.option(
        "--joint-kind",
        type=click.Choice(["revolute", "prismatic"]),
        default=None,
        help="Default: from the position's unit, else revolute.",
    ),
    click.option("--gear-ratio", type=float, default=None, help="Motor turns a joint turn."),
    click.option("--torque-constant", type=float, default=None, help="N m/A, for a current."),
    click.option("--inertia", type=float, default=None, help="Known inertia, kg m2 or kg."),
    click.option(
        "--drive",
        type=click.Choice(["voltage"]),
        default=None,
        help="The effort is the voltage on a DC motor.",
    ),
    click.option(
        "--hold-out",
        default=None,
        metavar="COLUMN[=VALUE]",
        help="Hold out by the values of a column of the file, not by time or run.",
    ),
    click.option("--km", type=float, default=None, help="Motor constant, N m/W^0.5 (energy)."),
    click.option("--kb", type=float, default=None, help="Back-EMF constant, V s/rad (energy)."),
    click.option("--kt", type=float, default=None, help="Torque constant, N m/A (energy)."),
]


def recording_options(command: F) -> F:
    """Add the options that say how a file is read; the command gets them as `reading`."""

    @functools.wraps(command)
    def wrapper(**given: Any) -> Any:
        reading = {
            "joint": given.pop("joint"),
            "sidecar": given.pop("sidecar"),
            "map": given.pop("maps"),
            "derive": given.pop("derives"),
            "where": given.pop("where"),
            "average": given.pop("average"),
            "rows": given.pop("rows"),
            "unit": given.pop("units"),
            "joint_kind": given.pop("joint_kind"),
            "gear_ratio": given.pop("gear_ratio"),
            "torque_constant": given.pop("torque_constant"),
            "inertia": given.pop("inertia"),
            "drive": given.pop("drive"),
            "hold_out": given.pop("hold_out"),
            "km": given.pop("km"),
            "kb": given.pop("kb"),
            "kt": given.pop("kt"),
        }
        return command(reading=reading, **given)

    decorated: Any = wrapper
    for option in reversed(_RECORDING_OPTIONS):
        decorated = option(decorated)
    return decorated


def read_recording(path: str, reading: dict[str, Any]) -> Recording:
    """Read one joint's recording; its notes go to stderr."""
    recording = read(path, **reading)
    for note in recording.notes:
        say(f"note: {note}")
    return recording


def is_model_file(argument: str) -> bool:
    """Whether a model argument names a file rather than a spec."""
    return argument.endswith(".toml") or Path(argument).is_file()


def model_fit(argument: str, recording: Recording, *, starts: int, seed: int, refit: bool) -> Fit:
    """The fit that a model argument means on a recording.

    A spec is fitted. A model file is evaluated as it is, or, with `refit`, taken as the start.
    """
    if not is_model_file(argument):
        return fit(argument, recording, starts=starts, seed=seed)
    stored = read_model_file(argument)
    if refit:
        say(f"note: the parameters of {argument} are fitted again to {recording.path}")
        return fit(stored.model, recording, starts=starts, seed=seed)
    return evaluate(
        stored.model,
        recording,
        fitted_on=stored.fitted_on.get("sha256"),
        stderr=stored.stderr,
    )


def save_fit(fitted: Fit, path: str) -> None:
    """Write a fit's model file with its standard errors and provenance."""
    ModelFile.of(fitted).write(path)
    say(f"wrote {path}")


def save_findings(findings: Sequence[Finding], folder: str | None) -> None:
    """Write the figure behind each finding, named by its effect; None: nowhere."""
    from stribeck.base.files import save_figure

    if folder is None:
        return
    if not findings:
        say(f"note: nothing was found, so {folder} is not written")
        return
    Path(folder).mkdir(exist_ok=True)
    for finding in findings:
        path = Path(folder) / f"{finding.effect}.png"
        save_figure(finding.plot(), path)
        say(f"wrote {path}")


def save_page(page: str, path: str) -> None:
    """Write a page whole or not at all."""
    write_whole(path, page)
    say(f"wrote {path}")


def check_output(path: str | None) -> None:
    """Refuse an output that cannot be written before work is done for it."""
    if path is None:
        return
    folder = Path(path).resolve().parent
    if not folder.is_dir():
        raise RecordingError(f"cannot write {path}: the folder {folder} does not exist, make it")
