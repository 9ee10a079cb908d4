"""Checks of option values, for the Python interface and the command line alike."""

from __future__ import annotations

import math
from numbers import Integral, Real

from stribeck.base.errors import SpecError, one_line, option

__all__ = [
    "LARGEST",
    "check_choice",
    "check_count",
    "check_finite",
    "check_number",
    "check_share",
    "shown",
]

#: The largest number that enters: products of three are still finite.
LARGEST = 1e100


def check_number(
    name: str, value: object, low: float = -LARGEST, high: float = LARGEST, unit: str = ""
) -> None:
    """Raise `SpecError` unless `value` is a number from `low` to `high`; NaN is not.

    Examples
    --------
    >>> check_number("inertia", 1e200)
    Traceback (most recent call last):
    stribeck.base.errors.SpecError: `inertia=1e+200`: give a number of at most 1e+100
    """
    number = check_finite(name, value)
    if not abs(number) <= LARGEST:
        raise SpecError(f"{_given(name, value)}: give a number of at most {LARGEST:g}")
    if not low <= number <= high:
        raise SpecError(f"{_given(name, value)}: give a number from {low:g} to {high:g}{unit}")


def check_finite(name: str, value: object) -> float:
    """The number; raises `SpecError` if `value` is none, or is not finite."""
    if not isinstance(value, Real) or isinstance(value, bool):
        raise SpecError(f"{_given(name, value)}: give a number")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise SpecError(f"{_given(name, value)}: give a finite number")
    return number


def check_share(name: str, value: object) -> None:
    """Raise `SpecError` unless `value` lies between 0 and 1; NaN does not.

    Examples
    --------
    >>> check_share("least_fall", float("nan"))
    Traceback (most recent call last):
    stribeck.base.errors.SpecError: `least_fall=nan`: give a number from 0 to 1
    """
    number = isinstance(value, Real) and not isinstance(value, bool)
    if not number or not 0.0 <= value <= 1.0:  # type: ignore[operator]
        raise SpecError(f"{_given(name, value)}: give a number from 0 to 1")


def check_count(name: str, value: object, least: int = 1, most: int | None = None) -> None:
    """Raise `SpecError` unless `value` is a whole number from `least` to `most`."""
    whole = int(value) if isinstance(value, Integral) and not isinstance(value, bool) else None
    if whole is None or whole < least or (most is not None and whole > most):
        end = "on" if most is None else f"to {most}"
        raise SpecError(f"{_given(name, value)}: give a whole number from {least} {end}")


def check_choice(name: str, value: object, choices: tuple[str, ...]) -> None:
    """Raise `SpecError` unless `value` is one of `choices`."""
    if not isinstance(value, str) or value not in choices:
        raise SpecError(f"{_given(name, value)}: give {' or '.join(choices)}")


def _given(name: str, value: object) -> str:
    """The option with its value, as sentences name it."""
    if isinstance(value, str):
        return option(name, one_line(value, 80))
    if isinstance(value, Real) and not isinstance(value, bool):
        try:
            return option(name, float(value))
        except OverflowError:
            pass
    return f"{option(name)} is {shown(value)}"


def shown(value: object) -> str:
    """A value in a sentence: numbers and texts as they are written, others by their type."""
    if value is None or isinstance(value, bool | int | float | str | list | tuple | dict):
        return one_line(repr(value), 80)
    return f"a {type(value).__name__}"
