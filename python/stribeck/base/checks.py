"""Checks of option values, for the Python interface and the command line alike."""

from __future__ import annotations

from stribeck.base.errors import SpecError, option

__all__ = ["check_choice", "check_count", "check_share"]


def check_share(name: str, value: float) -> None:
    """Raise `SpecError` unless `value` lies between 0 and 1; NaN does not.

    Examples
    --------
    >>> check_share("least_fall", float("nan"))
    Traceback (most recent call last):
    stribeck.base.errors.SpecError: `least_fall=nan`: give a number from 0 to 1
    """
    if not 0.0 <= value <= 1.0:
        raise SpecError(f"{option(name, value)}: give a number from 0 to 1")


def check_count(name: str, value: int, least: int = 1) -> None:
    """Raise `SpecError` unless `value` is at least `least`."""
    if not value >= least:
        raise SpecError(f"{option(name, value)}: give a whole number from {least} on")


def check_choice(name: str, value: str, choices: tuple[str, ...]) -> None:
    """Raise `SpecError` unless `value` is one of `choices`."""
    if value not in choices:
        raise SpecError(f"{option(name, value)}: give {' or '.join(choices)}")
