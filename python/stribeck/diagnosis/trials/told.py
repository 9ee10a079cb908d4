"""What is told while candidates are fitted: which of how many, the best so far, the time left."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field

from stribeck.diagnosis.trials.trial import Trial
from stribeck.effect.base import number

#: A shorter time left, in s, is not told.
WORTH_TELLING = 3.0


@dataclass
class Told:
    """Candidates that are fitted one after the other.

    Parameters
    ----------
    progress
        Called with a sentence after each.
    total
        Number of candidates.
    clock
        Seconds.
    """

    progress: Callable[[str], None]
    total: int
    clock: Callable[[], float] = time.monotonic
    _done: int = field(default=0, init=False)
    _best: Trial | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._began = self.clock()

    def fitted(self, effect: str, trial: Trial | None) -> None:
        """Tell that a candidate was fitted; `trial` is None where that was impossible."""
        self._done += 1
        if trial is not None and (self._best is None or trial.rank < self._best.rank):
            self._best = trial
        said = f"  fitted {self._done} of {self.total}: {effect}"
        self.progress(f"{said}{self._best_so_far()}{self._time_left()}")

    def _best_so_far(self) -> str:
        best = self._best
        if best is None or best.fit.rmse_held_out is None:
            return ""
        error, unit = number(best.fit.rmse_held_out), best.fit.model.torque_unit
        return f"; best so far: {best.effect}, held-out error {error} {unit}"

    def _time_left(self) -> str:
        left = (self.clock() - self._began) / self._done * (self.total - self._done)
        return f"; about {number(left)} s left for the others" if left > WORTH_TELLING else ""
