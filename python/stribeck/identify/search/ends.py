"""What a search from many starts found, and where each start ended."""

from __future__ import annotations

from dataclasses import dataclass

from stribeck.identify.search.separable import Search


@dataclass(frozen=True)
class Ended:
    """Where one of several starts ended.

    Attributes
    ----------
    search
        The search on all samples where the start continued on them, else on fewer.
    evaluations
        Number of evaluations.
    leader
        The start that continued for this one: itself, or an earlier one that reached the same
        place.
    finished
        Whether the start, or its leader, continued on all samples.
    """

    search: Search
    evaluations: int
    leader: int
    finished: bool


@dataclass(frozen=True)
class StartsReport:
    """What the starts of a search say about its minimum.

    Attributes
    ----------
    algorithm
        Algorithm of the coarse search.
    at_minimum
        Number of starts that ended at the place of the minimum.
    new_place
        Estimated probability that another start would end at a place that none has reached: the
        share of starts that ended alone (Good 1953). None for a single start.
    """

    algorithm: str
    at_minimum: int
    new_place: float | None


@dataclass(frozen=True)
class Found:
    """The best of many searches.

    Attributes
    ----------
    search
        The search with the least sum of squares, on all samples.
    ends
        Where each start ended.
    evaluations
        Number of evaluations of the model.
    report
        What the starts say.
    """

    search: Search
    ends: tuple[Ended, ...]
    evaluations: int
    report: StartsReport
