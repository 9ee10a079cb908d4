"""Priors, constraints, ties and losses as a user writes them."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from stribeck import _core
from stribeck.base.checks import check_choice
from stribeck.base.errors import SpecError, option
from stribeck.identify.stated.expressions import used_names
from stribeck.identify.stated.loss import LOSSES
from stribeck.models.formula_law import number

__all__ = [
    "checked_loss",
    "checked_prior",
    "names_in",
    "read_prior",
    "stated_constraint",
    "stated_tie",
]

_PLUS_MINUS = re.compile(r"\+-|\+/-|±")


def read_prior(text: str, what: str) -> tuple[float, float]:
    """Mean and standard deviation in ``0.12+-0.01``; `what` names the text in errors.

    Examples
    --------
    >>> read_prior("0.12±0.01", "the prior")
    (0.12, 0.01)
    """
    parts = _PLUS_MINUS.split(text)
    if len(parts) != 2:
        raise SpecError(f"{what}: write {option('prior', 'NAME=MEAN+-SD')}")
    return number(parts[0], what), number(parts[1], what)


def checked_prior(name: str, prior: tuple[float, float]) -> tuple[float, float]:
    """A prior with a finite mean and a standard deviation above zero."""
    mean, deviation = (float(value) for value in prior)
    if not (math.isfinite(mean) and math.isfinite(deviation) and deviation > 0.0):
        raise SpecError(
            f"the prior of {name} is {mean:g} +- {deviation:g}: give a finite mean and a standard "
            f"deviation above 0"
        )
    return mean, deviation


def names_in(text: str) -> list[str]:
    """The names in a formula or condition, whatever they stand for.

    Raises
    ------
    SpecError
        The text is no formula; with the position.
    """
    try:
        steps = _core.column_formula(text)
    except _core.ModelError as error:
        raise SpecError(f"{text!r}: {error}") from None
    return [str(detail) for step, detail, _ in steps if step == "name" and detail != "pi"]


def stated_constraint(text: str, known: Mapping[str, object]) -> tuple[str, tuple[str, ...]]:
    """A constraint, checked, with the names that it uses."""
    return text.strip(), tuple(used_names(text, known, condition=True))


def stated_tie(name: str, text: str, known: Mapping[str, str]) -> tuple[str, tuple[str, ...]]:
    """The formula that parameter `name` is equal to, checked, with the names that it uses."""
    used = used_names(text, known, condition=False)
    if name in [known[other] for other in used]:
        raise SpecError(f"{name} = {text} depends on itself: write it with other parameters")
    return text.strip(), tuple(used)


def checked_loss(loss: str) -> str:
    """The name of a loss."""
    check_choice("loss", loss, LOSSES)
    return loss
