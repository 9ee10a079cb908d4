"""A resonance in more detail: a spring that hardens, and a motor whose inertia does not oscillate.

Springs of gears carry more than in proportion to their twist (Tuttle and Seering 1996), so that a
drive train oscillates faster the further it twists. A single linear one follows such an oscillation
for a few periods only.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, fields

import nlopt
import numpy as np
from numpy.typing import NDArray

from stribeck.effect.resonance import (
    DAMPINGS,
    LOWEST,
    NONE,
    Shown,
    best_resonance,
    beyond,
    is_possible,
)
from stribeck.recording.motion.spring_torque import Resonance
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: A resonance is looked at in detail if it explains this share of what is left by simpler causes,
#: and has so many samples in a period.
PROMISING, RESOLVED = 0.05, 10.0
#: The detail stays if it explains so many times what the linear spring does.
MORE = 1.2
#: Ranges: ratio to the frequency of the linear spring, share of critical damping, ratio of the
#: torque at which the spring hardens to the load torque, share of the inertia that is the motor's.
LOWER = np.array([np.log(0.4), np.log(0.01), np.log(0.05), 0.0])
UPPER = np.array([np.log(2.0), np.log(max(DAMPINGS)), np.log(20.0), 1.0])
#: Starts: springs that are hard and less hard under the load torque.
STARTS = tuple(np.array([0.0, np.log(0.1), np.log(hard), 0.2]) for hard in (0.5, 1.5))
#: Most evaluations of a first round from each start, and of a further one; first step as a share of
#: the ranges, and least change of the logarithm. Further rounds follow from the best end, if it
#: explains so many times what the linear spring does, until one gains less than this share.
FIRST_EVALUATIONS, EVALUATIONS, STEP, TOLERANCE = 80, 250, 0.1, 1e-4
MOST_ROUNDS, ON_THE_WAY, BETTER = 4, 1.05, 0.003
#: Quantile of the load torque that counts as its size.
LARGE = 0.95
#: Where the resonance of the last residual is kept: its parameters before the residual.
LAST, PARAMETERS = "resonance of the last residual", len(fields(Resonance))


def detailed_resonance(recording: Recording, residual: Array | None = None) -> Resonance:
    """The oscillation that explains most, with a spring that hardens where that explains more.

    Parameters and result as of `best_resonance`. That of the last residual is kept.
    """
    if residual is None:
        return _detailed(recording, None)
    known = recording.kept.get(LAST)
    if known is None or not np.array_equal(known[PARAMETERS:], residual):
        # In one array, which another thread replaces as a whole.
        known = np.concatenate([astuple(_detailed(recording, residual)), residual])
        recording.kept[LAST] = known
    return Resonance(*known[:PARAMETERS].tolist())


def _detailed(recording: Recording, residual: Array | None) -> Resonance:
    simple = best_resonance(recording, residual)
    shown = None if simple == NONE else Shown.of(recording, residual)
    if shown is None or simple.period * recording.rate_hz < RESOLVED:
        return simple
    search = _Search.around(simple, shown)
    explained = search.gain(simple)
    if explained < PROMISING * float(shown.rest @ shown.rest):
        return simple
    found = search.best()
    return found if search.gain(found) > MORE * explained else simple


@dataclass(frozen=True)
class _Search:
    """Search of the resonances near a simple one.

    Attributes
    ----------
    load
        Size of the load torque.
    inertia
        Inertia in it: by how much it changes from one sample to the next with the acceleration.
    """

    simple: Resonance
    shown: Shown
    load: float
    inertia: float

    @classmethod
    def around(cls, simple: Resonance, shown: Shown) -> _Search:
        recording = shown.recording
        load, a = recording.load_torque, recording.acceleration
        assert load is not None
        size = float(np.quantile(np.abs(load[recording.moving]), LARGE))
        if a is None or not np.ptp(a) > 0.0:
            return cls(simple, shown, size, 0.0)
        faster = np.diff(a)
        return cls(simple, shown, size, max(float(faster @ np.diff(load) / (faster @ faster)), 0.0))

    def best(self) -> Resonance:
        """The best one, by nlopt's subplex (Rowan 1990)."""
        ends = (self._from(start, FIRST_EVALUATIONS) for start in STARTS)
        best = max(ends, key=self._gain_at)
        if self._gain_at(best) < ON_THE_WAY * self.gain(self.simple):
            return self.simple
        for _ in range(MOST_ROUNDS):
            further = self._from(best, EVALUATIONS)
            if self._gain_at(further) <= (1.0 + BETTER) * self._gain_at(best):
                break
            best = further
        return self.at(best)

    def _from(self, start: Array, most: int) -> Array:
        """Search coordinates where a round from others ends; there where nlopt fails."""
        optimiser = nlopt.opt(nlopt.LN_SBPLX, start.size)
        optimiser.set_lower_bounds(LOWER)
        optimiser.set_upper_bounds(UPPER)
        optimiser.set_initial_step(STEP * (UPPER - LOWER))
        optimiser.set_maxeval(most)
        optimiser.set_ftol_abs(TOLERANCE)
        tiny = np.finfo(float).tiny
        optimiser.set_max_objective(lambda x, _: float(np.log(max(self._gain_at(x), tiny))))
        try:
            return np.asarray(optimiser.optimize(start))
        except (nlopt.RoundoffLimited, nlopt.runtime_error):
            return start

    def _gain_at(self, x: Array) -> float:
        return self.gain(self.at(x))

    def at(self, x: Array) -> Resonance:
        """The resonance at search coordinates."""
        ratio, damping, hardening = np.exp(x[:3])
        lowest = 1.0 / LOWEST
        return Resonance(
            period=min(self.simple.period / float(ratio), lowest),
            damping=float(damping),
            hardening=self.load * float(hardening),
            motor_inertia=self.inertia * float(x[3]),
        )

    def gain(self, resonance: Resonance) -> float:
        """Fall of the sum of squares by a resonance; 0 where it is impossible."""
        torque = resonance.curvature(self.shown.recording)
        if torque is None or not np.isfinite(torque).all():
            return 0.0
        column = beyond(self.shown.basis, torque[self.shown.rows, None])
        gains, factors = self.shown.explained(column)
        frequency = np.array([2.0 * np.pi / resonance.period])
        return float(gains[0]) if is_possible(frequency, factors)[0] else 0.0
