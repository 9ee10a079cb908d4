"""Options about the parameters of a fit."""

from __future__ import annotations

from typing import cast

import click

from stribeck.cli.options import Command, Values, gathered
from stribeck.identify.search.algorithms import ALGORITHMS, GAUSS_NEWTON
from stribeck.identify.stated.choices import CHOICE_NAMES, ChoiceArguments, Choices
from stribeck.identify.stated.loss import LOSSES

_START = click.option(
    "--start", multiple=True, metavar="NAME=VALUE", help="Start value of a parameter."
)
_FIX = click.option("--fix", multiple=True, metavar="NAME=VALUE", help="Fix a parameter.")
CHOICE_OPTIONS = [
    _START,
    click.option(
        "--bound",
        "bounds",
        multiple=True,
        metavar="NAME=LOW:HIGH",
        help="Bounds of a parameter; an omitted end is unbounded.",
    ),
    _FIX,
    click.option(
        "--prior",
        multiple=True,
        metavar="NAME=MEAN+-SD",
        help="Gaussian prior of a parameter: mean and standard deviation.",
    ),
    click.option(
        "--constraint",
        "constraints",
        multiple=True,
        metavar="'LEFT >= RIGHT'",
        help="An inequality between formulas of parameters.",
    ),
    click.option(
        "--tie",
        "ties",
        multiple=True,
        metavar="'NAME = FORMULA'",
        help="A parameter that is a formula of others.",
    ),
    click.option(
        "--loss",
        type=click.Choice(LOSSES),
        default=None,
        help="How residuals count: squares, or a robust loss. [default: squares]",
    ),
    click.option(
        "--algorithm",
        type=click.Choice(ALGORITHMS),
        default=None,
        help="Search from each start: damped Gauss-Newton steps, or an algorithm of nlopt. mlsl "
        "and those after it search the range of all starts. All end with Gauss-Newton steps. "
        f"[default: {GAUSS_NEWTON}]",
    ),
]

per_run_option = click.option(
    "--per-run",
    multiple=True,
    metavar="NAME,...",
    help="Parameters with a value of their own in each run; the others are shared.",
)


def taken_choices(values: Values) -> Choices:
    """Take the values of these options out of all values."""
    taken = {name: values.pop(name, None) for name in CHOICE_NAMES}
    return Choices.of(cast(ChoiceArguments, taken))


def value_options(command: Command) -> Command:
    """Add `--start` and `--fix`; the command receives them as `choices`."""
    return gathered(command, [_START, _FIX], "choices", taken_choices)


def choice_options(command: Command) -> Command:
    """Add these options; the command receives them as `choices`."""
    return gathered(command, CHOICE_OPTIONS, "choices", taken_choices)
