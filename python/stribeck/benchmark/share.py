"""A count out of a total."""

from __future__ import annotations

from dataclasses import dataclass

import scipy


@dataclass(frozen=True)
class Share:
    """A count out of a total, with the 95 % interval of the share (Wilson)."""

    count: int
    total: int

    @property
    def value(self) -> float:
        """The share; NaN if the total is 0."""
        return self.count / self.total if self.total else float("nan")

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval of the share."""
        if not self.total:
            return (0.0, 1.0)
        ci = scipy.stats.binomtest(self.count, self.total).proportion_ci(method="wilson")
        return (float(ci.low), float(ci.high))

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "right": self.count,
            "of": self.total,
            "share": self.value,
            "interval95": list(self.interval),
        }
