"""What the compiled core answers to a check of passivity, as types."""

from __future__ import annotations

from typing import TypedDict

__all__ = ["AnswerRow", "CounterexampleRow", "MarginRow"]


class MarginRow(TypedDict):
    """Bounds of the margin of one condition; not finite where there is none."""

    condition: str
    lower: float
    upper: float | None
    at: dict[str, float] | None


class CounterexampleRow(TypedDict):
    """A motion that generates energy; ``work`` is in J, ``deflection`` in rad or m."""

    deflection: float | None
    steps: list[dict[str, float]]
    work: float


class AnswerRow(TypedDict):
    """Proved, disproved or undecided, with the condition that decides."""

    passive: bool | None
    condition: str
    margins: list[MarginRow]
    counterexample: CounterexampleRow | None
