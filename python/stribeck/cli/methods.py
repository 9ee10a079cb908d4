"""Identification methods of the papers: `points`, `arm`, and the methods of `fit`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import click

from stribeck.base.errors import RecordingError, SpecError
from stribeck.cli.common import (
    echo_result,
    json_option,
    read_recording,
    recording_options,
    say,
    seed_option,
)
from stribeck.cli.data import data_argument
from stribeck.cli.evaluation import evaluate_option, judged
from stribeck.cli.options import Command, Values, gathered
from stribeck.cli.outputs import MODELS_OF_ARM, POINTS, CheckedCommand
from stribeck.cli.refused import OF_AN_ARM, OF_POINTS, refusing
from stribeck.cli.unread import refuse_unread
from stribeck.fitting.exogenous import ESTIMATORS
from stribeck.fitting.methods.arm import arm_fit
from stribeck.fitting.methods.averaging import averaged_points
from stribeck.fitting.methods.grid import Axis, grid_fit
from stribeck.fitting.methods.segments import segment_points
from stribeck.fitting.methods.steady import SteadyPoints
from stribeck.fitting.methods.stretches import Search
from stribeck.fitting.methods.three_step import three_step_fit
from stribeck.fitting.protocols.coast_down import coast_down_points
from stribeck.fitting.protocols.points import (
    BristleStiffness,
    breakaway_points,
    bristle_stiffness,
    protocol_points,
)
from stribeck.fitting.result import Estimator, Fit
from stribeck.models.model import Model
from stribeck.recording.recording import Recording
from stribeck.recording.stated.options import ReadOptions


@dataclass(frozen=True)
class Method:
    """The method of `stribeck fit`; all other commands use `rms`."""

    name: str
    grid: Mapping[str, Axis]
    loaded: str | None
    presliding: str | None
    estimator: Estimator = "ls"

    def __post_init__(self) -> None:
        if self.name == "three_step" and None in (self.loaded, self.presliding):
            raise SpecError(
                "--method three_step needs three recordings: DATA without load, --loaded FILE and "
                "--presliding FILE"
            )

    def fit(
        self, model: Model, recording: Recording, reading: ReadOptions, *, starts: int, seed: int
    ) -> Fit:
        """Identify `model` by a method other than `rms`."""
        if self.loaded is None or self.presliding is None:
            return grid_fit(model, recording, grid=self.grid)
        loaded = read_recording(self.loaded, reading)
        slow = replace(reading, average=None, standstill=True)
        presliding = read_recording(self.presliding, slow)
        return three_step_fit(model, recording, loaded, presliding, starts=starts, seed=seed)


def method_options(command: Command) -> Command:
    """Add the method options; the command receives them as `method`."""
    return gathered(command, _METHOD_OPTIONS, "method", _method)


#: Options that not every method of `fit` reads, by the method that does.
_OF_METHODS = {
    "rms": ("estimator", "passive", "per_run", "errors", "resamples"),
    "grid": ("grid",),
    "three_step": ("loaded", "presliding"),
}


def _method(values: Values) -> Method:
    name = values.pop("method")
    for reader, options in _OF_METHODS.items():
        if reader != name:
            refuse_unread(
                f"with --method {name}", dict.fromkeys(options, f"with --method {reader}")
            )
    if name == "grid":
        refuse_unread("with --method grid", {"starts": "with --method rms or three_step"})
    return Method(
        name=name,
        grid=_axes(values.pop("grid")),
        loaded=values.pop("loaded"),
        presliding=values.pop("presliding"),
        estimator=values.pop("estimator"),
    )


_METHOD_OPTIONS = [
    click.option(
        "--method",
        type=click.Choice(["rms", "grid", "three_step"]),
        default="rms",
        show_default=True,
        help="rms: least RMS error within bounds from random starts (UR5e review, eqs 4-5). grid: "
        "linear regression on a grid of the nonlinear parameters, least absolute error "
        "(Bittencourt 2010, eqs 5-6). three_step: temperature from DATA, then load, then "
        "presliding (Tadese 2021, section V).",
    ),
    click.option(
        "--estimator",
        type=click.Choice(ESTIMATORS),
        default="ls",
        show_default=True,
        help="ls: least squares. iv: instrumental variables from the reference trajectory, which "
        "noise of the measured motion does not bias (Janot, Vandanjon and Gautier 2014).",
    ),
    click.option(
        "--grid",
        multiple=True,
        metavar="NAME=FROM:TO:COUNT",
        help="grid: values of a nonlinear parameter; default: the range of its random starts.",
    ),
    click.option(
        "--loaded",
        default=None,
        metavar="FILE",
        help="three_step: steady-state points under load; DATA are those without load.",
    ),
    click.option(
        "--presliding",
        default=None,
        metavar="FILE",
        help="three_step: position under a slow torque below the Coulomb friction.",
    ),
]


def _axes(said: tuple[str, ...]) -> dict[str, Axis]:
    """Axes of ``NAME=FROM:TO:COUNT`` texts."""
    axes = {}
    for text in said:
        name, _, numbers = text.partition("=")
        try:
            lower, upper, count = numbers.split(":")
            axes[name.strip()] = Axis(float(lower), float(upper), int(count))
        except ValueError:
            raise SpecError(f"--grid {text}: write --grid NAME=FROM:TO:COUNT") from None
    return axes


#: How `stribeck points` reduces a recording, by method: of the recording, bins and search.
_POINTS: dict[str, Callable[[Recording, int, Search], SteadyPoints | BristleStiffness]] = {
    "averaging": lambda r, bins, search: averaged_points(r, bins=bins, search=search),
    "segments": lambda r, bins, search: segment_points(r, bins=bins, search=search),
    "breakaway": lambda r, bins, search: breakaway_points(r),
    "coast_down": lambda r, bins, search: coast_down_points(r, bins=10 * bins),
    "presliding": lambda r, bins, search: bristle_stiffness(r),
    "protocols": lambda r, bins, search: protocol_points(r, bins=bins, search=search),
}
#: Options that reduce passes, and those of them that other methods read too.
_OF_PASSES = dict.fromkeys(
    ("tolerance", "shortest", "trim"), "with --method averaging, segments or protocols"
)
_OF_BINS = {"bins": "with --method averaging, segments, coast_down or protocols"}
_UNREAD = {
    "breakaway": {**_OF_PASSES, **_OF_BINS},
    "coast_down": _OF_PASSES,
    "presliding": {**_OF_PASSES, **_OF_BINS, "output": "with a method that gives points"},
}


@click.command(cls=CheckedCommand)
@click.argument("data")
@click.option(
    "--method",
    type=click.Choice(
        ["averaging", "segments", "breakaway", "coast_down", "presliding", "protocols"]
    ),
    required=True,
    help="averaging: half the difference of both directions; segments: mean of each pass; "
    "breakaway: static friction of torque ramps; coast_down: free decelerations; presliding: "
    "stiffness of small loops; protocols: segments, breakaway and coast_down.",
)
@click.option(
    "-o",
    "--output",
    type=POINTS,
    default=None,
    help="Write the points (CSV) and their sidecar.",
)
@click.option(
    "--bins",
    default=1,
    show_default=True,
    help="Points per pass (or pair of passes), each over an equal share of it; a coast-down gives "
    "ten times as many.",
)
@click.option(
    "--tolerance",
    default=Search.tolerance,
    show_default=True,
    help="Largest relative difference of speed within a pass.",
)
@click.option(
    "--shortest",
    default=Search.shortest,
    show_default=True,
    help="Shortest pass, s.",
)
@click.option(
    "--trim", default=Search.trim, show_default=True, help="Share excluded at each end of a pass."
)
@refusing(OF_POINTS)
@recording_options
@seed_option
@json_option
def points(
    data: str,
    method: str,
    output: str | None,
    bins: int,
    tolerance: float,
    shortest: float,
    trim: float,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Reduce test-bench protocols in DATA to friction points.

    averaging needs no gravity model (Bittencourt et al. 2010, eq 4); segments takes the mean torque
    of each pass at constant speed (Gantry, section 3). `stribeck fit POINTS` then identifies a
    static law. presliding gives a stiffness, and the `--prior` that hands it to a fit.
    """
    refuse_unread(f"with --method {method}", _UNREAD.get(method, {}))
    # A pass below the velocity threshold still shows in a line through many samples.
    recording = read_recording(data, replace(reading, standstill=True))
    search = Search(tolerance=tolerance, shortest=shortest, trim=trim)
    made = _POINTS[method](recording, bins, search)
    if output is not None and isinstance(made, SteadyPoints):
        made.write(output)
        say(f"wrote {output} and {output}.sidecar.toml")
    echo_result(made, as_json)


