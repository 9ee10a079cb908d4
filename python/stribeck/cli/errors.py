"""Options of `fit` for standard errors and intervals."""

from __future__ import annotations

from dataclasses import dataclass

import click

from stribeck.cli.options import Command, Values, gathered
from stribeck.cli.unread import refuse_unread
from stribeck.identify.errors.estimates import ERRORS, Errors
from stribeck.identify.errors.uncertainty import RESAMPLES


@dataclass(frozen=True)
class ErrorChoice:
    """How `fit` computes standard errors and intervals; `resamples` is None where not given."""

    errors: Errors
    resamples: int | None

    @property
    def options(self) -> Values:
        """As keyword arguments of `stribeck.fit`."""
        resamples = RESAMPLES if self.resamples is None else self.resamples
        return {"errors": self.errors, "resamples": resamples}


def error_options(command: Command) -> Command:
    """Add the options; the command receives them as `errors`."""
    return gathered(command, _OPTIONS, "errors", _choice)


def _choice(values: Values) -> ErrorChoice:
    if values["errors"] != "bootstrap":
        refuse_unread(f"with --errors {values['errors']}", {"resamples": "with --errors bootstrap"})
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
