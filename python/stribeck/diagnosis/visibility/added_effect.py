"""The torque that an effect would add to a model on given samples, and which torques it can make.

An effect that a model lacks is a direction in the space of all samples: the torque that it adds
for one unit of its size. The part within the span of the model's own directions is absorbed by a
refit; only the rest can be seen.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base.errors import FitError
from stribeck.diagnosis.extend import extended_models
from stribeck.effect.registry import find
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import check_channels, scaled_parameters
from stribeck.models.parameter import Parameter

Array = NDArray[np.float64]

#: Multiples of the start at which the first nonlinear parameter of an effect is tried too.
OTHER_STARTS = (1.0 / 3.0, 3.0)


@dataclass(frozen=True)
class AddedEffect:
    """A model with one effect added, at the start of the effect's parameters.

    Attributes
    ----------
    problem
        The wider model with the effect present, on the same samples.
    own
        Indices of the effect's parameters, the size first, int array [p].
    simpler
        Indices of the parameters of the simpler effect that it contains and the model lacks.
    parameters
        The effect's parameters, scaled to the recording.
    """

    effect: str
    problem: Problem
    own: NDArray[np.intp]
    simpler: NDArray[np.intp]
    parameters: tuple[Parameter, ...]

    @classmethod
    def of(cls, before: Problem, effect: str, residual: Array | None = None) -> AddedEffect:
        """Add `effect` to the model of `before`.

        Parameters
        ----------
        residual : array [n]
            Residual of the model, at every sample; some effects take a constant from it.

        Raises
        ------
        SpecError, FitError
            The model cannot take the effect, or the recording lacks a channel for it.
        """
        recording = before.recording
        models = extended_models(before.model, effect, recording, before.load, residual)
        wider = models[-1]
        check_channels(wider, recording)
        rows = scaled_parameters(wider, recording)
        start = np.array([row.start for row in rows])
        values = np.where(np.isfinite(wider.values), wider.values, start)
        new = [[n for n in b.names if n not in a.names] for a, b in itertools.pairwise(models)]
        index = {name: k for k, name in enumerate(wider.names)}
        own = np.array([index[n] for n in new[-1]], dtype=np.intp)
        between = np.array([index[n] for names in new[:-1] for n in names], dtype=np.intp)
        problem = Problem(recording, wider.with_values(values), before.rows, before.load)
        return cls(effect, problem, own, between, tuple(rows[k] for k in own))

    def on(self, problem: Problem) -> AddedEffect:
        """The same wider model on the samples of another recording, that of `problem`."""
        return replace(self, problem=replace(problem, model=self.problem.model))

    @property
    def size(self) -> Parameter:
        """The parameter that says how large the effect is."""
        return self.parameters[0]

    @property
    def size_range(self) -> tuple[float, float] | None:
        """`Effect.size_range` of the effect."""
        known = find(self.effect)
        return None if known is None else known.size_range

    @property
    def is_nonlinear(self) -> bool:
        """Whether the torque is not proportional to the size."""
        return self.size_range is not None

    @property
    def is_inverse(self) -> bool:
        """Whether a larger size is a smaller effect, as with the stiffness of a bristle."""
        return self.size_range is not None and self.size_range[1] > 1.0

    def values_at(self, size: float) -> Array:
        """Values of the wider model [p] with this size of the effect."""
        values = self.problem.model.values.copy()
        values[self.own[0]] = size
        return values

    def unit_torque(self) -> Array:
        """Torque for one unit of the size, array [m], the other parameters at their starts."""
        return self._at_start[:, 0]

    def own_columns(self, torque: Array) -> Array:
        """What a fit of the effect can absorb where it adds `torque` [m], array [m, k]."""
        return torque[:, None] if self.is_nonlinear else self._at_start[:, : self.own.size]

    def simpler_columns(self) -> Array:
        """What the simpler effect can absorb, array [m, k]; no columns where there is none."""
        return self._at_start[:, self.own.size :]

    @cached_property
    def _at_start(self) -> Array:
        """Derivative of the prediction by the parameters `own` and `simpler`, array [m, p]."""
        return self._columns(self.problem, self.problem.model.values)

    def spaces(self, stride: int) -> list[Array]:
        """Torques that the effect can make near each of a few starts.

        Parameters
        ----------
        stride
            Every sample of this stride is used.

        Returns
        -------
        list of arrays [m / stride, k]
        """
        if self.is_nonlinear:
            changes = [self.torque_of(size)[::stride, None] for size in self.sizes(3)]
            return [np.concatenate([*changes, self.simpler_columns()[::stride]], axis=1)]
        thinned = replace(self.problem, rows=self.problem.rows[::stride])
        others = (self._columns(thinned, values) for values in self._other_starts())
        return [self._at_start[::stride], *others]

    def _columns(self, problem: Problem, values: Array) -> Array:
        wanted = np.concatenate([self.own, self.simpler])
        try:
            _, columns = problem.linearise(values, np.sort(wanted))
        except _core.ModelError as error:
            raise FitError(f"{self.effect} cannot be added: {error}") from None
        return _finite(columns[:, np.argsort(np.argsort(wanted))], self.effect)

    def _other_starts(self) -> list[Array]:
        """Values of the wider model with the effect's first nonlinear parameter elsewhere."""
        first = self.problem.model.values
        shapes = [k for k, p in enumerate(self.parameters) if k > 0 and p.role == "nonlinear"]
        starts = []
        for share in OTHER_STARTS if shapes else ():
            k = shapes[0]
            row, values = self.parameters[k], first.copy()
            values[self.own[k]] = np.clip(first[self.own[k]] * share, row.lower, row.upper)
            if values[self.own[k]] != first[self.own[k]]:
                starts.append(values)
        return starts

    def sizes(self, count: int) -> list[float]:
        """Sizes of an effect that `is_nonlinear`, from large effects to small ones."""
        assert self.size_range is not None
        row = self.size
        ends = np.clip(row.start * np.array(self.size_range), row.lower, row.upper)
        return [float(size) for size in np.geomspace(float(ends[0]), float(ends[1]), count)]

    @cached_property
    def torque_when_absent(self) -> Array:
        """Torque of the wider model with as little of the effect as possible, array [m].

        Not quite the torque of the model without it: a bristle, however stiff, reverses with its
        deflection, not with the sign of the velocity.
        """
        size = self.size.upper if self.is_inverse else self.size.lower
        return self._torque(size)

    def torque_of(self, size: float) -> Array:
        """Torque that the effect of this size adds, array [m]."""
        return self._torque(size) - self.torque_when_absent

    def _torque(self, size: float) -> Array:
        return _finite(self.problem.predict(self.values_at(size))[self.problem.rows], self.effect)


def _finite(torque: Array, effect: str) -> Array:
    if not np.all(np.isfinite(torque)):
        raise FitError(f"{effect} has no finite torque at its start on this data")
    return torque
