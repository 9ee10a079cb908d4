"""The papers that can be repeated, by the name that the command takes."""

from __future__ import annotations

import importlib
from collections.abc import Callable

from stribeck.base.errors import SpecError, nearest
from stribeck.benchmark.reproduce.result import Reproduction

#: Name on the command line: module in this folder. Each has ``reproduce(seed, quick)``.
PAPERS = ("gantry", "ur5e_review", "tadese", "indri", "bittencourt")


def reproduce(paper: str, *, seed: int = 0, quick: bool = False) -> Reproduction:
    """Repeat the tables and figures of a paper, with its numbers beside ours.

    Parameters
    ----------
    paper : {"gantry", "ur5e_review", "tadese", "indri", "bittencourt"}
    seed : int
        Of the noise of data that stand in for the paper's.
    quick : bool
        Fewer rows and starts, for a test.

    Returns
    -------
    Reproduction

    Raises
    ------
    SpecError
        The paper is unknown.

    Examples
    --------
    >>> made = reproduce("gantry", quick=True)  # doctest: +SKIP
    >>> [row.quantity for row in made.missed]  # doctest: +SKIP
    []
    """
    if paper not in PAPERS:
        raise SpecError(
            f"there is no paper {paper!r}{nearest(paper, PAPERS)}; known are {', '.join(PAPERS)}"
        )
    if seed < 0:
        raise SpecError(f"seed {seed} is negative: give 0 or more")
    module = importlib.import_module(f"stribeck.benchmark.reproduce.{paper}")
    made: Callable[[int, bool], Reproduction] = module.reproduce
    return made(seed, quick)
