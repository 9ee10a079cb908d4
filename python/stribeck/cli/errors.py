"""Options of `fit` for standard errors and intervals."""

from __future__ import annotations

from dataclasses import dataclass

import click

from stribeck.base.errors import SpecError
from stribeck.cli.options import Command, Values, gathered
from stribeck.identify.estimates import ERRORS, Errors
from stribeck.identify.uncertainty import RESAMPLES


@dataclass(frozen=True)
class ErrorChoice:
    """How `fit` computes standard errors and intervals; `resamples` is None where not given."""

    errors: Errors
    resamples: int | None

    def __post_init__(self) -> None:
        if self.resamples is not None and self.errors != "bootstrap":
            raise SpecError("--resamples belongs to --errors bootstrap: give both or neither")

    @property
    def options(self) -> Values:
        """As keyword arguments of `stribeck.fit`."""
        resamples = RESAMPLES if self.resamples is None else self.resamples
        return {"errors": self.errors, "resamples": resamples}

    def refuse(self, method: str) -> None:
        """Refuse a choice beside a method that has standard errors of its own."""
        if self.errors != "robust" and method != "rms":
            raise SpecError(
                f"--errors {self.errors} goes with --method rms, not {method}: omit one"
            )


def error_options(command: Command) -> Command:
    """Add the options; the command receives them as `errors`."""
    return gathered(command, _OPTIONS, "errors", _choice)


def _choice(values: Values) -> ErrorChoice:
    return ErrorChoice(values.pop("errors"), values.pop("resamples"))


_OPTIONS = [
    click.option(
        "--errors",
        type=click.Choice(ERRORS),
        default="robust",
        show_default=True,
        help="Standard errors: robust for sampled motion, independent for separate points. "
        "profile: robust, with intervals of the profile likelihood. bootstrap: from refits to "
        "resampled blocks.",
    ),
    click.option(
        "--resamples",
        type=int,
        default=None,
        metavar="COUNT",
        help=f"bootstrap: number of refits.  [default: {RESAMPLES}]",
    ),
]
