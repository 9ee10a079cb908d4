"""Two effects that predict only together.

Each alone is fitted to the torque of both, and predicts no block that it was not fitted to: dry
friction that falls with the temperature and rises with wear, for example. All pairs are compared by
their held-out error, linearised, from one set of normal equations. An effect that has no influence
without another, such as the lag of a thermometer, is identified together with that.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.diagnosis.trials.screening import ROWS, Screened, problem_of, screened
from stribeck.diagnosis.trials.trial import try_effect
from stribeck.effect.registry import of_catalog
from stribeck.fitting.result import Fit
from stribeck.identify.normal import NormalEquations
from stribeck.models.catalog import effect_ids
from stribeck.models.model import Model

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Least fall of the held-out RMSE by a pair, and least ratio to that by any effect alone.
LEAST, RATIO = 0.03, 1.5
#: Share of the samples' number that is added to the normal equations' diagonal.
RIDGE = 1e-6


@dataclass(frozen=True)
class BestPair:
    """Two effects, ids or formulas, and the relative fall of the held-out RMSE by both.

    The first predicts better alone, or is the one without which the second has no influence.
    """

    first: str
    second: str
    fall: float


def best_pair(
    before: Fit, screenings: Mapping[str, Screened], misshapen: Mapping[str, Screened]
) -> BestPair | None:
    """The two effects that predict best together, where none predicts nearly as well alone.

    Parameters
    ----------
    misshapen
        Effects whose shape ends at a bound. Alone they are something else, but not beside one that
        changes what they depend on.
    """
    either = {**screenings, **misshapen}
    alone = max((screening.fall for screening in either.values()), default=0.0)
    pairs = [p for p in _with_dependent(before, either) if p.fall >= max(LEAST, RATIO * alone)]
    linearised = _best_linearised(before, screenings)
    pairs += [] if linearised is None else [linearised]
    return max(pairs, key=lambda pair: pair.fall, default=None)


def _best_linearised(before: Fit, screenings: Mapping[str, Screened]) -> BestPair | None:
    """The best pair of effects that act alone as well, by linearised refits.

    Effects with a memory of their own, which are screened on other samples, are left out.
    """
    made = _Columns.of(before, [s for s in screenings.values() if _has_memory_of(s, before.model)])
    level = made.held_out_square(())
    if len(made.own) < 2 or not level > 0.0:
        return None

    def fall(*effects: str) -> float:
        return 1.0 - float(np.sqrt(made.held_out_square(effects) / level))

    alone = {effect: fall(effect) for effect in made.own}
    pairs = {pair: fall(*pair) for pair in combinations(made.own, 2)}
    best = max(pairs, key=lambda pair: pairs[pair])
    if pairs[best] < max(LEAST, RATIO * max(alone.values())):
        return None
    first, second = sorted(best, key=lambda effect: -alone[effect])
    return BestPair(first, second, pairs[best])


def _with_dependent(before: Fit, screenings: Mapping[str, Screened]) -> Iterator[BestPair]:
    """Each effect that has no influence alone, beside each of those that give it one."""
    model, recording = before.model, before.recording
    for second in effect_ids():
        row = of_catalog(second)
        if row.shown_beside is None or row.refusal(model, recording) is None:
            continue
        for first, screening in screenings.items():
            if row.refusal(screening.model, recording) is not None:
                continue
            both = screened(replace(before, model=screening.model), second)
            trial = None if both is None else try_effect(before, both)
            if trial is not None:
                yield BestPair(first, second, trial.evidence.fall)


@dataclass(frozen=True)
class _Columns:
    """Normal equations, block by block, of a model's columns and those of effects.

    Attributes
    ----------
    base : int array
        The model's columns.
    own
        The columns of each effect.
    samples : int
        Number of samples.
    """

    equations: NormalEquations
    base: Indices
    own: Mapping[str, Indices]
    samples: int

    @classmethod
    def of(cls, before: Fit, screenings: Sequence[Screened]) -> _Columns:
        """Linearised at the fit, and for each effect at the values of its screening."""
        whole = problem_of(before.model, before).thinned(ROWS)
        residual, jacobian = map(whole.weighted, whole.linearise(before.model.values))
        columns = [jacobian]
        own: dict[str, Indices] = {}
        count = jacobian.shape[1]
        for screening in screenings:
            names = screening.model.names
            new = np.array([k for k, name in enumerate(names) if name not in before.model.names])
            problem = problem_of(screening.model, before).thinned(ROWS)
            added = problem.weighted(problem.linearise(screening.model.values, new)[1])
            if not np.all(np.isfinite(added)):
                continue
            columns.append(added)
            own[screening.effect] = np.arange(count, count + added.shape[1])
            count += added.shape[1]
        matrix = np.column_stack(columns)
        size = np.sqrt((matrix**2).mean(axis=0))
        scaled = np.ascontiguousarray(matrix / np.where(size > 0.0, size, 1.0))
        block = before.recording.block[whole.rows].astype(np.uint32)
        equations = NormalEquations.of(scaled, residual, block)
        return cls(equations, np.arange(jacobian.shape[1]), own, residual.size)

    def held_out_square(self, effects: Sequence[str]) -> float:
        """Squared error of each block by the others, with some effects, summed."""
        kept = np.concatenate([self.base, *(self.own[effect] for effect in effects)])
        inside = np.ix_(kept, kept)
        e = self.equations
        matrix, vector = e.total()
        ridge = RIDGE * self.samples * np.eye(kept.size)
        total = 0.0
        for b in range(e.square.size):
            own, right = e.matrix[b][inside], e.vector[b][kept]
            step = linear.solve(matrix[inside] - own + ridge, vector[kept] - right)
            total += float(e.square[b] - 2.0 * step @ right + step @ own @ step)
        return max(total, 0.0)


def _has_memory_of(screening: Screened, base: Model) -> bool:
    model = screening.model
    return model.has_state == base.has_state and model.memoryless == base.memoryless
