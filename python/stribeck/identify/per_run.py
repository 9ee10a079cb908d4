"""Parameters that have a value of their own in each run of a recording.

Each run is the problem of the same model on its own samples. The factors of the runs are joined in
the wider space of the shared parameters and those of every run, so that search, held-out refits and
standard errors are those of any other model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.held_out import Bounded
from stribeck.identify.problem import Problem
from stribeck.identify.triangle import Triangle
from stribeck.models.model import Model
from stribeck.models.parameter import Parameter

__all__ = ["OfRuns", "PerRunProblem", "Widened"]

Array = NDArray[np.float64]
Places = NDArray[np.intp]


@dataclass(frozen=True)
class Widened:
    """A model whose `varied` parameters have one value in each run.

    Attributes
    ----------
    base
        The model of one run.
    varied
        Names of the parameters that differ from run to run.
    runs
        Names of the runs.
    """

    base: Model
    varied: tuple[str, ...]
    runs: tuple[str, ...]

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters: a varied one stands once for each run, as ``offset[run1]``."""
        made: list[Parameter] = []
        for p in self.base.parameters:
            of_runs = [replace(p, name=f"{p.name}[{run}]") for run in self.runs]
            made += of_runs if p.name in self.varied else [p]
        return tuple(made)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(p.name for p in self.parameters)

    @cached_property
    def places(self) -> Places:
        """Where the parameters of each run are, array [runs, p]."""
        columns, at = [], 0
        for name in self.base.names:
            count = len(self.runs) if name in self.varied else 1
            columns.append(np.full(len(self.runs), at) + np.arange(len(self.runs)) * (count > 1))
            at += count
        return np.column_stack(columns)

    def of_varied(self) -> list[Places]:
        """Where the values of each varied parameter are, arrays [runs]."""
        return [self.places[:, self.base.names.index(name)] for name in self.varied]

    def widened(self, values: Array) -> Array:
        """Values [p] of one run, or bounds, as those of all runs."""
        made = np.empty(len(self.parameters))
        made[self.places] = values
        return made

    def mean(self, values: Array) -> Array:
        """The means over the runs, array [p]."""
        return np.asarray(values[self.places].mean(axis=0))

    # What sentences and results read of a model.

    @property
    def spec(self) -> str:
        """The spec of the model."""
        return self.base.spec

    @property
    def effects(self) -> tuple[str, ...]:
        """Its effects."""
        return self.base.effects

    @property
    def torque_unit(self) -> str:
        """Unit of the effort."""
        return self.base.torque_unit

    @property
    def own(self) -> Sequence[object]:
        """Terms by formula."""
        return self.base.own

    @property
    def values(self) -> Array:
        """The values of the model in every run."""
        return self.widened(self.base.values)

    def has(self, effect: str) -> bool:
        """Whether the model has an effect."""
        return self.base.has(effect)


