"""`--evaluate`: recordings on which fitted models are judged, and which they are not fitted to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import click

from stribeck.cli.common import Result, is_model_file, say
from stribeck.fitting.evaluate import evaluated_on, refuse_fitted_on
from stribeck.fitting.evaluated import Evaluated
from stribeck.fitting.result import Fit
from stribeck.models.reader import read_model_file
from stribeck.recording.load import read_with
from stribeck.recording.recording import Recording
from stribeck.recording.stated.options import ReadOptions
from stribeck.report.layout import joined, table
from stribeck.report.numbers import percent, plain

evaluate_option = click.option(
    "--evaluate",
    multiple=True,
    metavar="OTHER",
    help="Report the error on this recording too, which is not fitted: a file, folder or pattern.",
)


def judged(
    others: tuple[str, ...], reading: ReadOptions, fitted: Recording | None = None
) -> list[Recording]:
    """The recordings of `--evaluate`, read like the data but each with its own sidecar.

    Raises
    ------
    FitError
        One of them is `fitted`, the data that a model will be fitted to.
    """
    made = []
    for other in others:
        recording = read_with(other, reading)
        for note in recording.notes:
            say(f"note: {other}: {note}")
        recording.require_consistent()
        if fitted is not None:
            refuse_fitted_on(recording, fitted.hashes)
        made.append(recording)
    return made


@dataclass(frozen=True)
class Judgement:
    """The error of one model on one other recording.

    Attributes
    ----------
    of
        What was judged, by kind: ``{"model": "coulomb+load"}``.
    unit
        Of torque.
    """

    of: Mapping[str, str | None]
    unit: str
    error: Evaluated

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {**self.of, **self.error.to_dict()}


@dataclass(frozen=True, repr=False)
class WithJudgements:
    """A result, and the errors of its models on other recordings."""

    result: Result
    judgements: Sequence[Judgement]

    def to_dict(self) -> dict[str, object]:
        """The JSON of the result, with the errors as `evaluated`."""
        return {**self.result.to_dict(), "evaluated": [one.to_dict() for one in self.judgements]}

    def __repr__(self) -> str:
        of, unit = self.judgements[0].of, self.judgements[0].unit
        rows = [[*of, "recording", f"RMSE [{unit}]", "rel. residual"]]
        rows += [_cells(one) for one in self.judgements]
        errors = table(rows, right=(len(of) + 1, len(of) + 2))
        return joined(repr(self.result), f"On recordings that were not fitted\n\n{errors}")


def _cells(one: Judgement) -> list[str]:
    relative = one.error.relative_residual
    return [
        *(text or "" for text in one.of.values()),
        Path(one.error.file).name,
        plain(one.error.rmse),
        "" if relative is None else percent(relative),
    ]


def with_judgements(result: Result, fits: Iterable[Fit], others: Sequence[Recording]) -> Result:
    """The result with the errors of its fits on other recordings; the result itself without any.

    Raises
    ------
    FitError
        A model was fitted to one of them.
    """
    judgements = [
        Judgement({"model": fitted.model.spec}, fitted.model.torque_unit, error)
        for fitted in fits
        for error in evaluated_on(fitted, others).evaluated
    ]
    return WithJudgements(result, judgements) if judgements else result


def refuse_fitted(models: Iterable[str], others: Sequence[Recording]) -> None:
    """Refuse to judge a model file on a recording that it was fitted to.

    Raises
    ------
    FitError
        It was.
    """
    for model in models:
        if is_model_file(model):
            hashes = read_model_file(model).hashes
            for other in others:
                refuse_fitted_on(other, hashes)
