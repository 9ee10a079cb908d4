"""What to do about a parameter that ends at one of its bounds, in words."""

from __future__ import annotations

from collections.abc import Iterable

from stribeck.base.errors import option
from stribeck.identify.errors.estimates import Estimate

__all__ = ["at_bound_notes", "wider"]

#: The factor by which a wider bound is proposed.
WIDER = 5.0


def at_bound_notes(estimates: Iterable[Estimate]) -> tuple[str, ...]:
    """A sentence, without full stop, for each parameter that is at a bound.

    Examples
    --------
    >>> speed = Estimate("stribeck_velocity", "vs", 1.0, "rad/s", None, None, True, True, 0.002, 1)
    >>> print(*at_bound_notes([speed]))  # doctest: +NORMALIZE_WHITESPACE
    stribeck_velocity is at its upper bound 1 rad/s: widen it with
    `bounds="stribeck_velocity=0.002:5"`, or the recording does not determine it
    """
    return tuple(_sentence(e) for e in estimates if e.at_bound)


def wider(e: Estimate) -> str:
    """What widens the bound that a parameter is at, such as ``widen it with ...``."""
    room = e.upper - e.lower
    if _at_upper(e):
        low, high = e.lower, _wider(e.upper, room)
    else:
        low, high = -_wider(-e.lower, room), e.upper
    return f"widen it with {option('bounds', f'{e.name}={_end(low)}:{_end(high)}')}"


def _sentence(e: Estimate) -> str:
    at_upper = _at_upper(e)
    end = e.upper if at_upper else e.lower
    unit = "" if e.unit == "1" else f" {e.unit}"
    where = f"{e.name} is at its {'upper' if at_upper else 'lower'} bound {end:.4g}{unit}"
    if end == 0.0:
        sign = "positive" if at_upper else "negative"
        return (
            f"{where}: fix it there with {option('fix', f'{e.name}=0')}, or, if it may be {sign}, "
            f"{wider(e)}"
        )
    return f"{where}: {wider(e)}, or the recording does not determine it"


def _at_upper(e: Estimate) -> bool:
    return e.upper - e.value < e.value - e.lower


def _wider(upper: float, room: float) -> float:
    """An upper bound beyond `upper`; from zero by the `room` on the other side."""
    if upper == 0.0:
        return room
    return upper * WIDER if upper > 0.0 else upper / WIDER


def _end(bound: float) -> str:
    return "" if abs(bound) == float("inf") else f"{bound:.4g}"