@dataclass(frozen=True)
class PerRunProblem(Problem):
    """Predict the measured torque with parameters of each run; `model` is a `Widened`."""

    @classmethod
    def of(cls, problem: Problem, widened: Widened) -> PerRunProblem:
        """The problem on the same samples."""
        return cls(problem.recording, cast(Any, widened), problem.rows, problem.load)

    @property
    def widened(self) -> Widened:
        """The model with the parameters of all runs."""
        return cast(Widened, self.model)

    @property
    def in_core(self) -> bool:
        """Whether the core linearises the model: it does so run by run."""
        return False

    @cached_property
    def _runs(self) -> list[tuple[Places, slice, Problem]]:
        """Places of the parameters, samples and problem of each run that has samples."""
        made = []
        for k, places in enumerate(self.widened.places):
            own = np.flatnonzero(self.recording.run == k)
            span = int(own[0]), int(own[-1]) + 1
            rows = self.rows[(self.rows >= span[0]) & (self.rows < span[1])]
            part = Problem(self.recording, self.widened.base, rows, self.load, span)
            made.append((places, slice(*span), part))
        return made

    def by_run(self, values: Array) -> list[Problem]:
        """The problem of each run, whose model has the values of this run."""
        return [
            replace(part, model=part.model.with_values(values[places]))
            for places, _, part in self._runs
        ]

    def _chosen(self, places: Places, wanted: Places) -> tuple[Places, Places]:
        """The parameters of a run that are wanted, and their columns among the wanted ones."""
        column = {int(place): k for k, place in enumerate(wanted)}
        pairs = [(k, column[int(p)]) for k, p in enumerate(places) if int(p) in column]
        own = np.array([k for k, _ in pairs], dtype=np.intp)
        return own, np.array([at for _, at in pairs], dtype=np.intp)

    def triangle(self, values: Array, wanted: Places, slope: Array) -> Triangle | None:
        """The factors of all runs, joined; see `Problem.triangle`."""
        parts = []
        for places, _, part in self._runs:
            if part.rows.size == 0:
                continue
            own, columns = self._chosen(places, wanted)
            made = part.triangle(values[places], own, slope[columns])
            if made is None:
                return None
            parts.append(_embedded(made, columns, wanted.size))
        return Triangle.joined(parts)

    def triangles(
        self, values: Array, wanted: Places, group: NDArray[np.uint32], groups: int
    ) -> list[Triangle]:
        """The factors of each group of samples; see `Problem.triangles`."""
        parts: list[list[Triangle]] = [[] for _ in range(groups)]
        first = 0
        for places, _, part in self._runs:
            if part.rows.size == 0:
                continue
            own, columns = self._chosen(places, wanted)
            of_run = group[first : first + part.rows.size]
            first += part.rows.size
            for k, made in enumerate(part.triangles(values[places], own, of_run, groups)):
                parts[k].append(_embedded(made, columns, wanted.size))
        return [Triangle.joined(of_group) for of_group in parts]

    def linearise(self, values: Array, wanted: Places | None = None) -> tuple[Array, Array]:
        """Residual and derivatives of `rows`; see `Problem.linearise`."""
        wanted = np.arange(values.size) if wanted is None else wanted
        residual, jacobian = [], []
        for places, _, part in self._runs:
            own, columns = self._chosen(places, wanted)
            left, slopes = part.linearise(values[places], own)
            wide = np.zeros((left.size, wanted.size))
            wide[:, columns] = slopes
            residual.append(left)
            jacobian.append(wide)
        return np.concatenate(residual), np.concatenate(jacobian)

    def predict(self, values: Array, rows: Places | None = None) -> Array:
        """Predicted torque of every sample, or of some; see `Problem.predict`."""
        made = np.empty(self.recording.rows)
        for places, span, part in self._runs:
            made[span] = part.predict_stretch(values[places], span.start, span.stop)
        return made if rows is None else made[rows]


def _embedded(triangle: Triangle, columns: Places, width: int) -> Triangle:
    """A triangle with the columns of the parameters of all runs, those of others zero."""
    factor = np.zeros((triangle.right.size, width))
    factor[:, columns] = triangle.factor
    return Triangle(factor, triangle.right, triangle.rest)


@dataclass(frozen=True)
class OfRuns(Bounded):
    """Refits without some samples: a run without any left has the mean of the others.

    Attributes
    ----------
    varied
        Where the values of each varied parameter are, arrays [runs].
    """

    varied: tuple[Places, ...] = ()

    def step(self, values: Array, triangle: Triangle) -> Array:
        """One bounded step; see `Bounded.step`."""
        refit = super().step(values, triangle)
        seen = np.ones(values.size, dtype=bool)
        seen[np.flatnonzero(self.lower < self.upper)] = triangle.factor.any(axis=0)
        return self._filled(refit, seen)

    def refine(self, problem: Problem, refit: Array, values: Array, square: float) -> Array:
        """Values of a further search; see `Bounded.refine`."""
        made = super().refine(problem, refit, values, square)
        kept = np.unique(problem.recording.run[problem.rows])
        seen = np.ones(values.size, dtype=bool)
        for places in self.varied:
            seen[places] = np.isin(np.arange(places.size), kept)
        return self._filled(made, seen)

    def _filled(self, values: Array, seen: NDArray[np.bool_]) -> Array:
        for places in self.varied:
            known = seen[places]
            if known.any() and not known.all():
                values[places[~known]] = values[places[known]].mean()
        return values
