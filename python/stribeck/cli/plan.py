"""`stribeck plan`: plan a motion that shows or separates effects."""

from __future__ import annotations

from pathlib import Path

import click

from stribeck.base.errors import SpecError
from stribeck.base.files import save_figure, write_table
from stribeck.cli.common import (
    OF_DATA,
    echo_result,
    is_model_file,
    json_option,
    read_recording,
    recording_options,
    say,
    seed_option,
    starts_option,
)
from stribeck.cli.data import arguments_of, is_data, split_one
from stribeck.cli.formulas import Written, model_options, written_fit
from stribeck.cli.outputs import FIGURE, TABLE, CheckedCommand
from stribeck.cli.refused import OF_A_PLAN, refusing
from stribeck.cli.unread import refuse_unread
from stribeck.fitting.result import Fit
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.models.reader import read_model_file
from stribeck.motion.design.plan import plan as make
from stribeck.motion.generate.files import file_bytes
from stribeck.recording.stated.options import ReadOptions


@click.command(cls=CheckedCommand)
@arguments_of("DATA MODEL")
@click.option(
    "--separate",
    "separate",
    multiple=True,
    metavar="EFFECT,EFFECT",
    help="Effects to distinguish.",
)
@click.option(
    "--show", "show", multiple=True, metavar="EFFECT", help="Effect to show; may be repeated."
)
@click.option(
    "--position", required=True, metavar="LOW:HIGH", help="Range of the position, rad or m."
)
@click.option("--speed", type=float, required=True, help="Largest speed, rad/s or m/s.")
@click.option(
    "--acceleration", type=float, required=True, help="Largest acceleration, rad/s2 or m/s2."
)
@click.option("--duration", type=float, default=60.0, show_default=True, help="Duration, s.")
@click.option(
    "--rate",
    "samples",
    type=float,
    default=None,
    help="Sampling rate, Hz. [default: that of DATA, else 100]",
)
@click.option(
    "--noise", type=float, default=None, help="RMS of the torque noise, if there is no DATA."
)
@click.option(
    "-o",
    "--output",
    type=TABLE,
    default=None,
    help="Write the motion (.csv or .parquet).",
)
@click.option(
    "--plot", "picture", type=FIGURE, metavar="FILE", help="Write a figure of the motion (PNG)."
)
@model_options
@refusing(OF_A_PLAN)
@starts_option
@recording_options
@seed_option
@json_option
def plan(
    arguments: tuple[str, ...],
    written: Written,
    separate: tuple[str, ...],
    show: tuple[str, ...],
    position: str,
    speed: float,
    acceleration: float,
    duration: float,
    samples: float | None,
    noise: float | None,
    output: str | None,
    picture: str | None,
    starts: int,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Plan a motion that shows effects that DATA cannot show, or distinguishes them.

    Without data: stribeck plan MODEL.toml.
    """
    limits = position_range(position)
    joint = _joint(arguments, written, starts=starts, seed=seed, reading=reading)
    say("note: searching for a motion, some seconds to a minute ...")
    planned = make(
        joint,
        position=limits,
        speed=speed,
        acceleration=acceleration,
        separate=_ids(separate),
        show=_ids(show),
        duration=duration,
        rate=samples,
        noise=noise,
        seed=seed,
    )
    if output is not None:
        write_table(
            output,
            file_bytes(planned.to_frame(), Path(output).suffix.lower()),
            f'kind = "recording"\njoint_kind = "{_kind(planned.model)}"\n',
        )
        say(f"wrote {output}")
    if picture is not None:
        save_figure(planned.plot(), picture)
        say(f"wrote {picture}")
    echo_result(planned, as_json)


def _joint(
    arguments: tuple[str, ...],
    written: Written,
    *,
    starts: int,
    seed: int,
    reading: ReadOptions,
) -> Fit | ModelFile:
    """A fit to DATA, or the model file that stands in its place."""
    if not any(map(is_data, arguments)) and len(arguments) == 1 and is_model_file(arguments[0]):
        if written != Written():
            raise SpecError(
                f"{arguments[0]} is taken as it is: what is stated about a model is for a fit, so "
                f"name DATA too, or leave it out"
            )
        refuse_unread("with a model file alone", dict.fromkeys(OF_DATA, "with DATA"))
        return read_model_file(arguments[0])
    data, model = split_one(arguments, "", None)
    if model is None and not written.laws:
        given = " ".join(data)
        raise SpecError(f"no model is given for {given}: write stribeck plan {given} MODEL")
    refuse_unread("with DATA, which show the noise", {"noise": "with a model file alone"})
    recording = read_recording(data, reading)
    return written_fit(model, written, recording, starts=starts, seed=seed)


def _kind(model: Model) -> str:
    return "revolute" if model.position_unit == "rad" else "prismatic"


def position_range(text: str) -> tuple[float, float]:
    """The ends of `LOW:HIGH`."""
    low, mark, high = text.partition(":")
    try:
        if mark:
            return float(low), float(high)
    except ValueError:
        pass
    raise SpecError(f"--position {text}: write --position LOW:HIGH, two numbers")


def _ids(texts: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(word.strip() for text in texts for word in text.split(",") if word.strip())
