"""Results that are remembered as long as what they belong to is in use."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar
from weakref import WeakKeyDictionary

Owner = TypeVar("Owner")
Result = TypeVar("Result")


class Memo(Generic[Owner, Result]):
    """For each owner the results of a slow question, by what was asked.

    An owner is known by its identity or its own equality, and is not kept alive. Two threads that
    ask at the same time may both compute a result: they are equal.

    Examples
    --------
    >>> class Fit: ...
    >>> errors: Memo[Fit, float] = Memo()
    >>> fit = Fit()
    >>> errors.of(fit, "load", lambda: 0.1), errors.of(fit, "load", lambda: 1 / 0)
    (0.1, 0.1)
    """

    def __init__(self) -> None:
        self._known: WeakKeyDictionary[Owner, dict[Hashable, Result]] = WeakKeyDictionary()

    def __len__(self) -> int:
        """Number of owners in use that have results."""
        return len(self._known)

    def of(self, owner: Owner, asked: Hashable, found: Callable[[], Result]) -> Result:
        """The result for `owner` of what is asked, computed by `found` the first time."""
        known = self._known.setdefault(owner, {})
        if asked not in known:
            known[asked] = found()
        return known[asked]
