"""Names of several models beside each other, none twice."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stribeck.fitting.result import Fit


def numbered(names: Sequence[str]) -> list[str]:
    """The names; those that occur several times with their number, in the order given.

    Examples
    --------
    >>> numbered(["coulomb", "lugre", "coulomb"])
    ['coulomb (1)', 'lugre', 'coulomb (2)']
    """
    made = []
    for place, name in enumerate(names):
        alike = names.count(name) > 1
        made.append(f"{name} ({names[: place + 1].count(name)})" if alike else name)
    return made


def model_names(fits: Sequence[Fit]) -> list[str]:
    """The specs of models; of those alike, which were not fitted here, and their numbers."""
    specs = [fit.model.spec for fit in fits]
    names = []
    for spec, fit in zip(specs, fits, strict=True):
        stored = specs.count(spec) > 1 and fit.starts == 0
        names.append(f"{spec}, not refitted" if stored else spec)
    return numbered(names)
