"""`--evaluate`: recordings on which a fitted model is judged, and which it is not fitted to."""

from __future__ import annotations

import click

from stribeck.cli.common import say
from stribeck.recording.load import read_with
from stribeck.recording.options import ReadOptions
from stribeck.recording.recording import Recording

evaluate_option = click.option(
    "--evaluate",
    multiple=True,
    metavar="OTHER",
    help="Report the error on this recording too, which is not fitted: a file, folder or pattern.",
)


def judged(others: tuple[str, ...], reading: ReadOptions) -> list[Recording]:
    """The recordings of `--evaluate`, read like the data but each with its own sidecar."""
    made = []
    for other in others:
        recording = read_with(other, reading)
        for note in recording.notes:
            say(f"note: {other}: {note}")
        recording.require_consistent()
        made.append(recording)
    return made