@click.command(cls=CheckedCommand)
@data_argument
@click.option(
    "--first-link-length",
    required=True,
    type=float,
    help="Distance between the axes of the two joints, m.",
)
@click.option(
    "--joints",
    nargs=2,
    default=("1", "2"),
    show_default=True,
    metavar="FIRST SECOND",
    help="Names of the joints in DATA.",
)
@click.option(
    "--slowest",
    default=0.05,
    show_default=True,
    help="Share of the largest speed below which the samples of a joint are excluded.",
)
@click.option("--plain", is_flag=True, help="Do not weight the joints by their errors.")
@click.option(
    "-o",
    "--output",
    type=MODELS_OF_ARM,
    default=None,
    metavar="NAME",
    help="Write the friction of both joints to NAME_joint_1.toml and NAME_joint_2.toml.",
)
@refusing(OF_AN_ARM)
@evaluate_option
@recording_options
@seed_option
@json_option
def arm(
    data: tuple[str, ...],
    first_link_length: float,
    joints: tuple[str, str],
    slowest: float,
    plain: bool,
    output: str | None,
    evaluate: tuple[str, ...],
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Identify inertia and friction of a planar two-joint arm together.

    DATA contains angles and torques of both joints (q_1, torque_1, q_2, torque_2), the second angle
    relative to the first link. Indri et al., section 4.2: four inertial parameters,
    and a cubic friction polynomial per joint. `--slowest 0 --plain` is the least squares of the
    paper.
    """
    if reading.joint is not None:
        raise RecordingError(
            f"--joint {reading.joint}: an arm has two joints, name them by --joints"
        )
    first, second = (read_recording(data, replace(reading, joint=name)) for name in joints)
    others = [judged(evaluate, replace(reading, joint=name)) for name in joints]
    made = arm_fit(
        first, second, first_link_length=first_link_length, slowest=slowest, weighted=not plain
    )
    for one, other in zip(*others, strict=True):
        made = made.on(one, other)
    if output is not None:
        for joint in (1, 2):
            made.friction(joint).save(f"{output}_joint_{joint}.toml")
            say(f"wrote {output}_joint_{joint}.toml")
    echo_result(made, as_json)
