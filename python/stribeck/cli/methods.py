"""Identification as in the papers: `points`."""

from __future__ import annotations

from typing import Any

import click

from stribeck.cli.common import (
    check_output,
    echo_json,
    json_option,
    read_recording,
    recording_options,
    say,
    seed_option,
)
from stribeck.methods import Search, averaged_points, segment_points


@click.command()
@click.argument("data")
@click.option(
    "--method", type=click.Choice(["averaging", "segments"]), required=True,
    help="Half the difference of passes in both directions, or the mean of every pass.",
)  # fmt: skip
@click.option(
    "-o", "--output", type=click.Path(dir_okay=False), default=None,
    help="Write the points (CSV) and the sidecar that says how to read them.",
)  # fmt: skip
@click.option(
    "--bins", default=1, show_default=True,
    help="averaging: points a pair of passes, each over a share of the positions.",
)  # fmt: skip
@click.option(
    "--tolerance", default=Search.tolerance, show_default=True,
    help="Largest relative difference of speed within a pass.",
)  # fmt: skip
@click.option(
    "--shortest", default=Search.shortest, show_default=True, help="Shortest pass, s.",
)  # fmt: skip
@click.option(
    "--trim", default=Search.trim, show_default=True, help="Share left out at each end of a pass."
)  # fmt: skip
@recording_options
@seed_option
@json_option
def points(
    data: str, method: str, output: str | None, bins: int, tolerance: float, shortest: float,
    trim: float, reading: dict[str, Any], seed: int, as_json: bool,
) -> None:  # fmt: skip
    """Turn passes at constant speed in DATA into steady-state friction points.

    averaging needs no gravity model (Bittencourt et al. 2010, eq 4); segments takes the mean
    torque of each pass (Gantry, section 3). `stribeck fit POINTS` then identifies a static law.
    """
    check_output(output)
    # A line through many samples shows passes that no single row's velocity does.
    recording = read_recording(data, {**reading, "standstill": True})
    search = Search(tolerance=tolerance, shortest=shortest, trim=trim)
    if method == "averaging":
        made = averaged_points(recording, bins=bins, search=search)
    else:
        made = segment_points(recording, search=search)
    if output is not None:
        made.write(output)
        say(f"wrote {output} and {output}.sidecar.toml")
    if as_json:
        echo_json(made.to_dict())
    else:
        click.echo(repr(made))
