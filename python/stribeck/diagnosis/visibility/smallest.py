"""The smallest size of one effect that a diagnosis would see beside a model."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.visibility.added_effect import AddedEffect
from stribeck.diagnosis.visibility.held_out import held_out_balance
from stribeck.diagnosis.visibility.model_space import ModelSpace
from stribeck.diagnosis.visibility.power import Demand, ExpectedNoise, Noise, needed_factor
from stribeck.diagnosis.visibility.result import SmallestVisible
from stribeck.diagnosis.visibility.subspace import orthonormal, outside_span
from stribeck.identify.figures import rms
from stribeck.models.catalog import simpler_effect

Array = NDArray[np.float64]

#: Share of a torque below which the part outside a span may be rounding.
INVISIBLE = 1e-8
#: Sizes between which the smallest visible one is searched, for an effect that is not linear.
SIZES = 9


@dataclass(frozen=True)
class VisibleEffect:
    """One effect beside a model, at some size.

    Attributes
    ----------
    torque
        Torque that it adds at this size, array [m].
    factor
        By what the torque must be multiplied to be seen; infinite where no size is enough.
    """

    added: AddedEffect
    size: float
    torque: Array
    factor: float

    @property
    def effect(self) -> str:
        """The effect's id."""
        return self.added.effect

    def is_tested(self, found: Collection[str]) -> bool:
        """Whether a diagnosis tests the effect.

        An effect that contains a simpler one is tested only if that one was found.
        """
        return self.added.simpler.size == 0 or simpler_effect(self.effect) in found

    @property
    def smallest(self) -> float:
        """RMS of the smallest torque that is seen."""
        return self.factor * rms(self.torque) if np.isfinite(self.factor) else np.inf

    def result(self, unit: str) -> SmallestVisible:
        """The result for users."""
        row = self.added.size
        value = self.size if self.added.is_nonlinear else self.size * self.factor
        return SmallestVisible(self.effect, self.smallest, unit, row.name, value, row.unit)


def smallest_visible(
    added: AddedEffect,
    models: Sequence[tuple[ModelSpace, Demand]],
    noise: Noise | ExpectedNoise,
    base: Array,
    forms: int = 1,
) -> VisibleEffect:
    """How large an effect must be to be seen beside each of the forms of a model.

    Parameters
    ----------
    models
        The forms that the model may take, and what is demanded of the effect beside each.
    base : array [m]
        Torque that the model predicts.
    forms
        Forms of the effect from which a fit chooses by looking at the data.
    """
    if added.is_nonlinear:
        return _smallest_of_sizes(added, models, noise, base)
    torque = added.unit_torque()
    return VisibleEffect(added, 1.0, torque, _factor(added, torque, models, noise, forms))


def _factor(
    added: AddedEffect,
    torque: Array,
    models: Sequence[tuple[ModelSpace, Demand]],
    noise: Noise | ExpectedNoise,
    forms: int = 1,
    loss: float = 0.0,
) -> float:
    """By what `torque` [m] must be multiplied to be seen; infinite where no size is enough."""
    factors = []
    problem, stride = models[0][0].problem, models[0][0].stride
    block = problem.recording.block[problem.rows][::stride]
    space = added.own_columns(torque)[::stride]
    for model, need in models:
        left = model.outside(torque[:, None])
        if added.simpler.size:
            left = outside_span(orthonormal(model.outside(added.simpler_columns())), left)
        square = float(np.sum(left**2))
        if square <= INVISIBLE**2 * float(torque @ torque):
            return np.inf
        factors.append(
            needed_factor(
                square,
                noise.variance_along(left[:, 0]),
                noise,
                added.own.size,
                replace(need, significance=need.significance / forms),
                loss=loss,
                held_out=held_out_balance(
                    _with_simpler(model, added), torque[::stride], space, block
                ),
            )
        )
    return max(factors)


def _with_simpler(model: ModelSpace, added: AddedEffect) -> Array:
    """Basis, on the thinned samples, of what the model and the simpler effect absorb."""
    if added.simpler.size == 0:
        return model.thinned_basis
    simpler = added.simpler_columns()[:: model.stride]
    more = orthonormal(outside_span(model.thinned_basis, simpler))
    return np.column_stack([model.thinned_basis, more])


def _smallest_of_sizes(
    added: AddedEffect,
    models: Sequence[tuple[ModelSpace, Demand]],
    noise: Noise | ExpectedNoise,
    base: Array,
) -> VisibleEffect:
    """The smallest size that is seen: between two of a grid, of which one is seen and one is not.

    The wider model without its effect may differ from the plain model. This difference is an error
    of the wider model, not an effect, and counts as noise.
    """
    model = models[0][0]
    error = model.outside((added.torque_when_absent - base)[:, None])
    if added.simpler.size:
        error = outside_span(orthonormal(model.outside(added.simpler_columns())), error)
    loud = noise.with_error(error[:, 0])
    loss = float(np.sum(error**2))

    def at(size: float) -> VisibleEffect:
        torque = added.torque_of(size)
        return VisibleEffect(added, size, torque, _factor(added, torque, models, loud, loss=loss))

    sizes = added.sizes(SIZES)
    seen, hidden = at(sizes[0]), at(sizes[-1])
    if seen.factor > 1.0:
        return replace(seen, factor=np.inf)
    if hidden.factor <= 1.0:
        return replace(hidden, factor=1.0)
    while len(sizes) > 2:
        middle = len(sizes) // 2
        one = at(sizes[middle])
        if one.factor <= 1.0:
            seen, sizes = one, sizes[middle:]
        else:
            hidden, sizes = one, sizes[: middle + 1]
    if not np.isfinite(hidden.factor):
        return replace(seen, factor=1.0)
    share = -np.log(seen.factor) / np.log(hidden.factor / seen.factor)
    between = float(seen.size * (hidden.size / seen.size) ** share)
    return replace(at(between), factor=1.0)
